//! The trees of `test/corpus`, in the format of `tree-sitter test`.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
#![allow(clippy::disallowed_methods, reason = "tests read the corpus")]

use std::path::Path;
use tree_sitter::Parser;

#[test]
fn every_text_of_the_corpus_has_its_tree() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("test/corpus");
    let mut parser = Parser::new();
    parser
        .set_language(&tree_sitter_hyde::LANGUAGE.into())
        .unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let content = std::fs::read_to_string(&path).unwrap();
        for (name, text, expected) in cases(&content) {
            let tree = parser.parse(&text, None).unwrap();
            let found = tree.root_node().to_sexp();
            assert_eq!(
                words(&found),
                words(&expected),
                "{}: {name}",
                path.display()
            );
            count += 1;
        }
    }
    assert!(count >= 20, "{count}");
}

/// Name, text and tree of each case: the name between lines of `=`, the tree behind a line of `-`.
fn cases(content: &str) -> Vec<(String, String, String)> {
    let is_rule = |line: &str, sign: char| line.len() >= 10 && line.chars().all(|c| c == sign);
    let mut found = Vec::new();
    let mut lines = content.lines().peekable();
    while let Some(line) = lines.next() {
        if !is_rule(line, '=') {
            continue;
        }
        let name = lines.next().unwrap_or_default().to_owned();
        assert!(
            lines.next().is_some_and(|line| is_rule(line, '=')),
            "{name}"
        );
        let (mut text, mut tree, mut behind) = (String::new(), String::new(), false);
        while let Some(&line) = lines.peek() {
            if is_rule(line, '=') {
                break;
            }
            lines.next();
            if is_rule(line, '-') {
                behind = true;
            } else {
                let part = if behind { &mut tree } else { &mut text };
                part.push_str(line);
                part.push('\n');
            }
        }
        found.push((name, text, tree));
    }
    found
}

/// A tree on one line.
fn words(tree: &str) -> String {
    let words: Vec<&str> = tree.split_whitespace().collect();
    words.join(" ").replace("( ", "(").replace(" )", ")")
}
