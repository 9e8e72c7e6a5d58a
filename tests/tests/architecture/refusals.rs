//! Diagnostics are declared as data, in the files of refusals of their crate: an algorithm shows what it does, and by one name
//! what it refuses.

use super::{File, sources};

/// What makes diagnostics, and shows how.
const DIAG: &str = "crates/hyde-diag/";

#[test]
fn no_algorithm_builds_a_diagnostic() {
    let files = sources().into_iter();
    let files: Vec<File> = files.filter(|file| file.path.contains("/src/")).collect();
    for name in ["analysis", "flatten", "study", "syntax"] {
        let own = format!("crates/hyde-{name}/src/refusals");
        let declared = |file: &File| file.path.starts_with(&own) && file.text.contains(BLOCK);
        assert!(
            files.iter().any(declared),
            "no refusals of {name} were found"
        );
    }
    let wrong = outside_of_refusals(&files);
    assert!(
        wrong.is_empty(),
        "declare them below `refusals` with `diagnostics!`:\n{}",
        wrong.join("\n")
    );
}

#[test]
fn a_diagnostic_of_an_algorithm_is_found() {
    let found = |path: &str, text: &str| {
        let (path, text) = (path.to_owned(), text.to_owned());
        outside_of_refusals(&[File { path, text }])
    };
    let declared = "use hyde_diag::{Span, diagnostics};\n\ndiagnostics! {\n    fn no_end() = error EndName { \"no end\"; }\n}\n";
    for path in ["src/refusals.rs", "src/refusals/laws.rs"] {
        let path = format!("crates/hyde-new/{path}");
        assert!(found(&path, declared).is_empty(), "{path}");
        assert_eq!(found(&path, "Diagnostic::error(code, \"no end\")").len(), 1);
    }
    for text in [
        declared,
        "hyde_diag::diagnostics! {\n}\n",
        "let told = Diagnostic::error(Code::EndName, \"no end\");\n",
        "return hyde_diag::Diagnostic::warning(\n",
    ] {
        for path in ["src/laws.rs", "src/laws/refusals.rs"] {
            let path = format!("crates/hyde-new/{path}");
            assert_eq!(found(&path, text).len(), 1, "{path}: {text}");
        }
    }
    assert!(found("crates/hyde-diag/src/declared.rs", declared).is_empty());
}

const BLOCK: &str = "diagnostics! {";
const BUILDERS: [&str; 2] = ["Diagnostic::error", "Diagnostic::warning"];

/// Every line that builds a diagnostic, or declares some in another place.
fn outside_of_refusals(files: &[File]) -> Vec<String> {
    let mut wrong = Vec::new();
    for file in files.iter().filter(|file| !file.path.starts_with(DIAG)) {
        let inside = file.path.split_once("/src/").map(|(_, inside)| inside);
        let declares =
            inside.is_some_and(|path| path.starts_with("refusals/") || path == "refusals.rs");
        for line in file.text.lines() {
            let builds = BUILDERS.iter().any(|call| line.contains(call));
            if builds || line.contains(BLOCK) && !declares {
                wrong.push(format!("{}: {}", file.path, line.trim()));
            }
        }
    }
    wrong
}
