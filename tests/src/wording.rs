//! Phrases that no text for users contains: the list in `tests/english.toml`, and where a text has one.

use crate::root;
use serde::Deserialize;

/// What `tests/english.toml` says.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct List {
    phrase: Vec<Phrase>,
}

/// Phrases that mean the same, and what to write instead.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Phrase {
    /// The phrases; `…` stands for one word.
    text: Vec<String>,
    /// The better wording.
    write: String,
    /// Words after which the phrase is right.
    #[serde(default)]
    not_after: Vec<String>,
    /// Words before which it is right.
    #[serde(default)]
    not_before: Vec<String>,
}

/// A word of a text: as written, as compared, and its line.
struct Word<'t> {
    written: &'t str,
    compared: String,
    line: usize,
}

/// The list of phrases.
///
/// # Panics
///
/// If the list cannot be read.
#[must_use]
#[allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open their lists, and unwrap what must be there"
)]
pub fn phrases() -> Vec<Phrase> {
    let text = std::fs::read_to_string(root().join("tests/english.toml")).unwrap();
    toml::from_str::<List>(&text).unwrap().phrase
}

/// The phrases of the list in a text that begins at a line of a file: `FILE:LINE: write … instead of …`.
#[must_use]
pub fn found(phrases: &[Phrase], file: &str, first_line: usize, text: &str) -> Vec<String> {
    let words = words(first_line, text);
    let mut found = Vec::new();
    for phrase in phrases {
        for wrong in &phrase.text {
            let wanted: Vec<&str> = wrong.split(' ').collect();
            let places = (0..words.len()).filter(|&at| phrase.is_at(&words, at, &wanted));
            found.extend(places.map(|at| {
                let line = words[at].line;
                format!(
                    "{file}:{line}: write `{}` instead of `{wrong}`",
                    phrase.write
                )
            }));
        }
    }
    found
}

impl Phrase {
    fn is_at(&self, words: &[Word<'_>], at: usize, wanted: &[&str]) -> bool {
        let Some(own) = words.get(at..at + wanted.len()) else {
            return false;
        };
        let same = own
            .iter()
            .zip(wanted)
            .all(|(word, wanted)| *wanted == "…" || word.compared == *wanted);
        // A phrase does not go on over the end of a clause.
        let inner = &own[..own.len() - 1];
        let whole = !inner.iter().any(|word| word.ends_clause());
        let before = at.checked_sub(1).map(|at| words[at].compared.as_str());
        let right_before = before.is_some_and(|word| self.not_after.iter().any(|own| own == word));
        let rest = &words[at + wanted.len()..];
        let right_after = self.not_before.iter().any(|right| {
            let right: Vec<&str> = right.split(' ').collect();
            right.len() <= rest.len()
                && right
                    .iter()
                    .zip(rest)
                    .all(|(right, word)| *right == word.compared)
        });
        same && whole && !right_before && !right_after
    }
}

impl Word<'_> {
    fn ends_clause(&self) -> bool {
        self.written.ends_with(['.', ',', ';', ':', '!', '?', ')'])
    }
}

fn words(first_line: usize, text: &str) -> Vec<Word<'_>> {
    let lines = text.lines().enumerate();
    let each = lines.flat_map(|(number, line)| {
        line.split_whitespace().map(move |written| Word {
            written,
            compared: written
                .trim_matches(|letter: char| !letter.is_alphanumeric() && letter != '`')
                .to_lowercase(),
            line: first_line + number,
        })
    });
    each.filter(|word| !word.compared.is_empty()).collect()
}

/// The string literals of a Rust or Hyde source, with their lines. Comments are passed, and so are unit tests at its end.
#[must_use]
pub fn literals(source: &str) -> Vec<(usize, String)> {
    let source = source
        .split_once("\nmod tests {")
        .map_or(source, |(head, _)| head);
    let mut found = Vec::new();
    let mut rest = source;
    while let Some(at) = rest.find(['"', '/', '\'']) {
        let line = source[..source.len() - rest.len() + at]
            .matches('\n')
            .count()
            + 1;
        let opens_raw = rest[..at].ends_with('#');
        rest = &rest[at..];
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if rest.starts_with("'\"'") {
            3
        } else if let Some(escaped) = rest.strip_prefix("'\\") {
            let mut letters = escaped.char_indices().skip(1);
            let end = letters.find(|(_, letter)| *letter == '\'');
            end.map_or(rest.len(), |(end, _)| end + 3)
        } else if rest.starts_with('"') {
            let (text, length) = literal(rest, opens_raw);
            found.push((line, text));
            length
        } else {
            1
        };
        rest = &rest[length..];
    }
    found
}

/// The text of the literal that a source begins with, and how long it is there.
fn literal(source: &str, raw: bool) -> (String, usize) {
    let end = if raw {
        source[1..].find("\"#").map(|end| end + 1)
    } else {
        let mut escaped = false;
        source.char_indices().skip(1).find_map(|(at, letter)| {
            let ends = letter == '"' && !escaped;
            escaped = letter == '\\' && !escaped;
            ends.then_some(at)
        })
    };
    let end = end.unwrap_or(source.len() - 1);
    // A `\` at the end of a line joins it with the next.
    (
        source[1..end].replace("\\\n", "\n").replace("\\n", " "),
        end + 1,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phrase_is_found_over_the_end_of_a_line_and_where_it_is_right_it_is_not() {
        let phrases = vec![Phrase {
            text: vec!["is no".to_owned()],
            write: "is not a".to_owned(),
            not_after: vec!["there".to_owned()],
            not_before: vec!["longer".to_owned()],
        }];
        let text = "A unit.\nThis is\nno unit. There is no unit. It is no longer a unit.";
        assert_eq!(
            found(&phrases, "page.md", 1, text),
            ["page.md:2: write `is not a` instead of `is no`"]
        );
    }

    #[test]
    fn literals_are_those_of_the_code() {
        let source = "// a \"comment\"\nlet a = \"one \\\"two\\\"\"; let q = '\"';\nlet b = r#\"raw \"text\"\"#;\n";
        let found: Vec<String> = literals(source).into_iter().map(|(_, text)| text).collect();
        assert_eq!(found, ["one \\\"two\\\"", "raw \"text\""]);
    }
}
