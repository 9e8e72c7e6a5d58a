//! Parameters, records and data from the command line.

use crate::command::{BENCH, Folder, errors, hyde, read, status, text};
use serde_json::Value;

#[test]
fn a_plain_parameter_changes_no_code_and_a_structural_one_does() {
    let code = |set: &[&str]| {
        let mut line = vec!["emit", BENCH, "--stage", "clif"];
        line.extend(set);
        let output = hyde(&line);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        text(&output)
    };
    let unknowns = |set: &[&str]| {
        let mut line = vec!["run", BENCH, "--stop", "0.01", "--json"];
        line.extend(set);
        let summary: Value = serde_json::from_str(&text(&hyde(&line))).unwrap();
        summary["unknowns"].as_u64().unwrap()
    };
    let as_it_is = code(&[]);
    assert_eq!(code(&["--set", "saddle.M=400 [kg]"]), as_it_is);
    assert_ne!(code(&["--set", "screw.n=12"]), as_it_is);
    assert_eq!(unknowns(&["--set", "saddle.M=400 [kg]"]), unknowns(&[]));
    // Six cells more, an angle and a speed each.
    assert_eq!(unknowns(&["--set", "screw.n=12"]), unknowns(&[]) + 12);
}

#[test]
fn missing_data_are_told_in_plain_words() {
    let folder = Folder::new();
    let empty = folder.path("");
    let line = [
        "run",
        "examples/emps/emps.hyde",
        "tracking",
        "--data",
        &empty,
    ];
    let output = hyde(&line);
    assert_eq!(status(&output), 1);
    let told = errors(&output);
    for part in ["E0802", "emps_est.csv", "no such file", "--record file="] {
        assert!(told.contains(part), "`{part}` is not in\n{told}");
    }
    // Without its record the model can still be checked.
    let output = hyde(&[
        "check",
        "examples/emps/emps.hyde",
        "tracking",
        "--data",
        &empty,
    ]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert!(errors(&output).contains("E0802"), "{}", errors(&output));
}

#[test]
fn records_missing_in_the_folder_named_are_not_asked_for_by_its_name() {
    let folder = Folder::new();
    let empty = folder.path("");
    let output = hyde(&["fit", BENCH, "bench", "--data", &empty]);
    assert_eq!(status(&output), 1);
    let told = errors(&output);
    for part in ["E0902", "fit-*.csv", "put such files there"] {
        assert!(told.contains(part), "`{part}` is not in\n{told}");
    }
    assert!(!told.contains("name the folder"), "{told}");
}

#[test]
fn records_are_found_by_data_and_by_name() {
    let folder = Folder::new();
    let log = folder.file("logs/emps_est.csv", &read("tests/records/emps.file.csv"));
    let model = "examples/emps/emps.hyde";
    let by_data = hyde(&[
        "run",
        model,
        "tracking",
        "--stop",
        "0.1",
        "--json",
        "--data",
        &folder.path("logs"),
    ]);
    let by_name = format!("file={log}");
    let by_name = hyde(&[
        "run", model, "tracking", "--stop", "0.1", "--json", "--record", &by_name,
    ]);
    for output in [by_data, by_name] {
        assert_eq!(status(&output), 0, "{}", errors(&output));
        let summary: Value = serde_json::from_str(&text(&output)).unwrap();
        let record = &summary["records"]["file"];
        assert_eq!(record["path"], log.as_str());
        assert_eq!(record["rows"], 601);
        assert_eq!(record["sha256"].as_str().unwrap().len(), 64);
    }
}

#[test]
fn a_record_without_a_column_is_told_with_those_it_has() {
    let folder = Folder::new();
    let log = folder.file("log.csv", "t [s],r [m]\n0,0\n1,0\n");
    let record = format!("file={log}");
    let output = hyde(&["run", BENCH, "--record", &record]);
    assert_eq!(status(&output), 1);
    let told = errors(&output);
    assert!(told.contains("E0801"), "{told}");
    assert!(told.contains("i_inj"), "{told}");
}

#[test]
fn sandbox_is_an_option_of_the_commands_that_run_fmus_alone() {
    let has = |line: &[&str]| {
        let all: Vec<&str> = line.iter().chain(&["--help"]).copied().collect();
        text(&hyde(&all)).contains("--sandbox")
    };
    for with in [&["run"][..], &["sweep"], &["test"], &["live"], &["budget"]] {
        assert!(has(with), "{with:?}");
    }
    for without in [
        &[][..],
        &["explain"],
        &["look"],
        &["check"],
        &["fit"],
        &["modes"],
        &["export", "fmu"],
        &["plot"],
        &["report"],
        &["fmt"],
        &["lsp"],
        &["completions"],
        &["export"],
    ] {
        assert!(!has(without), "{without:?}");
    }
    assert_eq!(status(&hyde(&["explain", "E0503", "--sandbox"])), 2);
}
