//! Where header, units and rows of a text are, and what separates the cells.

use super::ReadError;
use super::number::Numbers;
use super::rows::cells_of;
use crate::Note;
use crate::heading::{Heading, may_be_of_row, of_row};
use std::borrow::Cow;

/// The parts of a text.
#[derive(Debug)]
pub(super) struct Grid<'a> {
    /// The columns.
    pub(super) headings: Vec<Heading>,
    /// What is below the header.
    pub(super) rows: Cow<'a, str>,
    /// The lines above it.
    pub(super) lines_above: u64,
    /// What separates the cells.
    pub(super) separator: u8,
    /// What was taken for granted.
    pub(super) notes: Vec<Note>,
}

/// What separates cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Byte(u8),
    /// Blanks and tabs, one or several.
    Blanks,
}

/// A line that is not blank.
#[derive(Clone, Copy)]
struct Line<'a> {
    number: u64,
    text: &'a str,
    /// Where the next line begins.
    end: usize,
}

impl Line<'_> {
    fn is_comment(&self) -> bool {
        self.text.starts_with(['#', '%'])
    }
}

impl<'a> Grid<'a> {
    /// Finds the parts of a record.
    pub(super) fn of(text: &'a str) -> Result<Self, ReadError> {
        let (declared, first) = first_line(text)?;
        let mut notes = Vec::new();
        let below = plain(text, first.end, first.number).next();
        let own = declared.unwrap_or_else(|| separator(first.text, below.map(|line| line.text)));
        let numbers = |line: &str| {
            let cells = split(line, own);
            cells
                .iter()
                .all(|cell| cell.is_empty() || Numbers::is_number(cell))
        };
        let (separator, header, end) = if numbers(first.text) {
            let comments = lines(text, 0, 0).take_while(|line| line.number < first.number);
            let header = comments.filter(Line::is_comment).last();
            let found = header.and_then(|line| {
                let names = line.text.trim_start_matches(['#', '%']).trim();
                let separator = declared.unwrap_or_else(|| separator(names, Some(first.text)));
                let fits = split(names, separator).len() == split(first.text, separator).len();
                fits.then_some((separator, names, line.number))
            });
            let Some((separator, names, number)) = found else {
                return Err(ReadError::NoHeader { line: first.number });
            };
            notes.push(Note::new(format!(
                "the comment in line {number} is read as the header"
            )));
            let above = text
                .split_inclusive('\n')
                .take(usize::try_from(first.number - 1).unwrap_or(0));
            (
                separator,
                names,
                Line {
                    end: above.map(str::len).sum(),
                    number: first.number - 1,
                    ..first
                },
            )
        } else {
            (own, first.text, first)
        };
        let mut cells = split(header, separator);
        let named = cells
            .iter()
            .rposition(|cell| !cell.is_empty())
            .map_or(0, |last| last + 1);
        if named < cells.len() {
            notes.push(Note::new(
                "its lines end with a separator: the empty last column is ignored",
            ));
            cells.truncate(named);
        }
        let mut headings: Vec<Heading> = cells.iter().map(|cell| Heading::of(cell)).collect();
        let mut end = end;
        if let Some(line) = plain(text, end.end, end.number).next()
            && let Some(units) = row_of_units(line.text, separator, headings.len())
        {
            headings = headings
                .into_iter()
                .zip(&units)
                .map(|(heading, cell)| heading.with_row(cell))
                .collect();
            notes.push(Note::new(format!(
                "line {} is read as a row of units",
                line.number
            )));
            end = line;
        }
        let rows = &text[end.end..];
        let (rows, separator) = match separator {
            Separator::Byte(byte) => (Cow::Borrowed(rows), byte),
            Separator::Blanks => {
                notes.push(Note::new("its cells are separated by blanks"));
                let tabbed = rows.split_inclusive('\n').map(|line| {
                    let cells: Vec<&str> = line.split_whitespace().collect();
                    cells.join("\t") + "\n"
                });
                (Cow::Owned(tabbed.collect()), b'\t')
            }
        };
        Ok(Self {
            headings,
            rows,
            lines_above: end.number,
            separator,
            notes,
        })
    }

    /// Finds the parts of a table that need not be over time and may have texts in it: a header and rows.
    pub(super) fn of_frame(text: &'a str) -> Result<Self, ReadError> {
        let (declared, first) = first_line(text)?;
        let own = declared.unwrap_or_else(|| separator(first.text, None));
        let Separator::Byte(separator) = own else {
            return Err(ReadError::Empty);
        };
        Ok(Self {
            headings: split(first.text, own)
                .iter()
                .map(|cell| Heading::of(cell))
                .collect(),
            rows: Cow::Borrowed(&text[first.end..]),
            lines_above: first.number,
            separator,
            notes: Vec::new(),
        })
    }
}

/// The first line that is neither blank nor a comment, and the separator that a line `sep=;` above it declares.
fn first_line(text: &str) -> Result<(Option<Separator>, Line<'_>), ReadError> {
    let mut plain = plain(text, 0, 0);
    let first = plain.next().ok_or(ReadError::Empty)?;
    let declared = first.text.to_ascii_lowercase();
    match declared.strip_prefix("sep=").map(str::as_bytes) {
        Some([byte]) => {
            let separator = Separator::Byte(*byte);
            Ok((Some(separator), plain.next().ok_or(ReadError::Empty)?))
        }
        Some(_) | None => Ok((None, first)),
    }
}

/// The lines from a byte on that are not blank, the line `above` being the last before it.
fn lines(text: &str, from: usize, above: u64) -> impl Iterator<Item = Line<'_>> {
    let mut end = from;
    let mut number = above;
    let lines = text[from..].split_inclusive('\n').map(move |line| {
        end += line.len();
        number += 1;
        Line {
            number,
            text: line.trim_matches([' ', '\r', '\n']),
            end,
        }
    });
    lines.filter(|line| !line.text.trim().is_empty())
}

/// Those of them that are no comments.
fn plain(text: &str, from: usize, above: u64) -> impl Iterator<Item = Line<'_>> {
    lines(text, from, above).filter(|line| !line.is_comment())
}

/// What separates the cells of a header, by the first row where there is one.
fn separator(header: &str, row: Option<&str>) -> Separator {
    let all = [b',', b';', b'\t', b'|'].map(Separator::Byte);
    let count = |line: &str, separator| match separator {
        Separator::Byte(byte) => 1 + outside_quotes(line, byte),
        Separator::Blanks => by_blanks(line).len(),
    };
    if let Some(row) = row {
        let fits = |separator: &Separator| {
            count(header, *separator) > 1 && count(header, *separator) == count(row, *separator)
        };
        // By how large a part of the cells is numbers, then by how many there are.
        let numbers = |separator: &Separator| {
            let cells = split(row, *separator);
            let numbers = cells.iter().filter(|cell| Numbers::is_number(cell));
            (64 * numbers.count() / cells.len().max(1), cells.len())
        };
        // Of equal ones the first wins.
        if let Some(found) = all
            .iter()
            .rev()
            .filter(|s| fits(s))
            .max_by_key(|s| numbers(s))
        {
            return *found;
        }
        let blanks = Separator::Blanks;
        let none = all.iter().all(|separator| count(header, *separator) == 1);
        if none && count(header, blanks) > 1 && count(header, blanks) == count(row, blanks) {
            return blanks;
        }
    }
    let most = all
        .iter()
        .rev()
        .max_by_key(|separator| count(header, **separator));
    most.copied().unwrap_or(Separator::Byte(b','))
}

/// How often a byte stands in a line outside quotes.
fn outside_quotes(line: &str, separator: u8) -> usize {
    let mut quoted = false;
    let mut own = |byte: u8| {
        quoted ^= byte == b'"';
        byte == separator && !quoted
    };
    line.bytes().filter(|byte| own(*byte)).count()
}

/// The cells of a line.
fn split(line: &str, separator: Separator) -> Vec<String> {
    match separator {
        Separator::Byte(byte) => cells_of(line, byte),
        Separator::Blanks => by_blanks(line),
    }
}

/// Cells between blanks; a unit in brackets belongs to the name before it.
fn by_blanks(line: &str) -> Vec<String> {
    let mut cells: Vec<String> = Vec::new();
    let mut open = false;
    for word in line.split_whitespace() {
        let continued = open || word.starts_with(['[', '(']);
        match cells.last_mut().filter(|_| continued) {
            Some(cell) => {
                cell.push(' ');
                cell.push_str(word);
            }
            None => cells.push(word.to_owned()),
        }
        open = (open || word.contains(['[', '('])) && !word.ends_with([']', ')']);
    }
    cells
}

/// The cells of a line that is a row of units: no number among them, but a unit that is known.
fn row_of_units(line: &str, separator: Separator, columns: usize) -> Option<Vec<String>> {
    let mut cells = match separator {
        Separator::Byte(byte) => cells_of(line, byte),
        Separator::Blanks => line.split_whitespace().map(str::to_owned).collect(),
    };
    cells.truncate(columns.max(1));
    let number = cells.iter().any(|cell| Numbers::is_number(cell));
    let known = cells.iter().any(|cell| matches!(of_row(cell), Some(Ok(_))));
    let first = cells.first().is_some_and(|cell| may_be_of_row(cell));
    (cells.len() == columns && !number && known && first).then_some(cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_separator_is_that_of_header_and_row() {
        let byte = |b| Separator::Byte(b);
        assert_eq!(separator("t,x;y,z", None), byte(b','));
        assert_eq!(separator("t;x;y", None), byte(b';'));
        assert_eq!(separator("t\tx", None), byte(b'\t'));
        assert_eq!(separator("\"a,b,c\";\"d,e,f\"", None), byte(b';'));
        assert_eq!(separator("t", None), byte(b','));
        assert_eq!(separator("Time, s;Pos, mm", Some("0,1;0,5")), byte(b';'));
        assert_eq!(separator("t x mode", Some("0.1  2 7")), Separator::Blanks);
        assert_eq!(
            separator("t [s] x [mm]", Some("0,1 2,5")),
            Separator::Blanks
        );
        assert_eq!(separator("Actual Position", Some("0.1")), byte(b','));
    }
}
