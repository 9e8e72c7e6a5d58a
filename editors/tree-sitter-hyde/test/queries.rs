//! The queries: every capture is one that editors know, every word of the language has a colour, and one file in its colours.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
#![allow(clippy::disallowed_methods, reason = "tests read files")]

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tree_sitter::{Node, Parser, Query, QueryCursor, StreamingIterator, Tree};
use tree_sitter_hyde::{FOLDS, HIGHLIGHTS, INDENTS, LANGUAGE, LOCALS, NODE_TYPES};

/// Names of Neovim, `:help treesitter-highlight-groups`.
const OF_NEOVIM: &str = "attribute boolean comment constant.builtin function function.builtin function.call keyword \
    keyword.conditional keyword.import keyword.modifier keyword.operator keyword.repeat keyword.type label module number \
    operator punctuation.bracket punctuation.delimiter string string.documentation string.escape string.special type \
    type.builtin variable variable.member variable.parameter";

/// Names of Helix, in its page on themes.
const OF_HELIX: &str = "attribute comment constant.builtin constant.builtin.boolean constant.character.escape \
    constant.numeric function function.builtin keyword keyword.control.conditional keyword.control.import \
    keyword.control.repeat keyword.operator keyword.storage.modifier keyword.storage.type label namespace operator \
    punctuation.bracket punctuation.delimiter string string.special type type.builtin variable variable.other.member \
    variable.parameter";

/// Each name of Neovim that Helix has no colour for, with the one of Helix.
const RENAMED: [(&str, &str); 14] = [
    ("boolean", "constant.builtin.boolean"),
    ("function.call", "function"),
    ("indent.begin", "indent"),
    ("indent.branch", "outdent"),
    ("keyword.conditional", "keyword.control.conditional"),
    ("keyword.import", "keyword.control.import"),
    ("keyword.modifier", "keyword.storage.modifier"),
    ("keyword.repeat", "keyword.control.repeat"),
    ("keyword.type", "keyword.storage.type"),
    ("module", "namespace"),
    ("number", "constant.numeric"),
    ("string.documentation", "string"),
    ("string.escape", "constant.character.escape"),
    ("variable.member", "variable.other.member"),
];

fn top() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn query(text: &str) -> Query {
    Query::new(&LANGUAGE.into(), text).unwrap_or_else(|error| panic!("{error}"))
}

fn tree(text: &str) -> Tree {
    let mut parser = Parser::new();
    parser.set_language(&LANGUAGE.into()).unwrap();
    parser.parse(text, None).unwrap()
}

/// The texts of the formatter and of the library, and those of models that use rare words.
fn texts() -> Vec<String> {
    let mut found = vec![
        include_str!("../../../crates/hyde-format/tests/everything.txt").to_owned(),
        include_str!("rare.hyde").to_owned(),
    ];
    for entry in std::fs::read_dir(top().join("crates/hyde-library/models")).unwrap() {
        let path = entry.unwrap().path();
        if path.is_file() {
            found.push(std::fs::read_to_string(path).unwrap());
        }
    }
    found
}

#[test]
fn captures_are_those_that_editors_know() {
    let known = |captures: &str, text: &str| {
        let known: BTreeSet<&str> = captures.split_whitespace().collect();
        let query = query(text);
        let used: BTreeSet<&str> = query.capture_names().iter().copied().collect();
        assert_eq!(used, known);
    };
    known(OF_NEOVIM, HIGHLIGHTS);
    known("fold", FOLDS);
    known("indent.begin indent.branch", INDENTS);
    known("local.definition local.reference local.scope", LOCALS);
}

/// `HYDE_UPDATE=1` writes the files.
#[test]
fn the_queries_of_helix_are_those_of_neovim_with_its_names() {
    for (name, text, captures) in [
        ("highlights", HIGHLIGHTS, OF_HELIX),
        ("indents", INDENTS, "indent outdent"),
    ] {
        let mut renamed = String::new();
        for (index, part) in text.split('@').enumerate() {
            let end = part.find(|c: char| !(c.is_ascii_lowercase() || c == '.'));
            let (capture, rest) = part.split_at(end.unwrap_or(part.len()));
            let new = RENAMED.iter().find(|(old, _)| *old == capture);
            match (index, new) {
                (0, _) => renamed.push_str(part),
                (_, Some((_, new))) => renamed.push_str(&format!("@{new}{rest}")),
                (_, None) => renamed.push_str(&format!("@{part}")),
            }
        }
        let path = top().join(format!("editors/helix/queries/hyde/{name}.scm"));
        let line = "; Made by `./dev grammar` from editors/tree-sitter-hyde/queries, with the names of Helix.\n\n";
        let renamed = format!("{line}{renamed}");
        if std::env::var_os("HYDE_UPDATE").is_some() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, &renamed).unwrap();
        }
        assert_eq!(std::fs::read_to_string(&path).unwrap(), renamed);
        let query = query(&renamed);
        let used: BTreeSet<&str> = query.capture_names().iter().copied().collect();
        assert_eq!(used, captures.split_whitespace().collect());
    }
    let query = std::fs::read_to_string(top().join("editors/helix/queries/hyde/textobjects.scm"));
    let query = Query::new(&LANGUAGE.into(), &query.unwrap()).unwrap();
    let used = query.capture_names();
    assert!(
        used.iter()
            .all(|name| name.ends_with(".around") || name.ends_with(".inside"))
    );
}

/// The words that are kinds of nodes.
fn words() -> BTreeSet<String> {
    let types: Value = serde_json::from_str(NODE_TYPES).unwrap();
    let kinds = types.as_array().unwrap().iter();
    let kinds = kinds.filter(|kind| kind["named"] == false);
    kinds
        .filter_map(|kind| kind["type"].as_str())
        .filter(|kind| kind.starts_with(|c: char| c.is_ascii_alphabetic()))
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_parser_has_the_rules_of_its_grammar() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(folder.join("grammar.js")).unwrap();
    let rules = text.split("  rules: {").nth(1).unwrap().lines();
    let name = |line: &str| {
        let line = line
            .strip_prefix("    ")
            .filter(|line| !line.starts_with(' '))?;
        Some(line.split_once(" => ")?.0.split(':').next()?.to_owned())
    };
    let expected: BTreeSet<String> = rules.filter_map(name).collect();
    let json = std::fs::read_to_string(folder.join("src/grammar.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let found = json["rules"].as_object().unwrap().keys().cloned().collect();
    assert_eq!(expected, found, "run `./dev grammar`");
}

#[test]
fn the_parser_has_every_word_of_the_language() {
    let grammar = std::fs::read_to_string(top().join("grammar/hyde.pest")).unwrap();
    let rules = grammar.lines().filter_map(|line| line.strip_prefix("kw_"));
    let mut expected: BTreeSet<String> = rules
        .filter_map(|line| Some(line.split([' ', '=']).next()?.to_owned()))
        .collect();
    assert!(expected.len() > 70, "{}", expected.len());
    for other in ["enter", "leave", "true", "false", "and", "or", "not"] {
        expected.insert(other.to_owned());
    }
    assert_eq!(words(), expected);
}

#[test]
fn every_word_has_a_colour_and_every_pattern_is_used() {
    let query = query(HIGHLIGHTS);
    let (mut seen, mut plain) = (BTreeSet::new(), BTreeSet::new());
    let mut unused: BTreeSet<usize> = (0..query.pattern_count()).collect();
    for text in texts() {
        let tree = tree(&text);
        assert!(!tree.root_node().has_error(), "{text}");
        let mut coloured = BTreeSet::new();
        let mut cursor = QueryCursor::new();
        let mut captures = cursor.captures(&query, tree.root_node(), text.as_bytes());
        while let Some((found, index)) = captures.next() {
            unused.remove(&found.pattern_index);
            coloured.insert(found.captures()[*index].node.byte_range().start);
        }
        each(tree.root_node(), &mut |node| {
            if !node.is_named() && node.kind().starts_with(|c: char| c.is_ascii_alphabetic()) {
                seen.insert(node.kind().to_owned());
                if !coloured.contains(&node.start_byte()) {
                    plain.insert(node.kind().to_owned());
                }
            }
        });
    }
    assert_eq!(plain, BTreeSet::new());
    assert_eq!(seen, words());
    let unused = unused.into_iter();
    let unused: Vec<&str> = unused
        .map(|pattern| {
            &HIGHLIGHTS[query.start_byte_for_pattern(pattern)..query.end_byte_for_pattern(pattern)]
        })
        .collect();
    assert!(unused.is_empty(), "{unused:?}");
}

fn each<'t>(node: Node<'t>, take: &mut impl FnMut(Node<'t>)) {
    // A word that is a name here is the child of that name.
    if node.kind() == "identifier" {
        return;
    }
    take(node);
    for child in node.children(&mut node.walk()).collect::<Vec<_>>() {
        each(child, take);
    }
}

#[test]
fn the_first_example_in_colours() {
    let text = std::fs::read_to_string(top().join("examples/first/first.hyde")).unwrap();
    let tree = tree(&text);
    let query = query(HIGHLIGHTS);
    let mut colours = BTreeMap::new();
    let mut cursor = QueryCursor::new();
    let mut captures = cursor.captures(&query, tree.root_node(), text.as_bytes());
    while let Some((found, index)) = captures.next() {
        let capture = found.captures()[*index];
        let place = (capture.node.start_byte(), capture.node.end_byte());
        // The later pattern wins.
        let older = colours.insert(place, (found.pattern_index, capture.index));
        if let Some(older) = older.filter(|older| older.0 > found.pattern_index) {
            colours.insert(place, older);
        }
    }
    let mut lines: Vec<String> = text.lines().map(|_| String::new()).collect();
    for ((start, end), (_, capture)) in colours {
        let name = query.capture_names()[capture as usize];
        if !(name.starts_with("punctuation") || name == "operator") {
            let line = &mut lines[text[..start].matches('\n').count()];
            line.push_str(&format!("{name}:{} ", &text[start..end]));
        }
    }
    let lines: Vec<&str> = lines.iter().map(|line| line.trim_end()).collect();
    insta::assert_snapshot!(lines.join("\n"));
}
