//! Files are left whole or not at all.

use crate::command::{Folder, LAG, errors, hyde, read, rows, status};
use serde_json::Value;

#[test]
fn a_run_leaves_four_files_and_nothing_half_written() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let out = folder.path("deep/er/out");
    assert_eq!(status(&hyde(&["run", &model, "--out", &out])), 0);
    assert_eq!(
        folder.names("deep/er/out"),
        ["events.csv", "report.html", "results.csv", "summary.json"]
    );
    let results = read(&format!("{out}/results.csv"));
    assert_eq!(results.lines().next().unwrap(), "t [s],u [1],x [1]");
    let rows = rows(&results);
    assert_eq!(rows.len(), 51);
    let last = &rows[50];
    assert_eq!(last[0], 0.05);
    // rtol 1e-6.
    assert!(
        (last[2] - (1.0 - (-5.0_f64).exp())).abs() < 1e-5,
        "{last:?}"
    );
    let report = read(&format!("{out}/report.html"));
    assert!(report.contains("<svg") && report.trim_end().ends_with("</html>"));
    // It works with no network.
    assert!(!report.contains("src=\"http") && !report.contains("<link"));
    let summary: Value = serde_json::from_str(&read(&format!("{out}/summary.json"))).unwrap();
    assert_eq!(summary["ok"], true);

    let json = folder.path("json");
    let line = ["run", &model, "--out", &json, "--format", "json"];
    assert_eq!(status(&hyde(&line)), 0);
    let results: Value = serde_json::from_str(&read(&format!("{json}/results.json"))).unwrap();
    assert_eq!(results["x"]["values"].as_array().unwrap().len(), 51);
}

#[test]
fn a_file_that_cannot_be_written_leaves_the_old_one_and_no_other() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    // A file stands where the folder should be.
    let in_the_way = folder.file("taken", "old");
    let output = hyde(&["run", &model, "--out", &in_the_way]);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("cannot make the folder"));
    assert_eq!(read(&in_the_way), "old");
    // A folder stands where a file should be.
    std::fs::create_dir_all(folder.path("out/results.csv")).unwrap();
    let output = hyde(&["run", &model, "--out", &folder.path("out")]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("cannot write"),
        "{}",
        errors(&output)
    );
    assert_eq!(folder.names("out"), ["results.csv"]);
}

#[test]
fn events_name_cause_modes_and_line() {
    let folder = Folder::new();
    let out = folder.path("out");
    let line = ["run", "tests/models/stick_slip.hyde", "--out", &out];
    assert_eq!(status(&hyde(&line)), 0);
    let events = read(&format!("{out}/events.csv"));
    let mut events = events.lines();
    assert_eq!(events.next(), Some("t [s],what,before,after,cause,source"));
    let first = events.next().unwrap();
    let expected = "floor,stuck,slip,\"floor.a.f - floor.drag > floor.Fs\",Translational.hyde:";
    assert!(first.contains(expected), "{first}");
}
