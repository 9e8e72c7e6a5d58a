//! The house rules that a program can check: edges between crates and [folders](folders), [circles](circles) of files, what files
//! open, are called and hold, [methods](methods) of types, [diagnostics](refusals), [one table](thresholds) of a diagnosis' numbers.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

mod circles;
mod folders;
mod methods;
mod refusals;
mod thresholds;

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The crates of the product with what each may depend on; an edge not listed needs a reason and a line here.
const EDGES: &[(&str, &[&str])] = &[
    ("diag", &[]),
    ("units", &[]),
    ("ida", &[]),
    ("library", &[]),
    ("syntax", &["diag"]),
    ("format", &["diag", "syntax"]),
    ("ir", &["diag", "units"]),
    ("signal", &["units"]),
    ("program", &["diag", "ir", "units"]),
    ("flatten", &["diag", "ir", "syntax", "units"]),
    ("analysis", &["diag", "ir", "units"]),
    // On analysis, for the derivatives by a chosen set of parameters, which are made when they are asked for (S2).
    ("jit", &["analysis", "diag", "ir", "program", "units"]),
    (
        "compiler",
        &[
            "analysis", "diag", "flatten", "ir", "jit", "library", "program", "syntax", "units",
        ],
    ),
    ("sim", &["diag", "ida", "program", "signal", "units"]),
    (
        "experiment",
        &[
            "compiler", "diag", "ir", "program", "signal", "sim", "syntax", "units",
        ],
    ),
    (
        "calibrate",
        &[
            "diag",
            "experiment",
            "ir",
            "library",
            "program",
            "signal",
            "sim",
            "syntax",
            "units",
        ],
    ),
    ("fmu-import", &["program", "syntax", "units"]),
    (
        "study",
        &[
            "calibrate",
            "compiler",
            "diag",
            "experiment",
            "fmu-import",
            "ida",
            "library",
            "program",
            "signal",
            "sim",
            "syntax",
            "units",
        ],
    ),
    (
        "fmi",
        &[
            "compiler",
            "diag",
            "experiment",
            "program",
            "signal",
            "sim",
            "study",
            "units",
        ],
    ),
    ("fmu", &["fmi", "study"]),
    ("modelica", &["compiler", "diag", "ir", "study"]),
    ("mcp", &["diag", "library", "syntax"]),
    ("c", &["diag", "program", "study", "units"]),
    (
        "editor",
        &["compiler", "diag", "format", "study", "syntax", "units"],
    ),
    (
        "report",
        &["calibrate", "diag", "experiment", "signal", "units"],
    ),
    (
        "present",
        &[
            "calibrate",
            "compiler",
            "diag",
            "experiment",
            "ida",
            "library",
            "program",
            "report",
            "signal",
            "sim",
            "study",
            "syntax",
            "units",
        ],
    ),
];

/// What stands on top: they may depend on every crate, and no crate of the product on them.
const TOP: &[&str] = &["cli", "python", "tests"];

/// The parser for editors, named as those of other languages are; no crate depends on it.
const GRAMMAR: &str = "tree-sitter-hyde";

/// What tests of a crate may use beyond its edges.
const TEST_EDGES: &[(&str, &[&str])] = &[
    // Flattens the packages of the library.
    ("flatten", &["library"]),
];

/// The length beyond which a file does more than one thing.
const LONGEST: usize = 500;

/// Files that are longer for now, with their length. A bound only ever shrinks; a new file has no place here.
const LONGER_FOR_NOW: &[(&str, usize)] = &[];

#[test]
fn crates_depend_downwards_only() {
    let mut wrong = Vec::new();
    for package in packages() {
        let name = text(&package["name"]);
        if name == GRAMMAR {
            continue;
        }
        let Some(short) = name.strip_prefix("hyde-") else {
            wrong.push(format!("`{name}` is not called hyde-…"));
            continue;
        };
        if TOP.contains(&short) {
            continue;
        }
        let Some(allowed) = listed(EDGES, short) else {
            wrong.push(format!("`{name}` is not in the table of crates"));
            continue;
        };
        let in_tests = listed(TEST_EDGES, short).unwrap_or_default();
        for dependency in array(&package["dependencies"]) {
            let Some(other) = text(&dependency["name"]).strip_prefix("hyde-") else {
                continue;
            };
            let of_tests = dependency["kind"] == "dev";
            let known = allowed.contains(&other) || (of_tests && in_tests.contains(&other));
            if !known {
                let kind = if of_tests { " in its tests" } else { "" };
                wrong.push(format!("`{name}` depends on `hyde-{other}`{kind}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn foreign_solver_and_code_generator_stay_behind_their_crate() {
    let fences = [
        ("sundials-sys", "hyde-ida"),
        ("suitesparse_sys", "hyde-ida"),
        ("cranelift-jit", "hyde-jit"),
        ("cranelift-codegen", "hyde-jit"),
        ("pest", "hyde-syntax"),
        ("annotate-snippets", "hyde-study"),
        ("pyo3", "hyde-python"),
        ("numpy", "hyde-python"),
        ("clap", "hyde-cli"),
        ("pretty", "hyde-format"),
        ("tree-sitter", GRAMMAR),
    ];
    for package in packages() {
        let name = text(&package["name"]);
        for dependency in array(&package["dependencies"]) {
            let other = text(&dependency["name"]);
            assert_ne!(other, GRAMMAR, "`{name}` depends on the parser for editors");
            for (fenced, home) in fences {
                assert!(
                    other != fenced || name == home,
                    "`{name}` depends on `{other}`"
                );
            }
            let of_fmi = ["fmi-sys", "libloading"].contains(&other);
            let homes = ["hyde-fmu", "hyde-fmu-import"];
            assert!(
                !of_fmi || homes.contains(&name),
                "`{name}` depends on `{other}`"
            );
        }
    }
}

#[test]
fn every_crate_says_what_it_is_and_takes_the_lints() {
    for package in packages() {
        let name = text(&package["name"]);
        let description = package["description"].as_str().unwrap_or_default();
        assert!(!description.is_empty(), "`{name}` has no description");
        assert!(!description.contains('\n'), "`{name}`: more than one line");
        let manifest = read(Path::new(text(&package["manifest_path"])));
        assert!(
            manifest.contains("[lints]\nworkspace = true"),
            "`{name}` has lints of its own"
        );
    }
}

#[test]
fn every_file_says_what_it_does_in_its_first_line() {
    let silent: Vec<String> = sources()
        .into_iter()
        .filter(|file| !file.text.starts_with("//! "))
        .map(|file| file.path)
        .collect();
    assert!(silent.is_empty(), "no `//!`: {}", silent.join(", "));
}

/// What a component is to a study follows from its declarations. First models are written with parts of the library.
#[test]
fn no_study_knows_a_component_by_its_name() {
    let mut names = BTreeSet::new();
    for package in hyde_tests::library::names() {
        names.insert(package.to_owned());
        let text = hyde_library::package(package).unwrap().text;
        for line in text.lines() {
            let mut words = line.split_whitespace();
            if let (Some("model" | "connector" | "effect"), Some(name)) =
                (words.next(), words.next())
            {
                names.extend([name.to_owned(), format!("{package}.{name}")]);
            }
        }
    }
    assert!(names.len() > 300, "the library was not found");
    let studies = ["crates/hyde-calibrate/src/", "crates/hyde-study/src/"];
    let is_study = |path: &str| studies.iter().any(|crate_| path.starts_with(crate_));
    for file in sources() {
        if !is_study(&file.path) || file.path.contains("/first_model/") {
            continue;
        }
        let product = file.text.split("#[cfg(test)]").next().unwrap_or_default();
        let code = product
            .lines()
            .filter(|line| !line.trim_start().starts_with("//"));
        for literal in code.flat_map(|line| line.split('"').skip(1).step_by(2)) {
            let words = literal.split(|c: char| !(c.is_alphanumeric() || c == '.' || c == '_'));
            let words = words.filter(|word| word.contains('.'));
            let known = words.chain([literal]).find(|word| names.contains(*word));
            assert_eq!(known, None, "{}: {literal}", file.path);
        }
    }
}

#[test]
fn files_are_named_after_what_they_do() {
    let banned = [
        "base", "common", "core", "helper", "helpers", "misc", "shared", "stuff", "types", "util",
        "utils",
    ];
    let wrong: Vec<String> = sources()
        .into_iter()
        .map(|file| file.path)
        .filter(|path| {
            let stem = Path::new(path).file_stem().and_then(|stem| stem.to_str());
            let stem = stem.unwrap_or_default();
            banned.contains(&stem)
                || stem.contains("_and_")
                || ["_a", "_b", "2"].iter().any(|end| stem.ends_with(end))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join(", "));
}

#[test]
fn files_are_short() {
    let bounds: BTreeMap<&str, usize> = LONGER_FOR_NOW.iter().copied().collect();
    let mut found = BTreeSet::new();
    for file in sources() {
        let lines = file.text.lines().count();
        match bounds.get(file.path.as_str()) {
            None => assert!(lines <= LONGEST, "{} has {lines} lines", file.path),
            Some(&bound) => {
                found.insert(file.path.clone());
                assert!(lines <= bound, "{} grew to {lines} lines", file.path);
                assert!(
                    lines > LONGEST,
                    "{} is short now: take it off the list",
                    file.path
                );
            }
        }
    }
    assert_eq!(
        found.len(),
        bounds.len(),
        "a file of the list is gone: {found:?}"
    );
}

#[test]
fn there_are_two_types_of_expressions() {
    let found: BTreeSet<String> = sources()
        .iter()
        .flat_map(|file| file.text.lines())
        .filter_map(|line| {
            let line = line.trim_start();
            let line = line.strip_prefix("pub(crate) ").unwrap_or(line);
            let line = line.strip_prefix("pub ").unwrap_or(line);
            let name = line
                .strip_prefix("enum ")
                .or_else(|| line.strip_prefix("struct "))?;
            let name = name
                .split(|c: char| !(c.is_alphanumeric() || c == '_'))
                .next()?;
            (name.contains("Expr") || name.ends_with("Expression") || name == "Term")
                .then(|| name.to_owned())
        })
        .collect();
    // `ast::Expr` with its kind; the IR's `Expr`, which lie in an arena.
    assert_eq!(
        found.into_iter().collect::<Vec<_>>(),
        ["Expr", "ExprArena", "ExprKind"]
    );
}

#[test]
fn nothing_is_put_off() {
    // In two parts, for this file is searched too.
    let banned = [
        concat!("to", "do!("),
        concat!("unimpl", "emented!("),
        concat!("#[ig", "nore"),
        concat!("TO", "DO"),
        concat!("FIX", "ME"),
        concat!("Throw", "away"),
        concat!("clippy:", ":all"),
    ];
    let mut wrong = Vec::new();
    for file in sources() {
        for word in banned {
            if file.text.contains(word) {
                wrong.push(format!("{}: `{word}`", file.path));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn unsafe_code_is_in_five_crates_and_says_why() {
    let word = concat!("uns", "afe ");
    let mut wrong = Vec::new();
    for file in sources() {
        let homes = ["ida", "jit", "fmu", "fmu-import"];
        let mut homes = homes.map(|home| format!("crates/hyde-{home}/")).to_vec();
        // The generated parser is C.
        homes.push("editors/tree-sitter-hyde/bindings/".to_owned());
        let allowed = homes
            .iter()
            .any(|home| file.path.starts_with(home.as_str()));
        for (number, line) in (1..).zip(file.text.lines()) {
            let code = line.split("//").next().unwrap_or_default();
            let uses = ["{", "fn", "impl", "extern"]
                .iter()
                .any(|next| code.contains(&format!("{word}{next}")));
            if uses && !allowed {
                wrong.push(format!("{}:{number}", file.path));
            }
        }
        if file.text.contains(word) && allowed && file.text.contains(&format!("{word}{{")) {
            assert!(file.text.contains("// SAFETY:"), "{}: no reason", file.path);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_command_line_alone_touches_the_machine_but_for_the_files_a_study_reads() {
    let doors = [
        "std::fs",
        "std::env::",
        "std::net",
        "std::process::Command",
        "std::thread::sleep",
        "SystemTime",
        "println!(",
        "std::io::stdout",
        "std::io::stderr",
    ];
    let mut wrong = Vec::new();
    for file in sources() {
        let product = file.path.starts_with("crates/") && file.path.contains("/src/");
        let doors_open = [
            "crates/hyde-cli/",
            "crates/hyde-study/src/world.rs",
            // A library can only be loaded from a file.
            "crates/hyde-fmu-import/src/unpacked.rs",
        ];
        if !product || doors_open.iter().any(|own| file.path.starts_with(own)) {
            continue;
        }
        let code = file.text.split("#[cfg(test)]\nmod tests").next();
        let is_test = file.path.ends_with("/tests.rs");
        for line in code.unwrap_or_default().lines().filter(|_| !is_test) {
            let code = line.split("//").next().unwrap_or_default();
            for door in doors.iter().filter(|door| code.contains(**door)) {
                wrong.push(format!("{}: `{door}`", file.path));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A Rust file of the workspace, by its path from the top.
struct File {
    path: String,
    text: String,
}

fn sources() -> Vec<File> {
    let top = top();
    let mut found = Vec::new();
    for folder in ["crates", "editors/tree-sitter-hyde", "tests"] {
        collect(&top.join(folder), &mut |path| {
            let inside = path.strip_prefix(&top).unwrap();
            found.push(File {
                path: inside.to_string_lossy().replace('\\', "/"),
                text: read(path),
            });
        });
    }
    assert!(found.len() > 100, "the sources were not found");
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

fn collect(folder: &Path, take: &mut impl FnMut(&Path)) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, take);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            take(&path);
        }
    }
}

fn packages() -> Vec<Value> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version=1", "--no-deps", "--offline"])
        .current_dir(top())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    array(&metadata["packages"]).to_vec()
}

fn listed<'t>(table: &[(&str, &'t [&'t str])], name: &str) -> Option<&'t [&'t str]> {
    let mut rows = table.iter();
    rows.find(|(known, _)| *known == name).map(|(_, row)| *row)
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

fn array(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

#[allow(clippy::disallowed_methods, reason = "tests read the sources")]
fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

fn top() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .unwrap()
        .to_path_buf()
}
