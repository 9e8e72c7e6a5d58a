//! Random models, in random layouts and as the formatter prints them, have trees without errors; so have their edits the
//! trees of the edited texts.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

#[path = "../../../crates/hyde-format/tests/random/model.rs"]
mod model;

use model::{gap, model};
use proptest::prelude::*;
use tree_sitter::{InputEdit, Parser, Point};

fn parser() -> Parser {
    let mut parser = Parser::new();
    parser
        .set_language(&tree_sitter_hyde::LANGUAGE.into())
        .unwrap();
    parser
}

/// The row and column, in bytes, of a place in a text.
fn point(text: &str, at: usize) -> Point {
    let before = &text[..at];
    let line = before.rfind('\n').map_or(0, |end| end + 1);
    Point::new(before.matches('\n').count(), at - line)
}

#[test]
fn every_construct_of_the_formatter_has_a_tree() {
    let text = include_str!("../../../crates/hyde-format/tests/everything.txt");
    let tree = parser().parse(text, None).unwrap();
    assert!(!tree.root_node().has_error(), "{}", tree.root_node());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn random_models_have_trees_without_errors(
        (words, gaps, cut) in model().prop_flat_map(|words| {
            let count = words.len();
            (Just(words), prop::collection::vec(gap(), count), 0..count)
        })
    ) {
        let text: String = words.iter().zip(&gaps).flat_map(|(word, gap)| [word.as_str(), gap]).collect();
        let mut parser = parser();
        let mut tree = parser.parse(&text, None).unwrap();
        prop_assert!(!tree.root_node().has_error(), "{text}\n{}", tree.root_node());
        let formatted = hyde_format::format("random.hyde", &text).unwrap().text;
        let of_formatted = parser.parse(&formatted, None).unwrap();
        prop_assert!(!of_formatted.root_node().has_error(), "{formatted}");

        // An edit takes one word out.
        let start: usize = words.iter().zip(&gaps).take(cut).map(|(word, gap)| word.len() + gap.len()).sum();
        let end = start + words[cut].len();
        let edited = format!("{}{}", &text[..start], &text[end..]);
        tree.edit(&InputEdit {
            start_byte: start,
            old_end_byte: end,
            new_end_byte: start,
            start_position: point(&text, start),
            old_end_position: point(&text, end),
            new_end_position: point(&text, start),
        });
        let again = parser.parse(&edited, Some(&tree)).unwrap();
        let fresh = parser.parse(&edited, None).unwrap();
        if !fresh.root_node().has_error() {
            prop_assert_eq!(again.root_node().to_sexp(), fresh.root_node().to_sexp());
        }
    }
}
