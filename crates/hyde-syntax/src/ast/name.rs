//! Names: words, dotted references, units.

use super::{Expr, ExprKind};
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
    /// The path of an instance or a variable, `m[2].a.s`, or the full name of a class, as a reference that stands at a place.
    #[must_use]
    pub fn of_path(path: &str, span: Span) -> Self {
        let part = |text: &str| {
            let element = text.strip_suffix(']').and_then(|text| text.split_once('['));
            let element = element.and_then(|(array, number)| Some((array, number.parse().ok()?)));
            let (word, subscript) = match element {
                Some((array, number)) => (array, Some(ExprKind::Number(number, None))),
                None => (text, None),
            };
            let subscripts = subscript.map(|kind| Expr { kind, span });
            Part {
                name: Name {
                    text: word.to_owned(),
                    span,
                },
                subscripts: subscripts.into_iter().collect(),
            }
        };
        Self {
            parts: path.split('.').map(part).collect(),
            span,
        }
    }

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
