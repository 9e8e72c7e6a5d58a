//! Random models in random layouts, with comments: formatting is a fixed point and keeps the tree.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

#[path = "random/model.rs"]
mod model;

use hyde_diag::{Diagnostics, Sources};
use model::{gap, model};
use proptest::prelude::*;

fn tree(text: &str) -> (String, usize) {
    let mut sources = Sources::new();
    let file = sources.add("random.hyde", text);
    let mut diagnostics = Diagnostics::new();
    let tree = hyde_syntax::parse(&sources, file, &mut diagnostics);
    (hyde_syntax::format(&tree), diagnostics.error_count())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn random_models_keep_their_tree_and_are_formatted_once(
        (words, gaps) in model().prop_flat_map(|words| {
            let count = words.len();
            (Just(words), prop::collection::vec(gap(), count))
        })
    ) {
        let text: String = words.iter().zip(&gaps).flat_map(|(word, gap)| [word.as_str(), gap]).collect();
        let (before, errors) = tree(&text);
        prop_assert_eq!(errors, 0, "{}", text);
        let formatted = hyde_format::format("random.hyde", &text).unwrap().text;
        prop_assert_eq!(tree(&formatted).0, before);
        prop_assert_eq!(formatted.matches("comment").count(), text.matches("comment").count());
        let again = hyde_format::format("random.hyde", &formatted).unwrap().text;
        prop_assert_eq!(again, formatted);
    }

    #[test]
    fn any_text_is_formatted_without_a_panic(text in "(model|end|A|;|\"|//|/\\*|\\*/|\n| |equation|=|\\{|\\}|x|1|experiment|of|\\(|\\)){0,60}") {
        let formatted = hyde_format::format("any.hyde", &text);
        prop_assert!(formatted.is_ok(), "{:?}", formatted.err());
    }
}
