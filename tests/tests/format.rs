//! `hyde fmt` on every model file of the project: each is formatted, and those with errors keep their trees.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use hyde_diag::{Diagnostics, Sources};
use std::path::{Path, PathBuf};

#[test]
fn every_model_file_is_formatted() {
    let mut unformatted = Vec::new();
    let (mut count, mut wrong) = (0, 0);
    for path in model_files() {
        let name = path.display().to_string();
        // Some fixtures are no UTF-8 text.
        let Ok(text) = std::fs::read_to_string(&path) else {
            continue;
        };
        let formatted = hyde_format::format(&name, &text).unwrap();
        count += 1;
        if formatted.errors.is_empty() {
            if formatted.text != text {
                unformatted.push(name);
            }
            continue;
        }
        wrong += 1;
        assert_eq!(tree(&formatted.text), tree(&text), "{name}");
        let again = hyde_format::format(&name, &formatted.text).unwrap();
        assert_eq!(again.text, formatted.text, "{name}");
    }
    assert!(
        count > 500 && wrong > 20,
        "{count} files, {wrong} with errors"
    );
    assert!(
        unformatted.is_empty(),
        "format them with `hyde fmt`:\n{}",
        unformatted.join("\n")
    );
}

/// The tree as text, and its errors without their places.
fn tree(text: &str) -> (String, Vec<String>) {
    let mut sources = Sources::new();
    let file = sources.add("test.hyde", text.trim_start_matches('\u{feff}'));
    let mut diagnostics = Diagnostics::new();
    let tree = hyde_syntax::parse(&sources, file, &mut diagnostics);
    let errors = diagnostics.iter().map(|error| error.message.clone());
    (hyde_syntax::format(&tree), errors.collect())
}

fn model_files() -> Vec<PathBuf> {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut found = Vec::new();
    for folder in ["crates", "examples", "tests"] {
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
        } else if path.extension().is_some_and(|end| end == "hyde") {
            found.push(path);
        }
    }
}
