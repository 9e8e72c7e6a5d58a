//! The matcher finds what pest finds: the same constructs at the same places, and no match where pest has none.

use super::{Pair, parse};
use crate::grammar::{HydeParser, Rule};
use crate::recover::Scanner;
use pest::Parser as _;
use std::path::{Path, PathBuf};

/// What the parser asks for somewhere, and what is deep.
const RULES: [Rule; 20] = [
    Rule::package_clause,
    Rule::import_clause,
    Rule::type_item,
    Rule::fmu_item,
    Rule::short_item,
    Rule::class_header,
    Rule::experiment_header,
    Rule::study_header,
    Rule::section,
    Rule::element,
    Rule::experiment_item,
    Rule::study_item,
    Rule::end_clause,
    Rule::record,
    Rule::expression,
    Rule::modification,
    Rule::keyword,
    Rule::ident,
    Rule::quantity,
    Rule::COMMENT,
];

type Found = Vec<(Rule, usize, usize, usize)>;

fn ours(pairs: impl Iterator<Item = Pair<'static>>, depth: usize, found: &mut Found) {
    for pair in pairs {
        found.push((pair.as_rule(), pair.start(), pair.end(), depth));
        ours(pair.into_inner(), depth + 1, found);
    }
}

fn pests(pairs: pest::iterators::Pairs<'_, Rule>, depth: usize, found: &mut Found) {
    for pair in pairs {
        let span = pair.as_span();
        found.push((pair.as_rule(), span.start(), span.end(), depth));
        pests(pair.into_inner(), depth + 1, found);
    }
}

/// Both, or a message with the rule and the text.
fn compare(rule: Rule, text: &str) -> bool {
    let kept: &'static str = Box::leak(text.to_owned().into_boxed_str());
    let mine = parse(rule, kept).map(|pairs| {
        let mut found = Found::new();
        ours(pairs, 0, &mut found);
        found
    });
    let theirs = HydeParser::parse(rule, text).ok().map(|pairs| {
        let mut found = Found::new();
        pests(pairs, 0, &mut found);
        found
    });
    assert_eq!(mine, theirs, "{rule:?} on\n{text}");
    mine.is_some()
}

fn models(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        let path = entry.path();
        if path.is_dir() {
            models(&path, found);
        } else if path.extension().is_some_and(|end| end == "hyde") {
            found.push(path);
        }
    }
}

/// A generator of numbers that are the same at every run (a linear congruence, Knuth's constants).
struct Numbers(u64);

impl Numbers {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap_or(0) % end.max(1)
    }
}

/// A piece of text with a few characters or words lost, doubled or put in from elsewhere.
fn damaged(piece: &str, numbers: &mut Numbers) -> String {
    const SIGNS: [&str; 18] = [
        ";", "(", ")", "[", "]", "{", "}", "=", "\"", "..", "//", "/*", "*/", "end", "if", "±",
        " then ", "é",
    ];
    let mut words: Vec<&str> = piece
        .split_inclusive(|c: char| !c.is_alphanumeric())
        .collect();
    for _ in 0..=numbers.below(3) {
        let at = numbers.below(words.len());
        match numbers.below(3) {
            0 if at < words.len() => {
                words.remove(at);
            }
            1 => words.insert(at, SIGNS[numbers.below(SIGNS.len())]),
            _ => {
                let other = words.get(numbers.below(words.len())).copied();
                words.insert(at, other.unwrap_or(";"));
            }
        }
    }
    words.concat()
}

#[expect(
    clippy::disallowed_methods,
    reason = "a test reads the models of the project"
)]
#[test]
fn on_every_file_and_on_damaged_ones() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files = Vec::new();
    for folder in [
        "crates/hyde-library/models",
        "examples",
        "tests/models",
        "tests/fixtures",
    ] {
        models(&root.join(folder), &mut files);
    }
    files.sort();
    assert!(files.len() > 100, "found {} files", files.len());
    let mut numbers = Numbers(1);
    let (mut matched, mut not) = (0_usize, 0_usize);
    let mut count = |found: bool| if found { matched += 1 } else { not += 1 };
    for path in files {
        let Ok(text) = std::fs::read_to_string(&path) else {
            continue;
        };
        let mut places: Vec<usize> = Scanner::new(&text, 0).map(|(at, _)| at).collect();
        places.push(text.len());
        for _ in 0..150 {
            let first = numbers.below(places.len());
            let last = (first + 1 + numbers.below(60)).min(places.len() - 1);
            let rest = &text[places[first]..];
            let rule = RULES[numbers.below(RULES.len())];
            count(compare(Rule::element, rest));
            count(compare(rule, rest));
            let piece = damaged(&text[places[first]..places[last.max(first)]], &mut numbers);
            count(compare(Rule::element, &piece));
            count(compare(Rule::expression, &piece));
            count(compare(rule, &piece));
        }
    }
    assert!(
        matched > 5_000 && not > 5_000,
        "{matched} matched, {not} did not"
    );
}

#[test]
fn on_what_is_easily_missed() {
    let texts = [
        "",
        " ",
        "a",
        "end",
        "endx",
        "a /* b */ + // c\n d",
        "a + /* not ended",
        "1e5",
        "1e",
        "1E-3 [mm]",
        "1 [",
        "-a^-b^c",
        "x.\"Time [ms]\"[2:3]",
        "\"a \\\" b\"",
        "{i^2 for i in 1:3}[mm]",
        "if a then b else c",
        "f(x = 1, y == 2)",
        "not a and b or c <= d",
    ];
    for text in texts {
        for rule in RULES {
            compare(rule, text);
        }
    }
}
