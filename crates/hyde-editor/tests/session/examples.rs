//! Every handler on every example and on the library: nothing fails, and every use leads to a declaration of that name.

use crate::client::{Client, place};
use serde_json::json;
use std::path::{Path, PathBuf};

const AT: [&str; 7] = [
    "textDocument/hover",
    "textDocument/definition",
    "textDocument/documentHighlight",
    "textDocument/completion",
    "textDocument/prepareRename",
    "textDocument/references",
    "textDocument/signatureHelp",
];
const OF: [&str; 6] = [
    "textDocument/codeLens",
    "textDocument/inlayHint",
    "textDocument/documentSymbol",
    "textDocument/foldingRange",
    "textDocument/semanticTokens/full",
    "textDocument/formatting",
];

#[test]
fn every_handler_answers_on_every_example() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../..")
        .canonicalize()
        .unwrap();
    let mut files = Vec::new();
    for folder in ["examples", "crates/hyde-library/models"] {
        collect(&top.join(folder), &mut files);
    }
    files.sort();
    assert!(files.len() > 25);
    let (mut names, mut known) = (0, 0);
    let mut client = Client::new(&["utf-16"]);
    for file in &files {
        let path = file.to_str().unwrap();
        let text = std::fs::read_to_string(file).unwrap();
        client.open(path, &text);
        for method in OF {
            let answer = client.of(method, path);
            assert!(answer.get("error").is_none(), "{path}: {method}: {answer}");
        }
        // A prime number of steps: every kind of place is met.
        let words = words(&text);
        for (number, (byte, word)) in words.iter().enumerate().step_by(13) {
            let at = place(&text, *byte);
            for (kind, method) in AT.iter().enumerate() {
                if kind > 1 && number % 7 != 0 {
                    continue;
                }
                let answer = client.at(method, path, at);
                let failed = answer["error"]["code"] == -32603;
                assert!(!failed, "{path}: {method} at {at:?} `{word}`: {answer}");
                if kind == 1 {
                    names += 1;
                    known += usize::from(!answer.is_null());
                }
            }
        }
        client.tell(
            "textDocument/didClose",
            json!({ "textDocument": { "uri": crate::client::uri(path) } }),
        );
    }
    client.end();
    // The others are words of the language, functions of the language and columns of records.
    assert!(
        known * 2 > names,
        "{known} of {names} words have a definition"
    );
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|end| end == "hyde") {
            found.push(path);
        }
    }
}

/// The words of a text that stand in no comment and in no text.
fn words(text: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let code = line.split("//").next().unwrap_or_default();
        for (number, part) in code.split('"').enumerate() {
            let own = part.as_ptr() as usize - text.as_ptr() as usize;
            if number % 2 == 1 {
                continue;
            }
            let mut at = 0;
            while let Some(next) = part[at..].find(|c: char| c.is_ascii_alphabetic()) {
                let begin = at + next;
                let len = part[begin..]
                    .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
                    .unwrap_or(part.len() - begin);
                found.push((own + begin, &part[begin..begin + len]));
                at = begin + len;
            }
        }
        start += line.len();
    }
    assert_eq!(start, text.len());
    found
}
