//! The words that several refusals share: lists of names, counts, short names.

use super::Part;

/// A list of names as words.
pub(crate) fn and(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// So many of what has this name.
pub(crate) fn plural(count: usize, word: &str) -> String {
    if count == 1 {
        format!("1 {word}")
    } else {
        format!("{count} {word}s")
    }
}

/// The last part of a name, with the field before an end of it.
pub(crate) fn short(name: &str) -> &str {
    // `screw.q.left` is shown as `q.left`.
    match name.rsplit_once('.') {
        Some((before, "left" | "right")) => &name[before.rfind('.').map_or(0, |at| at + 1)..],
        Some((_, last)) => last,
        None => name,
    }
}

pub(super) fn parts_as_words(parts: &[Part]) -> String {
    let names: Vec<String> = parts.iter().map(|(name, _)| format!("`{name}`")).collect();
    and(&names)
}

pub(super) fn quoted(names: &[String]) -> Vec<String> {
    names.iter().map(|name| format!("`{name}`")).collect()
}

/// The first names, and a sign that there are more.
pub(super) fn a_few(names: &[String], most: usize) -> String {
    some_of(&names[..names.len().min(most)], names.len())
}

/// Some names of so many, and a sign that there are more.
pub(super) fn some_of(names: &[String], all: usize) -> String {
    let more = match all > names.len() {
        true => ", …",
        false => "",
    };
    format!("{}{more}", quoted(names).join(", "))
}
