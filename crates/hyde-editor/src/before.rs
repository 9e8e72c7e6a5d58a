//! What stands before a place in a text that is being written: open brackets, the dotted name at the end.

use hyde_syntax::{comment_end, string_end};

/// The brackets that are open at the end of a text; nothing in a comment or a text.
pub(crate) fn open_brackets(before: &str) -> Option<Vec<(usize, char)>> {
    let mut open = Vec::new();
    let mut at = 0;
    while let Some(sign) = before[at..].chars().next() {
        let rest = &before[at..];
        at += if rest.starts_with("//") {
            rest.find('\n')?
        } else if rest.starts_with("/*") {
            comment_end(rest)?
        } else if sign == '"' {
            string_end(rest)?
        } else {
            match sign {
                '(' | '[' | '{' => open.push((at, sign)),
                ')' | ']' | '}' => drop(open.pop()),
                // A statement ends: a bracket before it was forgotten.
                ';' => open.retain(|(_, own)| *own == '{'),
                _ => {}
            }
            sign.len_utf8()
        };
    }
    Some(open)
}

/// The words of the dotted name at the end of a text, subscripts left out.
pub(crate) fn chain_words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text;
    loop {
        if rest.ends_with(']') {
            rest = match rest.rfind('[') {
                Some(at) => rest[..at].trim_end(),
                None => return Vec::new(),
            };
        }
        let start = rest
            .rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .map_or(0, |at| {
                at + rest[at..].chars().next().map_or(1, char::len_utf8)
            });
        if start == rest.len() {
            return words;
        }
        words.insert(0, &rest[start..]);
        match rest[..start].strip_suffix('.') {
            Some(before) => rest = before,
            None => return words,
        }
    }
}

/// The length of the dotted name at the end of a text, with its subscripts.
pub(crate) fn chain_len(text: &str) -> usize {
    let mut rest = text;
    loop {
        if rest.ends_with(']') {
            match rest.rfind('[') {
                Some(at) => rest = rest[..at].trim_end(),
                None => return text.len() - rest.len(),
            }
        }
        rest = rest.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
        match rest.strip_suffix('.') {
            Some(before) => rest = before,
            None => return text.len() - rest.len(),
        }
    }
}

/// Where the word at the end of a text begins.
pub(crate) fn word_start(text: &str) -> usize {
    text.rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .map_or(0, |at| {
            at + text[at..].chars().next().map_or(1, char::len_utf8)
        })
}
