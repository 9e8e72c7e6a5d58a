//! The methods of a type stand beside its declaration, or in the folder of that file. A type whose methods are all over a crate
//! is a global variable by another name: nobody can say what a pass that takes it reads and writes.

use super::{File, sources};
use std::collections::{BTreeMap, BTreeSet};

/// Types whose files are each one side of them: the crate, below `crates/hyde-`, and the type.
const SPREAD: &[(&str, &str)] = &[
    ("calibrate", "Diagnosis"),
    ("calibrate", "Forward"),
    ("calibrate", "Joint"),
    ("calibrate", "Observer"),
    ("calibrate", "Plant"),
    ("calibrate", "Problem"),
    ("calibrate", "Recording"),
    ("compiler", "File"),
    ("editor", "Place"),
    ("fmi", "Causality"),
    ("fmi", "Described"),
    ("fmi", "Variability"),
    ("ida", "Ida"),
    ("ir", "ExprArena"),
    ("modelica", "Names"),
    ("program", "Parameter"),
    ("program", "Program"),
    ("program", "Relation"),
    ("study", "Bench"),
    ("study", "Project"),
    ("syntax", "Builder"),
    ("syntax", "Element"),
    ("syntax", "File"),
    ("units", "Dimension"),
];

#[test]
fn methods_of_a_type_stand_in_its_file_or_folder() {
    let found = far_from_their_type(&sources());
    let known = |own: &Far| SPREAD.contains(&(own.krate.as_str(), own.name.as_str()));
    let new: Vec<String> = found
        .iter()
        .filter(|own| !known(own))
        .map(|own| format!("{}: `impl {}`, declared in {}", own.path, own.name, own.at))
        .collect();
    assert!(
        new.is_empty(),
        "make them functions of what they read and write:\n{}",
        new.join("\n")
    );
    let is_spread = |(krate, name): &(&str, &str)| {
        let mut all = found.iter();
        all.any(|own| own.krate == *krate && own.name == *name)
    };
    let gone: Vec<_> = SPREAD.iter().filter(|own| !is_spread(own)).collect();
    assert!(gone.is_empty(), "take from the list: {gone:?}");
}

#[test]
fn methods_far_from_their_type_are_found() {
    let file = |path: &str, text: &str| File {
        path: format!("crates/hyde-flatten/src/{path}"),
        text: text.to_owned(),
    };
    let found = |path: &str, text: &str| {
        let model = "pub(crate) struct Model<'a, 'd> {\n}\nimpl<'a, 'd> Model<'a, 'd> {\n}\n";
        let all = far_from_their_type(&[file("model.rs", model), file(path, text)]);
        all.len()
    };
    for text in [
        "impl Model<'_, '_> {\n}\n",
        "impl<'a> Model<'a, '_> {\n}\n",
        "impl<'a, F: Fn(&'a str) -> bool> crate::model::Model<'a, '_>\nwhere\n    F: Copy,\n{\n}\n",
    ] {
        assert_eq!(found("connect.rs", text), 1, "{text}");
        assert_eq!(found("experiment/model.rs", text), 1, "{text}");
        assert_eq!(found("model/lower/read.rs", text), 0, "{text}");
    }
    for text in [
        "impl Named for Model<'_, '_> {\n}\n",
        "impl<'a> From<Model<'a, '_>> for Flat {\n}\n",
        "struct Other;\nimpl Other {\n}\n",
        "fn model(model: &Model<'_, '_>) {\n}\n",
    ] {
        assert_eq!(found("connect.rs", text), 0, "{text}");
    }
}

/// Methods that stand neither in the file of their type nor in its folder.
struct Far {
    /// The crate, without `hyde-`.
    krate: String,
    path: String,
    name: String,
    /// Where the type is declared.
    at: String,
}

fn far_from_their_type(files: &[File]) -> Vec<Far> {
    let mut declared: BTreeMap<(&str, &str), BTreeSet<&str>> = BTreeMap::new();
    let product = files.iter().filter_map(|file| {
        let inside = file.path.strip_prefix("crates/hyde-")?;
        let (krate, rest) = inside.split_once('/')?;
        rest.starts_with("src/").then_some((krate, file))
    });
    let product: Vec<(&str, &File)> = product.collect();
    for &(krate, file) in &product {
        for name in file.text.lines().filter_map(declared_type) {
            let places = declared.entry((krate, name)).or_default();
            places.insert(&file.path);
        }
    }
    let mut found = Vec::new();
    for (krate, file) in product {
        for name in types_with_methods(&file.text) {
            // What a macro declares has no place of its own.
            let Some(places) = declared.get(&(krate, name.as_str())) else {
                continue;
            };
            if places.iter().any(|at| is_beside(&file.path, at)) {
                continue;
            }
            let at: Vec<&str> = places.iter().copied().collect();
            found.push(Far {
                krate: krate.to_owned(),
                path: file.path.clone(),
                at: at.join(", "),
                name,
            });
        }
    }
    found
}

/// Whether a path is that of a file, or lies in the folder of that name.
fn is_beside(path: &str, file: &str) -> bool {
    let folder = file.strip_suffix(".rs");
    let rest = folder.and_then(|folder| path.strip_prefix(folder));
    path == file || rest.is_some_and(|rest| rest.starts_with('/'))
}

/// The type that a line declares.
fn declared_type(line: &str) -> Option<&str> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let at = words
        .iter()
        .position(|word| matches!(*word, "struct" | "enum" | "union"))?;
    let alone = at == 0 || (at == 1 && words[0].starts_with("pub"));
    let name = words.get(at + 1).filter(|_| alone)?;
    name.split(|c: char| !(c.is_alphanumeric() || c == '_'))
        .next()
}

/// The types that a file has methods of, without those of traits.
fn types_with_methods(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let text = format!("\n{text}");
    let heads = text.split("\nimpl").skip(1);
    for head in heads {
        let head = head.split('{').next().unwrap_or_default();
        let mut depth = 0_u32;
        let mut before = ' ';
        let mut bare = String::new();
        for c in head.chars() {
            match c {
                '<' => depth += 1,
                '>' if before != '-' => depth = depth.saturating_sub(1),
                _ if depth == 0 => bare.push(if c.is_whitespace() { ' ' } else { c }),
                _ => {}
            }
            before = c;
        }
        if bare.contains(" for ") {
            continue;
        }
        let path = bare.split_whitespace().next().unwrap_or_default();
        let name = path.rsplit("::").next().unwrap_or_default();
        found.push(name.to_owned());
    }
    found
}
