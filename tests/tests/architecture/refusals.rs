//! Diagnostics are declared as data, in the files of refusals of their crate: an algorithm shows what it does, and by one name
//! what it refuses.

use super::sources;

/// The crates that declare all of their diagnostics.
const DECLARING: &[&str] = &["analysis", "experiment", "flatten", "study"];

#[test]
fn no_algorithm_builds_a_diagnostic() {
    let sources = sources();
    let mut wrong = Vec::new();
    for name in DECLARING {
        let top = format!("crates/hyde-{name}/src/");
        let mut declared = 0;
        for file in &sources {
            let Some(inside) = file.path.strip_prefix(&top) else {
                continue;
            };
            let declares = inside.starts_with("refusals/") || inside == "refusals.rs";
            for line in file.text.lines() {
                let builds = ["Diagnostic::error", "Diagnostic::warning"];
                let builds = builds.iter().any(|call| line.contains(call));
                let has_block = line.contains("diagnostics! {");
                declared += usize::from(has_block);
                if builds || has_block && !declares {
                    wrong.push(format!("{}: {}", file.path, line.trim()));
                }
            }
        }
        assert!(declared > 0, "no refusals of {name} were found");
    }
    assert!(
        wrong.is_empty(),
        "declare them below `refusals` with `diagnostics!`:\n{}",
        wrong.join("\n")
    );
}
