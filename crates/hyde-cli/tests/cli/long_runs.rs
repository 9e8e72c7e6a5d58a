//! Runs that take long, and those that do not reach their stop.
#![cfg(unix)]

use crate::command::{Folder, command, errors, hyde, read, rows, status, text};
use serde_json::Value;
use std::process::{Command, Stdio};
use std::time::Duration;

/// An oscillator for a day, with a response to stepped sines that takes as long.
const DAY: &str = r#"package day "an oscillator for a day";
import SI.*;

model Oscillator
  input Real u;
  Real x(start = 1, fixed = true), v(start = 0, fixed = true);
equation
  der(x) = 100 [1/s]*v;
  der(v) = -100 [1/s]*(x + v + u);
end Oscillator;

experiment day of Oscillator
  stimulus u = sin(80 [rad/s]*time);
  measure Real most = max(x);
  stop 86400 [s] every 1 [s];
end day;

experiment stepped of Oscillator
  stimulus u = 1;
  bode from u to x over 1 [Hz] .. 30 [Hz] by stepped(amplitude = 2, points = 4, settle = 90000 [s], periods = 4);
  stop 1 [s];
end stepped;

sweep many of day
  vary x.start in 0 .. 1; latin 200; keep x;
end many;
"#;

/// Ends at 0.75 s.
const FALLS: &str = r#"package falls "a level that an assert does not allow";
import SI.*;

model Level
  Real x(start = 1, fixed = true);
equation
  der(x) = -1 [1/s];
  assert(x > 0.25, "the level is too low");
end Level;

experiment falls of Level
  measure Real most = max(x);
  expect max(x) < 2 "never high";
  stop 2 [s] every 0.1 [s];
end falls;
"#;

fn interrupted(line: &[&str]) -> (Option<i32>, String) {
    let child = command(line)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let kill = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(kill.unwrap().success());
    let output = child.wait_with_output().unwrap();
    (output.status.code(), errors(&output))
}

fn summary(out: &str) -> Value {
    serde_json::from_str(&read(&format!("{out}/summary.json"))).unwrap()
}

#[test]
fn an_interrupted_run_keeps_its_rows_marked_as_incomplete() {
    let folder = Folder::new();
    let model = folder.file("day.hyde", DAY);
    let out = folder.path("out");
    let (code, told) = interrupted(&["run", &model, "day", "--out", &out]);
    assert_eq!(code, Some(130), "{told}");
    assert!(told.contains("the run was interrupted at"), "{told}");
    assert!(told.contains("marked as incomplete"), "{told}");
    let found = summary(&out);
    assert_eq!(found["ok"], false);
    assert_eq!(found["measures"], serde_json::json!([]));
    let reached = found["incomplete"]["reached_s"].as_f64().unwrap();
    assert!((1.0..86400.0).contains(&reached), "{reached}");
    let rows = rows(&read(&format!("{out}/results.csv")));
    let last = rows.last().unwrap();
    assert!(reached - 1.0 < last[0] && last[0] <= reached, "{last:?}");
    let page = read(&format!("{out}/report.html"));
    assert!(page.contains("day of Oscillator, incomplete"));
    assert!(page.contains("did not reach its end at 86400 s"));
    // A run that is complete says nothing of that.
    let whole = hyde(&["run", &model, "day", "--out", &out, "--stop", "0.1"]);
    assert_eq!(status(&whole), 0);
    assert!(summary(&out).get("incomplete").is_none());
}

#[test]
fn a_run_that_fails_keeps_its_rows_marked_as_incomplete() {
    let folder = Folder::new();
    let model = folder.file("falls.hyde", FALLS);
    for (format, file) in [("csv", "results.csv"), ("parquet", "results.parquet")] {
        let out = folder.path(format);
        let run = hyde(&["run", &model, "--out", &out, "--format", format, "--json"]);
        assert_eq!(status(&run), 3);
        assert!(text(&run).contains("the level is too low"));
        let found = summary(&out);
        let incomplete = &found["incomplete"];
        let reached = incomplete["reached_s"].as_f64().unwrap();
        assert!((reached - 0.75).abs() < 1e-9, "{reached}");
        let reason = incomplete["reason"].as_str().unwrap();
        assert!(reason.contains("the level is too low"), "{reason}");
        assert_eq!(found["expectations"], serde_json::json!([]));
        let plot = folder.path("plot.svg");
        let results = format!("{out}/{file}");
        let drawn = hyde(&["plot", &results, "x", "--out", &plot]);
        assert_eq!(status(&drawn), 0, "{}", errors(&drawn));
    }
}

/// Each row of a table is a branch of the equations: more than compile in seconds are refused, and what the help says runs.
#[test]
fn a_table_of_too_many_rows_is_refused() {
    let folder = Folder::new();
    let model = FALLS.replace("-1 [1/s]", "-table(time, \"law.csv\", \"t\", \"rate\")");
    let model = folder.file("falls.hyde", &model);
    let rows = |count: u32| -> String {
        let lines = (0..count).map(|k| format!("{k},1\n"));
        std::iter::once("t [s],rate [1/s]\n".to_owned())
            .chain(lines)
            .collect()
    };
    folder.file("law.csv", &rows(30_000));
    let check = hyde(&["check", &model]);
    assert_eq!(status(&check), 1);
    let told = errors(&check);
    assert!(told.contains("30000 rows: a table has 20000"), "{told}");
    assert!(told.contains("keep one row of 2"), "{told}");
    folder.file("law.csv", &rows(200));
    assert_eq!(status(&hyde(&["check", &model])), 0);
}

#[test]
fn what_keeps_nothing_of_what_is_unfinished_ends_at_once() {
    let folder = Folder::new();
    let model = folder.file("day.hyde", DAY);
    for line in [
        &["run", &model, "day"][..],
        &["bode", &model, "stepped"],
        &["sweep", &model, "many", "--out", &folder.path("many")],
    ] {
        let (code, told) = interrupted(line);
        assert_eq!(code, Some(130), "{line:?}: {told}");
    }
}

/// `script` gives the command a terminal.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_shows_how_far_a_run_is() {
    let folder = Folder::new();
    let model = folder.file("day.hyde", DAY);
    let hyde = env!("CARGO_BIN_EXE_hyde");
    for (name, line, shows) in [
        ("run", "day", "s of 86400 s"),
        ("bode", "stepped", "0 of 4 frequencies"),
        ("modes", "day --at steady", "s of 86400 s"),
    ] {
        let line = format!("timeout -s INT 4 {hyde} {name} {model} {line}");
        let shown = |line: &str| {
            let terminal = Command::new("script")
                .args(["-qec", line, "/dev/null"])
                .output();
            terminal.map(|output| text(&output))
        };
        let Ok(told) = shown(&line) else {
            eprintln!("there is no `script` here: nothing is shown without a terminal");
            return;
        };
        assert!(told.contains(shows), "{told}");
        let quiet = shown(&format!("{line} --quiet")).unwrap();
        assert!(!quiet.contains(shows), "{quiet}");
    }
}
