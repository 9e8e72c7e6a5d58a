//! First models: each template runs as it is written, and traces of another simulator become calibrated models.
//!
//! `examples/new_axis/simulate.py` writes the traces. It needs Python; without it the tests that use it say so and end.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn hyde(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hyde-tested"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn right(folder: &Path, arguments: &[&str]) -> String {
    let output = hyde(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{arguments:?}\n{printed}{said}");
    printed
}

#[test]
fn each_template_runs_at_once_and_arrives() {
    let scratch = tempfile::tempdir().unwrap();
    for template in ["screw", "belt", "rack", "linear", "table", "bench"] {
        let printed = right(scratch.path(), &["new", template, "--template", template]);
        assert!(printed.contains("end with `// confirm`"), "{printed}");
        let file = format!("{template}.hyde");
        let text = std::fs::read_to_string(scratch.path().join(&file)).unwrap();
        assert!(!text.contains('@'), "{text}");
        right(scratch.path(), &["check", &file]);
        right(scratch.path(), &["fmt", "--check", &file]);
        right(scratch.path(), &["run", &file, "move", "--out", template]);
        let rows =
            std::fs::read_to_string(scratch.path().join(template).join("results.csv")).unwrap();
        let mut lines = rows.lines();
        let head = lines.next().unwrap();
        let place = head
            .split(',')
            .position(|name| name.starts_with("axis.position"))
            .unwrap();
        let last: f64 = lines
            .next_back()
            .unwrap()
            .split(',')
            .nth(place)
            .unwrap()
            .parse()
            .unwrap();
        // 0.2 m in the unit of the column; the load ends near its reference.
        let wanted = match (template, head.split(',').nth(place).unwrap()) {
            ("table", _) => 0.2,
            ("bench", _) => 4.0,
            (_, _) => 0.2,
        };
        assert!((last - wanted).abs() < 0.02 * wanted, "{template}: {last}");
    }
}

/// Template, constant, and the true values of what is calibrated.
type Kind = (&'static str, &'static str, &'static [(&'static str, f64)]);

const KINDS: [Kind; 3] = [
    (
        "belt",
        "0.62 [N.m/A]",
        &[
            ("rotor.J", 1.1e-3),
            ("belt.c", 9.0e5),
            ("carriage.M", 34.0),
            ("guide.F", 62.0),
            ("guide.b", 210.0),
        ],
    ),
    (
        "linear",
        "88 [N/A]",
        &[("slide.M", 21.0), ("guide.F", 18.0), ("guide.b", 60.0)],
    ),
    (
        "bench",
        "0.11 [N.m/A]",
        &[
            ("rotor.J", 2.2e-4),
            ("shaft.c", 31.0),
            ("load.J", 5.6e-4),
            ("bearing.T", 0.045),
        ],
    ),
];

#[test]
fn traces_of_another_simulator_become_calibrated_models() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    for (template, constant, truth) in KINDS {
        for (seed, file) in [("11", "fit.csv"), ("12", "check.csv")] {
            let script = root().join("examples/new_axis/simulate.py");
            let python = Command::new("python3")
                .arg(script)
                .args([template, seed, file])
                .current_dir(folder)
                .status();
            if python.is_err() {
                println!("python3 is not there: the traces are not made");
                return;
            }
            assert!(python.unwrap().success());
        }
        right(
            folder,
            &[
                "new",
                template,
                "--template",
                template,
                "--constant",
                constant,
                "--from",
                "fit.csv",
                "check.csv",
            ],
        );
        let file = format!("{template}.hyde");
        right(folder, &["run", &file, "trial"]);
        let printed = right(folder, &["fit", &file, "trial", "--json"]);
        let report: Value = serde_json::from_str(&printed).unwrap();
        for (name, wanted) in truth {
            let all = report["parameters"].as_array().unwrap();
            let own = all.iter().find(|own| own["name"] == *name).unwrap();
            let found = own["value"].as_f64().unwrap();
            assert!(
                (found - wanted).abs() < 0.02 * wanted,
                "{template}: {name} is {found} instead of {wanted}"
            );
        }
    }
}

#[test]
fn what_a_trace_does_not_say_is_asked_for_and_the_answer_works() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let rows = (0..1000).map(|k| {
        let t = f64::from(k) * 1e-3;
        format!(
            "{t:.3},{:.5},{:.4}\n",
            80.0 * (9.0 * t).sin(),
            3.0 * (9.0 * t).cos()
        )
    });
    let text = format!("t [s],pos,i [A]\n{}", rows.collect::<String>());
    std::fs::write(folder.join("log.csv"), text).unwrap();
    let new = |from: &str, name: &str| {
        hyde(
            folder,
            &["new", name, "--template", "linear", "--from", from],
        )
    };
    let output = new("log.csv", "axis");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success());
    let advice = "log.csv (column = \"pos\" in [mm])";
    assert!(said.contains(advice), "{said}");
    let output = new(advice, "axis");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    right(folder, &["check", "axis.hyde"]);
    // Nothing is written over, and a name is a name.
    let output = new(advice, "axis");
    assert!(String::from_utf8_lossy(&output.stderr).contains("is there already"));
    let output = new(advice, "2axis");
    assert!(String::from_utf8_lossy(&output.stderr).contains("cannot be the name"));
}

#[test]
fn the_page_is_followed_literally() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path();
    let own = folder.join("examples/new_axis");
    std::fs::create_dir_all(&own).unwrap();
    for file in ["strokes.csv", "check.csv"] {
        std::fs::copy(root().join("examples/new_axis").join(file), own.join(file)).unwrap();
    }
    let page = std::fs::read_to_string(root().join("book/src/first-axis.md")).unwrap();
    let block = page
        .split("```sh\n")
        .nth(1)
        .unwrap()
        .split("```")
        .next()
        .unwrap();
    let mut printed = String::new();
    for line in block.lines() {
        let quoted = line.strip_prefix("hyde ").unwrap();
        let parts = quoted.split('\'').enumerate();
        let words: Vec<&str> = parts
            .flat_map(|(at, part)| match at % 2 {
                0 => part.split_whitespace().collect(),
                _ => vec![part],
            })
            .collect();
        printed = right(folder, &words);
    }
    assert!(printed.contains("no missing effect detected"), "{printed}");
}
