//! Every `.hyde` file of the project: the parser for editors accepts what the compiler accepts, and refuses what it refuses.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
#![allow(
    clippy::disallowed_methods,
    reason = "tests read the files of the project"
)]

use hyde_diag::{Code, Diagnostics, Sources};
use std::path::{Path, PathBuf};
use tree_sitter::{Node, Parser};

#[test]
fn accepts_and_refuses_what_the_compiler_does() {
    let (mut accepted, mut refused, mut wrong) = (0, 0, Vec::new());
    let mut parser = Parser::new();
    parser
        .set_language(&tree_sitter_hyde::LANGUAGE.into())
        .unwrap();
    for path in files() {
        let text = std::fs::read_to_string(&path).unwrap();
        let text = text.trim_start_matches('\u{feff}');
        let tree = parser.parse(text, None).unwrap();
        let error = tree.root_node().has_error();
        let of_compiler = syntax_errors(text);
        match (of_compiler.is_empty(), error) {
            (true, false) => accepted += 1,
            (false, true) => refused += 1,
            (true, true) => wrong.push(format!("{}: {}", path.display(), place(tree.root_node()))),
            (false, false) => wrong.push(format!("{}: no error; {of_compiler:?}", path.display())),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(accepted > 500 && refused > 20, "{accepted}, {refused}");
}

/// Errors that the compiler finds beyond its grammar. The parser has the version 14 of tree-sitter's tables, which editors
/// of several years read; only version 15 has reserved words.
const BEYOND: [&str; 4] = [
    "cannot be a name",
    "Hyde has no `initial()`",
    "a range goes from the lower bound",
    "two signs stand one behind the other",
];

/// Errors of the grammar that have the code of a wrong name behind `end`.
const ENDS: [&str; 2] = ["ends without its name", "has no end"];

/// The messages of the compiler's parser.
fn syntax_errors(text: &str) -> Vec<String> {
    let mut sources = Sources::new();
    let file = sources.add("file.hyde", text);
    let mut diagnostics = Diagnostics::new();
    hyde_syntax::parse(&sources, file, &mut diagnostics);
    let errors = diagnostics.iter().filter(|found| {
        found.code == Code::Syntax || ENDS.iter().any(|part| found.message.ends_with(part))
    });
    let messages = errors.map(|found| found.message.clone());
    let beyond = |message: &String| BEYOND.iter().any(|part| message.contains(part));
    messages.filter(|message| !beyond(message)).collect()
}

/// Where the first error of a tree is.
fn place(node: Node<'_>) -> String {
    if node.is_error() || node.is_missing() {
        return format!("{} {}", node.start_position(), node.to_sexp());
    }
    let mut children = node
        .children(&mut node.walk())
        .collect::<Vec<_>>()
        .into_iter();
    children
        .find(|child| child.has_error() || child.is_missing())
        .map_or_else(String::new, place)
}

/// Every `.hyde` file below the folders of the project.
fn files() -> Vec<PathBuf> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut found = Vec::new();
    for folder in [
        "book",
        "crates",
        "editors/tree-sitter-hyde",
        "examples",
        "fuzz",
        "tests",
    ] {
        collect(&top.join(folder), &mut found);
    }
    found.sort();
    found
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        } else if path
            .extension()
            .is_some_and(|extension| extension == "hyde")
        {
            found.push(path);
        }
    }
}
