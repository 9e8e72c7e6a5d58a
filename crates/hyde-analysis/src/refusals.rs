//! Every diagnostic of analysis, as data: a file for each group of passes. A pass reports what a function of its file makes.

pub(crate) mod clocked;
pub(crate) mod conflicts;
pub(crate) mod states;
pub(crate) mod unmatched;

use crate::regularity::and;
use crate::system::System;
use hyde_diag::{Origin, Span};

/// Where something stands, and before it the declaration of the component that has it: that is in the user's own file. At the
/// top of the model there is none.
pub(crate) type Place = (Option<Span>, Span);

/// The place of what has this origin.
pub(crate) fn place_of(system: &System, origin: &Origin) -> Place {
    (system.component(origin).map(|(_, span)| span), origin.span)
}

/// A component with its declaration.
type Part = (String, Span);

fn parts_as_words(parts: &[Part]) -> String {
    let names: Vec<String> = parts.iter().map(|(name, _)| format!("`{name}`")).collect();
    and(&names)
}

fn quoted(names: &[String]) -> Vec<String> {
    names.iter().map(|name| format!("`{name}`")).collect()
}

/// The first names, and a sign that there are more.
fn a_few(names: &[String], most: usize) -> String {
    some_of(&names[..names.len().min(most)], names.len())
}

/// Some names of so many, and a sign that there are more.
fn some_of(names: &[String], all: usize) -> String {
    let more = match all > names.len() {
        true => ", …",
        false => "",
    };
    format!("{}{more}", quoted(names).join(", "))
}
