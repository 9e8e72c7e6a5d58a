//! Names: words, dotted references, units.

use super::Expr;
use hyde_diag::Span;

/// A word and where it stands.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Name {
    /// The word.
    pub text: String,
    /// Its place.
    pub span: Span,
}

/// A dotted name, possibly with subscripts: `m[2].a.s`.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Its parts.
    pub parts: Vec<Part>,
    /// Its place.
    pub span: Span,
}

/// A part of a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The word.
    pub name: Name,
    /// Subscripts, from 1.
    pub subscripts: Vec<Expr>,
}

impl Reference {
    /// The reference as text, without subscripts.
    #[must_use]
    pub fn dotted(&self) -> String {
        let names: Vec<&str> = self
            .parts
            .iter()
            .map(|part| part.name.text.as_str())
            .collect();
        names.join(".")
    }

    /// The word, if it is a single one without subscripts.
    #[must_use]
    pub fn as_word(&self) -> Option<&str> {
        match self.parts.as_slice() {
            [part] if part.subscripts.is_empty() => Some(&part.name.text),
            _ => None,
        }
    }
}

/// A unit as written between brackets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitText {
    /// The text between the brackets.
    pub text: String,
    /// Its place.
    pub span: Span,
}
