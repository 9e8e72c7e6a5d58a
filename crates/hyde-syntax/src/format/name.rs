//! References, units and texts as they are written.

use super::expression;
use crate::ast::{Expr, Reference, UnitText};
use std::borrow::Cow;

/// A reference as written, subscripts included: `joint[2].phi`.
#[must_use]
pub fn reference(name: &Reference) -> String {
    let parts: Vec<String> = name
        .parts
        .iter()
        .map(|part| {
            format!(
                "{}{}",
                member(&part.name.text),
                subscripts(&part.subscripts)
            )
        })
        .collect();
    parts.join(".")
}

/// A name behind a dot, in quotes if it is not a word: `log."Actual Position"`.
#[must_use]
pub fn member(name: &str) -> Cow<'_, str> {
    let first = name.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    match first && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        true => Cow::Borrowed(name),
        false => Cow::Owned(quoted(name)),
    }
}

pub(super) fn subscripts(list: &[Expr]) -> String {
    if list.is_empty() {
        return String::new();
    }
    let texts: Vec<String> = list.iter().map(expression).collect();
    format!("[{}]", texts.join(", "))
}

pub(super) fn bracketed(unit: Option<&UnitText>) -> String {
    unit.map_or_else(String::new, |unit| format!(" [{}]", unit.text))
}

pub(super) fn doc(text: Option<&str>) -> String {
    text.map_or_else(String::new, |text| format!(" {}", quoted(text)))
}

pub(super) fn quoted(text: &str) -> String {
    format!(
        "\"{}\"",
        text.replace('\\', "\\\\")
            .replace('"', "\\\"")
            .replace('\n', "\\n")
    )
}
