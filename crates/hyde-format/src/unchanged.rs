//! Whether two texts are the same but for white space: the same constructs, words and comments in the same order.

use crate::Source;
use crate::words::{Before, Part, Tree, Words};
use hyde_syntax::Rule;

/// Whether the trees of two texts are equal but for positions, and their comments are the same.
pub(crate) fn same(a: &Source, b: &Source) -> bool {
    let a_words = Words::of(a.text(), &a.written);
    let b_words = Words::of(b.text(), &b.written);
    let counts = a_words.words.len() == b_words.words.len()
        && a_words.parts.len() == b_words.parts.len()
        && a.errors.iter().count() == b.errors.iter().count();
    let signs = |source: &Source| -> String {
        let signs = source.text().chars();
        signs.filter(|sign| !sign.is_whitespace()).collect()
    };
    counts
        && signs(a) == signs(b)
        && a_words
            .words
            .iter()
            .zip(&b_words.words)
            .all(|(a, b)| a.text.trim_end() == b.text.trim_end() && comments(&a.before, &b.before))
        && comments(&a_words.rest, &b_words.rest)
        && a_words
            .parts
            .iter()
            .zip(&b_words.parts)
            .all(|(a, b)| part(a, b))
}

fn comments(a: &Before<'_>, b: &Before<'_>) -> bool {
    a.comments.len() == b.comments.len()
        && a.comments
            .iter()
            .zip(&b.comments)
            .all(|(a, b)| a.text == b.text)
}

fn part(a: &Part, b: &Part) -> bool {
    match (a, b) {
        (Part::Parsed(a), Part::Parsed(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| pieces(a, b))
        }
        (Part::Kept(a), Part::Kept(b)) => a == b,
        (Part::Parsed(_), Part::Kept(_)) | (Part::Kept(_), Part::Parsed(_)) => false,
    }
}

fn pieces(a: &(Rule, Vec<Tree>), b: &(Rule, Vec<Tree>)) -> bool {
    a.0 == b.0 && trees(&a.1, &b.1)
}

fn trees(a: &[Tree], b: &[Tree]) -> bool {
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| match (a, b) {
            (Tree::Word(a), Tree::Word(b)) => a == b,
            (Tree::Node(a, inner_a), Tree::Node(b, inner_b)) => a == b && trees(inner_a, inner_b),
            (Tree::Word(_), Tree::Node(..)) | (Tree::Node(..), Tree::Word(_)) => false,
        })
}
