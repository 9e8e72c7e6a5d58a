//! The text of a file as the grammar reads it, word for word: every construct with its place, nothing left out.
//!
//! [`crate::parse`] keeps what a text means. A formatter or an editor also needs how it is written: parentheses that are not
//! needed, the digits of a number, the places of comments. [`written`] records each construct that the parser accepts.

use crate::grammar::Rule;
use crate::matcher::Pair;
use hyde_diag::{Diagnostics, FileId, Sources};

/// A file as it is written: its parts in the order of the text. Between them are white space and comments only.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Written {
    /// The package clause, the imports and the items.
    pub parts: Vec<Part>,
}

/// A package clause, an import, or an item: a type, a class, an experiment or a study.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// First byte.
    pub start: usize,
    /// One past the last byte; white space and comments may precede it.
    pub end: usize,
    /// Whether the part has a syntax error. Then text is missing in `pieces`.
    pub broken: bool,
    /// What the parser accepted: a header, each element, each word that begins a section, and the end clause. One at least
    /// if the part is not broken.
    pub pieces: Vec<Node>,
}

/// A construct of the grammar and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// Which construct.
    pub rule: Rule,
    /// First byte.
    pub start: usize,
    /// One past the last byte. White space and comments may precede it, if the construct could have gone on.
    pub end: usize,
    /// What it consists of, in the order of the text. Signs such as `;` are in the gaps between.
    pub children: Vec<Node>,
}

impl Node {
    /// From a pair whose places count from `base`.
    pub(crate) fn of(pair: Pair<'_>, base: usize) -> Self {
        Self {
            rule: pair.as_rule(),
            start: base + pair.start(),
            end: base + pair.end(),
            children: pair
                .into_inner()
                .map(|inner| Self::of(inner, base))
                .collect(),
        }
    }
}

/// Parses one source file and says how it is written. `diagnostics` gets what [`crate::parse`] would report.
#[must_use]
pub fn written(sources: &Sources, file: FileId, diagnostics: &mut Diagnostics) -> Written {
    crate::parse::written(sources, file, diagnostics)
}
