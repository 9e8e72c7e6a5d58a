//! The components of the library, with the first line of what is said of each.

use hyde_diag::{Diagnostics, Sources};
use hyde_library::PACKAGES;
use hyde_syntax::ast::{ClassKind, Item};
use serde_json::{Value, json};

/// The classes of the library whose name or documentation contains a word, in any case.
pub(crate) fn components(word: &str) -> Value {
    let word = word.to_lowercase();
    let mut found = Vec::new();
    for package in PACKAGES {
        let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
        let file = sources.add(package.name, package.text);
        let tree = hyde_syntax::parse(&sources, file, &mut diagnostics);
        for item in &tree.items {
            let Item::Class(class) = item else {
                continue;
            };
            let name = format!("{}.{}", package.name, class.name.text);
            let doc = class.doc.clone().unwrap_or_default();
            if !name.to_lowercase().contains(&word) && !doc.to_lowercase().contains(&word) {
                continue;
            }
            let kind = match class.kind {
                ClassKind::Model => "model",
                ClassKind::Connector => "connector",
                ClassKind::Effect => "effect",
                ClassKind::Function => "function",
            };
            let doc = doc.lines().next().unwrap_or_default().to_owned();
            found.push(json!({ "name": name, "kind": kind, "about": doc }));
        }
    }
    Value::Array(found)
}
