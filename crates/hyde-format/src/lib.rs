//! Source text to source text in the layout of the project: [`format()`]. Only white space and line breaks change.
//!
//! The parser says how the text is written ([`hyde_syntax::written()`]); `words` makes a tree of words from it, each with the
//! comments before it; `layout` makes a line of a statement, broken where it is too long; `print` writes statement after
//! statement with the comments between. `unchanged` compares the trees before and after.

mod layout;
mod print;
mod unchanged;
mod words;

use hyde_diag::{Diagnostics, Sources};

/// Columns of a line. A longer one is broken where the grammar permits it; texts and comments never are.
pub const WIDTH: usize = 120;

/// The most that a text is formatted again until it does not change. One pass is enough for nearly every text; more are
/// needed where a comment inside of a statement moves.
const PASSES: usize = 8;

/// A formatted text.
#[derive(Clone, Debug)]
pub struct Formatted {
    /// The text. A mark of byte order and the kind of line breaks are those of the given text.
    pub text: String,
    /// The syntax errors of the given text. An item with one is as it was.
    pub errors: Diagnostics,
    /// The given text, for the places of the errors; under the name that was given.
    pub sources: Sources,
}

/// Why a text cannot be formatted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// The formatted text would have another syntax tree. This is a defect of the formatter.
    Changed,
    /// The layout does not settle. This is a defect of the formatter.
    Unsettled,
}

/// Formats a source text; `name` is what diagnostics call it. An item with a syntax error remains as it is written.
///
/// Formatting the result again does not change it. The syntax trees before and after are equal but for positions; every
/// comment is kept.
///
/// # Errors
///
/// If the formatted text would not be equal to the given one in what it means, or would change if it were formatted again.
pub fn format(name: &str, text: &str) -> Result<Formatted, Failure> {
    let mark = if text.starts_with('\u{feff}') {
        "\u{feff}"
    } else {
        ""
    };
    let given = Source::of(name, &text[mark.len()..]);
    let mut before = given.layout();
    for _ in 0..PASSES {
        let next = Source::of(name, &before);
        if !unchanged::same(&given, &next) {
            return Err(Failure::Changed);
        }
        let after = next.layout();
        if after == before {
            return Ok(Formatted {
                text: format!("{mark}{}", with_breaks_of(text, before)),
                errors: given.errors,
                sources: given.sources,
            });
        }
        before = after;
    }
    Err(Failure::Unsettled)
}

/// The text with line breaks as in the original, which may come from Windows.
fn with_breaks_of(original: &str, text: String) -> String {
    let breaks = original.matches('\n').count();
    if breaks > 0 && original.matches("\r\n").count() == breaks {
        text.replace("\r\n", "\n").replace('\n', "\r\n")
    } else {
        text
    }
}

/// A text with what the parser says of it.
struct Source {
    sources: Sources,
    file: hyde_diag::FileId,
    written: hyde_syntax::Written,
    errors: Diagnostics,
}

impl Source {
    fn of(name: &str, text: &str) -> Self {
        let mut sources = Sources::new();
        let file = sources.add(name, text);
        let mut diagnostics = Diagnostics::new();
        let written = hyde_syntax::written(&sources, file, &mut diagnostics);
        Self {
            errors: diagnostics,
            sources,
            file,
            written,
        }
    }

    fn text(&self) -> &str {
        &self.sources.get(self.file).text
    }

    fn layout(&self) -> String {
        print::print(&words::Words::of(self.text(), &self.written))
    }
}
