//! The source texts of a compilation, each with a name to print and lines to count.

use crate::Span;

/// One of the [`Sources`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FileId(u32);

/// A named source text.
#[derive(Clone, Debug)]
pub struct Source {
    /// What a diagnostic prints as the place: a path as the user wrote it, or a library name.
    pub name: String,
    /// The whole text.
    pub text: String,
    line_starts: Vec<u32>,
}

impl Source {
    fn new(name: String, text: String) -> Self {
        let newlines = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n');
        let line_starts = std::iter::once(0)
            .chain(newlines.map(|(at, _)| u32::try_from(at + 1).unwrap_or(u32::MAX)))
            .collect();
        Self {
            name,
            text,
            line_starts,
        }
    }

    /// Line and column (both from 1, the column in characters) of the byte `at`.
    #[must_use]
    pub fn line_column(&self, at: u32) -> (usize, usize) {
        let line = self.line_starts.partition_point(|&start| start <= at);
        let start = self.line_starts[line - 1] as usize;
        let end = (at as usize).min(self.text.len());
        let column = self
            .text
            .get(start..end)
            .map_or(0, |before| before.chars().count());
        (line, column + 1)
    }

    /// The text of a line (from 1) without its line break; empty past the end.
    #[must_use]
    pub fn line(&self, line: usize) -> &str {
        self.text.lines().nth(line.saturating_sub(1)).unwrap_or("")
    }
}

/// All source texts of one compilation.
#[derive(Clone, Debug, Default)]
pub struct Sources {
    files: Vec<Source>,
}

impl Sources {
    /// No texts yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a text under the name that diagnostics print.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<String>) -> FileId {
        let id = FileId(u32::try_from(self.files.len()).unwrap_or(u32::MAX));
        self.files.push(Source::new(name.into(), text.into()));
        id
    }

    /// The text behind an id that [`Sources::add`] gave out.
    #[must_use]
    pub fn get(&self, file: FileId) -> &Source {
        &self.files[file.0 as usize]
    }

    /// Every text with its id, in the order added.
    pub fn iter(&self) -> impl Iterator<Item = (FileId, &Source)> {
        (0..).map(FileId).zip(&self.files)
    }

    /// The words a span covers.
    #[must_use]
    pub fn text(&self, span: Span) -> &str {
        self.get(span.file)
            .text
            .get(span.start as usize..span.end as usize)
            .unwrap_or("")
    }

    /// The lines a span lies in, whole.
    #[must_use]
    pub fn lines(&self, span: Span) -> &str {
        let text = self.get(span.file).text.as_str();
        let (start, end) = (span.start as usize, span.end as usize);
        let first = text.get(..start).and_then(|before| before.rfind('\n'));
        let last = text.get(end..).and_then(|after| after.find('\n'));
        let last = last.map_or(text.len(), |at| end + at);
        text.get(first.map_or(0, |at| at + 1)..last).unwrap_or("")
    }

    /// `name:line`, as event logs and failures print a place.
    #[must_use]
    pub fn place(&self, span: Span) -> String {
        let source = self.get(span.file);
        format!("{}:{}", source.name, source.line_column(span.start).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_in_characters() {
        let mut sources = Sources::new();
        let file = sources.add("a.hyde", "x\n±y = 1;\n");
        let source = sources.get(file);
        assert_eq!(source.line_column(0), (1, 1));
        let y = source.text.find('y').unwrap();
        assert_eq!(source.line_column(u32::try_from(y).unwrap()), (2, 2));
        assert_eq!(source.line(2), "±y = 1;");
        assert_eq!(sources.place(Span::new(file, y, y + 1)), "a.hyde:2");
    }
}
