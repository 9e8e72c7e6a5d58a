//! What users read is plain English: README, book, changelog, `--help` of every command, diagnostics and other texts in
//! the sources of the crates, and the descriptions in the library contain no phrase of `tests/english.toml`.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use hyde_tests::root;
use hyde_tests::wording::{Phrase, found, literals, phrases};
use std::path::{Path, PathBuf};
use std::process::Command;

#[test]
fn the_documents() {
    let phrases = phrases();
    let mut paths = [
        "README.md",
        "CHANGELOG.md",
        "ARCHITECTURE.md",
        "CONTRIBUTING.md",
        "packaging/README.md",
        "packaging/THIRD-PARTY.md",
    ]
    .map(|name| root().join(name))
    .to_vec();
    for folder in ["book/src", "examples", "tests"] {
        files(&root().join(folder), "md", &mut paths);
    }
    assert!(paths.len() > 80, "only {} pages were found", paths.len());
    let wrong = paths.iter().flat_map(|path| {
        let text = std::fs::read_to_string(path).unwrap();
        found(&phrases, &name(path), 1, &text)
    });
    check(wrong.collect());
}

#[test]
fn the_texts_in_the_sources() {
    let phrases = phrases();
    let mut paths = Vec::new();
    for extension in ["rs", "hyde"] {
        files(&root().join("crates"), extension, &mut paths);
    }
    paths.retain(|path| !is_of_tests(path));
    assert!(paths.len() > 500, "only {} sources were found", paths.len());
    let wrong = paths.iter().flat_map(|path| of_source(&phrases, path));
    check(wrong.collect());
}

#[test]
fn the_help_of_every_command() {
    let phrases = phrases();
    let help = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_hyde-tested"));
        let output = command.args(arguments).arg("--help").output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let all = help(&[]);
    let list = all.split_once("Commands:\n").unwrap().1;
    let list = list.split("\n\n").next().unwrap();
    // A line of a command is less far in than one that goes on with its text.
    let own = list.lines().filter(|line| !line.starts_with("   "));
    let commands: Vec<&str> = own
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(commands.len() > 15, "{commands:?}");
    let mut wrong = found(&phrases, "hyde --help", 1, &all);
    for name in commands {
        let text = help(&[name]);
        wrong.extend(found(&phrases, &format!("hyde {name} --help"), 1, &text));
    }
    check(wrong);
}

fn of_source(phrases: &[Phrase], path: &Path) -> Vec<String> {
    let source = std::fs::read_to_string(path).unwrap();
    let texts = literals(&source).into_iter();
    texts
        .flat_map(|(line, text)| found(phrases, &name(path), line, &text))
        .collect()
}

fn check(wrong: Vec<String>) {
    assert!(wrong.is_empty(), "\n{}\n", wrong.join("\n"));
}

fn is_of_tests(path: &Path) -> bool {
    let own = path.strip_prefix(root()).unwrap();
    let folder = own.components().any(|part| part.as_os_str() == "tests");
    folder || path.ends_with("tests.rs")
}

fn name(path: &Path) -> String {
    path.strip_prefix(root()).unwrap().display().to_string()
}

/// The files below a folder with an extension.
fn files(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    for path in paths {
        if path.is_dir() {
            files(&path, extension, found);
        } else if path.extension().is_some_and(|own| own == extension) {
            found.push(path);
        }
    }
}
