//! Folders of a crate are rooms: each exports a few items and uses only the rooms above it, in the order in which `lib.rs`
//! leads through them. So no circle of modules crosses a folder.

use super::{File, sources};
use std::collections::BTreeSet;

/// Crates whose top-level modules are rooms.
const CRATES: &[&str] = &["hyde-calibrate"];

#[test]
fn folders_use_only_those_above_them() {
    for name in CRATES {
        let top = format!("crates/{name}/src/");
        let files: Vec<File> = sources()
            .into_iter()
            .filter_map(|file| {
                let path = file.path.strip_prefix(&top)?.to_owned();
                let text = file.text;
                Some(File { path, text })
            })
            .collect();
        let wrong = uses_against_the_order(&files);
        assert!(wrong.is_empty(), "{name}:\n{}", wrong.join("\n"));
    }
}

#[test]
fn a_use_against_the_order_is_found() {
    let lib = "//! ```text\n//! plant    the plant\n//! observer round it\n//! ```\n";
    let file = |path: &str, text: &str| File {
        path: path.to_owned(),
        text: text.to_owned(),
    };
    let found = |path: &str, text: &str| {
        let files = [
            file("lib.rs", lib),
            file("plant.rs", "mod step;\n"),
            file("observer.rs", "use crate::plant::Plant;\n"),
            file(path, text),
        ];
        uses_against_the_order(&files)
    };
    let said = |text: &str| found("plant/step.rs", text).join("; ");
    assert_eq!(said("use super::Plant;\n// crate::observer\n"), "");
    assert_eq!(said("use crate::plant::Plant;"), "");
    for text in [
        "use crate::observer::Gain;",
        "fn f() { crate::observer::run() }",
        "use super::super::observer::Gain;",
        "use crate::{observer::Gain, plant::Plant};",
        "use crate::Gain;",
    ] {
        assert!(said(text).contains("plant/step.rs"), "{text}");
    }
    let new = found("fit.rs", "");
    assert_eq!(new, ["`fit` is not in the list of lib.rs"]);
}

/// Every use of a room that stands below, or of a path that says no room. Paths start at `src`.
fn uses_against_the_order(files: &[File]) -> Vec<String> {
    let lib = files.iter().find(|file| file.path == "lib.rs");
    let order = listed(lib.map_or("", |file| &file.text));
    let place = |room: &str| order.iter().position(|known| known == room);
    let mut wrong = BTreeSet::new();
    for file in files.iter().filter(|file| file.path != "lib.rs") {
        let room = file.path.split('/').next().unwrap_or_default();
        let room = room.trim_end_matches(".rs");
        let Some(own) = place(room) else {
            wrong.insert(format!("`{room}` is not in the list of lib.rs"));
            continue;
        };
        let product = file.text.split("#[cfg(test)]\nmod tests").next();
        let code = product.unwrap_or_default().lines();
        for line in code.map(|line| line.split("//").next().unwrap_or_default()) {
            for path in line.split("crate::").skip(1) {
                let word = path.split(|c: char| !(c.is_alphanumeric() || c == '_'));
                let word = word.into_iter().next().unwrap_or_default();
                match place(word) {
                    Some(other) if other > own => {
                        wrong.insert(format!("{}: `{word}` stands below `{room}`", file.path));
                    }
                    Some(_) => {}
                    None => {
                        let text = line.trim();
                        wrong.insert(format!("{}: no folder is named in `{text}`", file.path));
                    }
                }
            }
            let depth = file.path.split('/').count();
            if line.contains(&"super::".repeat(depth)) {
                wrong.insert(format!("{}: `{}` leaves `{room}`", file.path, line.trim()));
            }
        }
    }
    wrong.into_iter().collect()
}

/// The rooms in the order in which the documentation of a crate lists them.
fn listed(lib: &str) -> Vec<String> {
    let lines = lib.lines().skip_while(|line| *line != "//! ```text");
    let block = lines.skip(1).take_while(|line| *line != "//! ```");
    let first = |line: &str| line.split_whitespace().nth(1).map(str::to_owned);
    block.filter_map(first).collect()
}
