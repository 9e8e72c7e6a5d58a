//! What every stage makes of every example. A snapshot that changes is read before it is accepted.

use crate::examples;
use hyde_compiler::Stage;
use hyde_tests::root;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Longer than this nobody reads a snapshot: of longer code the instructions of each kernel are counted, of
/// other texts the lines below each heading.
const LONGEST: usize = 2000;

#[test]
fn every_stage_of_every_example() {
    let (mut written, mut known) = (BTreeSet::new(), BTreeSet::new());
    for case in examples::all() {
        // The tree is that of the file, whatever the experiment.
        let ast = format!("{}.ast", case.folder);
        if !written.contains(&ast) {
            check(&ast, text(&case, Stage::Ast));
            written.insert(ast);
        }
        for (stage, extension) in [
            (Stage::Flat, "flat"),
            (Stage::Structure, "structure"),
            (Stage::Dae, "dae"),
            // Cranelift's IR as it is before a machine is chosen: the same on every one.
            (Stage::Clif, "clif"),
        ] {
            // Experiments that differ in their records or parameters alone are the same after some stage.
            let text = text(&case, stage);
            if known.insert((case.folder.clone(), text.clone())) {
                let name = format!("{}.{extension}", case.name);
                check(&name, text);
                written.insert(name);
            }
        }
    }
    let stages = ["ast", "flat", "structure", "dae", "clif"];
    for file in std::fs::read_dir(root().join("tests/snapshots")).unwrap() {
        let file = file.unwrap().file_name().to_string_lossy().into_owned();
        let Some(name) = file.strip_suffix(".snap") else {
            continue;
        };
        let of_a_stage = name
            .rsplit('.')
            .next()
            .is_some_and(|end| stages.contains(&end));
        assert!(
            !of_a_stage || written.contains(name),
            "`{file}` belongs to no example any more"
        );
    }
}

/// What a stage makes of an example, as long as somebody reads it.
fn text(case: &examples::Case, stage: Stage) -> String {
    let text = case.example.emit(stage);
    let text = text.unwrap_or_else(|error| panic!("{}: {error}", case.name));
    if text.lines().count() <= LONGEST {
        return text;
    }
    match stage {
        Stage::Clif => instructions(&text),
        Stage::Ast | Stage::Flat | Stage::Structure | Stage::Dae | Stage::Asm => sections(&text),
    }
}

fn check(name: &str, text: String) {
    insta::with_settings!({
        snapshot_path => "../../snapshots",
        prepend_module_to_snapshot => false,
        omit_expression => true,
    }, {
        insta::assert_snapshot!(name, text);
    });
}

/// How many lines stand below each line that is not indented.
fn sections(text: &str) -> String {
    let mut out = String::new();
    let mut lines = text.lines().peekable();
    while let Some(heading) = lines.next() {
        let mut below = 0;
        while lines.next_if(|line| line.starts_with(' ')).is_some() {
            below += 1;
        }
        let _ = writeln!(out, "{below:>6} {heading}");
    }
    out
}

/// How often each instruction stands in each kernel.
fn instructions(clif: &str) -> String {
    let mut out = String::new();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for line in clif.lines().chain(["}"]) {
        if line == "}" {
            for (instruction, count) in std::mem::take(&mut counts) {
                let _ = writeln!(out, "{count:>6} {instruction}");
            }
        } else if let Some(code) = line.strip_prefix("    ") {
            let code = code.split("  ;").next().unwrap();
            let (result, code) = code.split_once(" = ").unwrap_or(("", code));
            if !result.starts_with("sig") && !result.starts_with("fn") {
                *counts.entry(code.split(' ').next().unwrap()).or_default() += 1;
            }
        } else if line.starts_with("; ") {
            let _ = writeln!(out, "{line}");
        }
    }
    out
}
