//! What is printed, and where.

use crate::command::{BENCH, Folder, LAG, command, errors, hyde, status, text};
use serde_json::Value;
use std::process::Stdio;

#[test]
fn json_is_one_object_and_nothing_else() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let wrong = folder.file("wrong.hyde", &LAG.replace("u - x", "u - y"));
    for (line, expected) in [
        (&["check", &model, "--json"][..], 0),
        (&["run", &model, "--json"], 0),
        (&["emit", &model, "--stage", "dae", "--json"], 0),
        (&["modes", BENCH, "--json"], 0),
        (&["check", &wrong, "--json"], 1),
        (&["run", &wrong, "--json"], 1),
        (&["run", &model, "--set", "tau=5", "--json"], 2),
    ] {
        let output = hyde(line);
        assert_eq!(status(&output), expected, "{line:?}: {}", errors(&output));
        assert_eq!(errors(&output), "", "{line:?}");
        let value: Value = serde_json::from_str(&text(&output)).unwrap();
        assert_eq!(value["ok"], expected == 0, "{line:?}");
    }
    let output = hyde(&["check", &wrong, "--json"]);
    let value: Value = serde_json::from_str(&text(&output)).unwrap();
    let diagnostic = &value["diagnostics"][0];
    assert_eq!(diagnostic["code"], "E0201");
    assert_eq!(diagnostic["severity"], "error");
    assert!(diagnostic["message"].as_str().unwrap().contains("`y`"));
}

#[test]
fn the_summary_says_what_was_run_and_how() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let output = hyde(&[
        "run",
        &model,
        "--json",
        "--set",
        "T=20 [ms]",
        "--rtol",
        "1e-9",
    ]);
    let summary: Value = serde_json::from_str(&text(&output)).unwrap();
    assert_eq!(summary["model"], "Lag");
    assert_eq!(summary["experiment"], "step");
    assert_eq!(summary["stop_s"], 0.05);
    assert_eq!(summary["rtol"], 1e-9);
    assert_eq!(summary["unknowns"], 1);
    assert_eq!(summary["parameters"]["T"]["value"], 0.02);
    assert_eq!(summary["parameters"]["T"]["unit"], "s");
    assert!(summary["statistics"]["steps"].as_u64().unwrap() > 10);
    assert!(summary["sundials"].as_str().unwrap().contains('.'));
    assert_eq!(summary["source_sha256"].as_str().unwrap().len(), 64);
    let highest = summary["measures"][0]["value"].as_f64().unwrap();
    // One exponential of 20 ms over 50 ms; rtol 1e-9.
    assert!(
        (highest - (1.0 - (-2.5_f64).exp())).abs() < 1e-6,
        "{highest}"
    );
}

#[test]
fn no_line_is_longer_than_80_columns() {
    let codes = text(&hyde(&["explain"]));
    let mut lines = vec![
        vec!["check", BENCH],
        vec!["run", BENCH, "--stop", "0.05", "--out", "target/cli-width"],
        vec!["modes", BENCH],
        vec!["explain"],
    ];
    let names: Vec<&str> = codes.lines().map(|line| &line[..5]).collect();
    assert!(names.len() > 40);
    lines.extend(names.iter().map(|name| vec!["explain", name]));
    for line in lines {
        let output = hyde(&line);
        assert_eq!(status(&output), 0, "{line:?}");
        for printed in text(&output).lines() {
            let columns = printed.chars().count();
            assert!(columns <= 80, "{line:?}: {columns} columns: {printed}");
        }
    }
}

#[test]
fn quiet_says_nothing_of_a_good_run() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let output = hyde(&["run", &model, "--quiet"]);
    assert_eq!(
        (status(&output), text(&output), errors(&output)),
        (0, String::new(), String::new())
    );
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let mut child = command(&["explain"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(!errors(&output).contains("panicked"), "{}", errors(&output));
    assert_ne!(output.status.code(), Some(101));
}
