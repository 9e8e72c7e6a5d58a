//! Declarations and modifications as they are written.

use super::expression;
use super::expression::{call_arguments, range};
use super::name::{bracketed, doc, quoted, reference, subscripts};
use crate::ast::{Change, Declaration, Declarator, Measure, Prior};
use std::fmt::Write as _;

pub(super) fn declaration_text(declaration: &Declaration) -> String {
    let mut text = String::new();
    for prefix in &declaration.prefixes {
        text.push_str(prefix.word());
        text.push(' ');
    }
    text.push_str(&reference(&declaration.type_name));
    text.push_str(&subscripts(&declaration.dims));
    let declarators: Vec<String> = declaration
        .declarators
        .iter()
        .map(declarator_text)
        .collect();
    format!("{text} {};", declarators.join(", "))
}

fn declarator_text(item: &Declarator) -> String {
    let mut text = format!(
        "{}{}{}",
        item.name.text,
        subscripts(&item.dims),
        modification(&item.changes)
    );
    if let Some(domain) = &item.domain {
        let _ = write!(text, " on {}", domain.text);
    }
    if let Some(binding) = &item.binding {
        let _ = write!(text, " = {}", expression(binding));
    }
    text.push_str(&prior_text(item.prior.as_ref()));
    text.push_str(&source_text(item.source.as_deref()));
    if let Some(within) = &item.within {
        let _ = write!(text, " in {}", range(within));
    }
    if !item.over.is_empty() {
        let _ = write!(text, " over {}", call_arguments(&item.over));
    }
    text.push_str(&doc(item.doc.as_deref()));
    text
}

pub(super) fn measure_text(word: &str, measure: &Measure) -> String {
    let value = expression(&measure.value);
    let unit = measure.unit.as_ref();
    let unit = unit.map_or(String::new(), |unit| format!(" in [{}]", unit.text));
    let text = doc(measure.doc.as_deref());
    format!(
        "{word} {} {} = {value}{unit}{text};",
        reference(&measure.type_name),
        measure.name.text
    )
}

pub(super) fn modification(changes: &[Change]) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let texts: Vec<String> = changes
        .iter()
        .map(|change| {
            let mut text = String::new();
            if change.each {
                text.push_str("each ");
            }
            if change.is_final {
                text.push_str("final ");
            }
            if let Some(model) = &change.redeclare {
                let _ = write!(text, "redeclare {} ", reference(model));
            }
            text.push_str(&reference(&change.target));
            text.push_str(&modification(&change.changes));
            if let Some(value) = &change.value {
                let _ = write!(text, " = {}", expression(value));
            }
            text.push_str(&prior_text(change.prior.as_ref()));
            text.push_str(&source_text(change.source.as_deref()));
            text
        })
        .collect();
    format!("({})", texts.join(", "))
}

fn prior_text(prior: Option<&Prior>) -> String {
    prior.map_or_else(String::new, |prior| {
        let unit = if prior.percent {
            "%".to_owned()
        } else {
            bracketed(prior.unit.as_ref())
        };
        format!(" ~ ±{}{unit}", prior.value)
    })
}

fn source_text(source: Option<&str>) -> String {
    source.map_or_else(String::new, |text| format!(" from {}", quoted(text)))
}
