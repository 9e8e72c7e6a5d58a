//! References, units and texts as they are written.

use super::expression;
use crate::ast::{Expr, Reference, UnitText};

/// A reference as written, subscripts included: `joint[2].phi`.
#[must_use]
pub fn reference(name: &Reference) -> String {
    let parts: Vec<String> = name
        .parts
        .iter()
        .map(|part| format!("{}{}", part.name.text, subscripts(&part.subscripts)))
        .collect();
    parts.join(".")
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
