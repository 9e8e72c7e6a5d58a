//! What each pass of the compiler makes of a small model: `passes/NAME.hyde`, with the result beside it in `NAME.snap`.
//!
//! The passes of hyde-flatten are shown by the flat model, those of hyde-analysis by the DAE, those that refuse a model by
//! what they say. A result that changes is read before it is accepted.

#![allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test reads models and sources, and may panic"
)]

use hyde_compiler::Stage;
use hyde_tests::{Example, root};
use std::collections::BTreeSet;
use std::fs;

/// More than this nobody reads.
const MOST_LINES: usize = 90;

/// The names in back quotes in the numbered list at the head of a crate.
fn passes(head: &str) -> Vec<String> {
    let text = fs::read_to_string(root().join(head)).unwrap();
    let lines = text.lines().take_while(|line| line.starts_with("//!"));
    let listed = lines.skip_while(|line| !line.contains("In order:"));
    let mut found = Vec::new();
    let mut in_list = false;
    for line in listed {
        let text = line.trim_start_matches("//!").trim_start();
        let numbered = text
            .split_once(". ")
            .is_some_and(|(number, _)| number.parse::<u8>().is_ok());
        in_list = numbered || (in_list && !text.is_empty());
        if in_list {
            let quoted = text.split('`').skip(1).step_by(2);
            found.extend(quoted.map(str::to_owned));
        }
    }
    found
}

#[test]
fn every_pass_has_a_model_with_its_result() {
    let flatten = passes("crates/hyde-flatten/src/lib.rs");
    let analysis = passes("crates/hyde-analysis/src/lib.rs");
    assert!(
        flatten.len() >= 8 && analysis.len() >= 14,
        "{flatten:?} {analysis:?}"
    );
    let folder = root().join("tests/passes");
    let mut models = BTreeSet::new();
    for entry in fs::read_dir(&folder).unwrap() {
        let name = entry.unwrap().file_name().to_string_lossy().into_owned();
        if let Some(pass) = name.strip_suffix(".hyde") {
            models.insert(pass.to_owned());
        }
    }
    let missing: Vec<_> = flatten
        .iter()
        .chain(&analysis)
        .filter(|pass| *pass != "when" && *pass != "assert" && !models.contains(*pass))
        .collect();
    assert!(
        missing.is_empty(),
        "without a model in tests/passes: {missing:?}"
    );

    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(&folder);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let _bound = settings.bind_to_scope();
    for pass in &models {
        let place = format!("tests/passes/{pass}.hyde");
        let lines = fs::read_to_string(root().join(&place))
            .unwrap()
            .lines()
            .count();
        assert!((5..=40).contains(&lines), "{place} has {lines} lines");
        let stage = match flatten.contains(pass) || pass == "moving_place" {
            true => Stage::Flat,
            false => Stage::Dae,
        };
        let example = Example::load(&place, None).unwrap();
        let result = example.emit(stage).unwrap_or_else(|refused| refused);
        let lines = result.lines().count();
        assert!(lines <= MOST_LINES, "{pass}: {lines} lines");
        insta::assert_snapshot!(pass.as_str(), result);
    }
}
