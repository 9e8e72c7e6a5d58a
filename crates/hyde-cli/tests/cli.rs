//! The command line as its users meet it: exit status, what is printed where, which files are left.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const BENCH: &str = "examples/bench_axis/axis.hyde";

/// A lag with a step, a measure and an expectation.
const LAG: &str = r#"package lag "a lag that a step drives";
import SI.*;

model Lag
  input Real u;
  parameter Time T = 10 [ms];
  Real x(start = 0, fixed = true);
equation
  T*der(x) = u - x;
end Lag;

experiment step of Lag
  stimulus u = 1;
  measure Real highest = max(x);
  expect max(x) < 1.5 "no overshoot";
  stop 50 [ms] every 1 [ms];
end step;
"#;

// ---- exit status ---------------------------------------------------------------------------------------------------

#[test]
fn status_0_when_everything_was_done() {
    for line in [
        &["check", BENCH][..],
        &["run", BENCH, "--stop", "0.02"],
        &["emit", BENCH, "--stage", "flat"],
        &["explain", "E0503"],
        &["explain"],
        &["--help"],
        &["--version"],
    ] {
        let output = hyde(line);
        assert_eq!(status(&output), 0, "{line:?}: {}", errors(&output));
        assert!(!text(&output).is_empty(), "{line:?}");
        assert_eq!(errors(&output), "", "{line:?}");
    }
}

#[test]
fn status_1_when_the_model_is_at_fault() {
    let folder = Folder::new();
    let model = folder.file("wrong.hyde", &LAG.replace("u = 1;", "u = 1 [s];"));
    for command in ["check", "run"] {
        let output = hyde(&[command, &model]);
        assert_eq!(status(&output), 1);
        assert_eq!(text(&output), "");
        let told = errors(&output);
        // Code, place, the line itself, and how to go on.
        for part in ["error[E0301]", "wrong.hyde:9:", "stimulus u = 1 [s];"] {
            assert!(told.contains(part), "`{part}` is not in\n{told}");
        }
        assert!(told.contains("1 error; `hyde explain CODE` tells more"));
    }
}

#[test]
fn status_2_when_the_command_line_is() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    for (line, word) in [
        (&["fly"][..], "fly"),
        (&["run"], "FILE"),
        (
            &["run", "nowhere.hyde"],
            "`nowhere.hyde`: no such file or folder",
        ),
        (
            &["run", &model, "jump"],
            "no experiment `jump`; it has `step`",
        ),
        (&["run", &model, "--set", "T"], "write `path=value [unit]`"),
        (&["run", &model, "--set", "T=fast"], "`fast` is no number"),
        (&["run", &model, "--set", "T=5"], "`T` has a unit"),
        (
            &["run", &model, "--set", "T=5 [m]"],
            "`T` is in ms, not in m",
        ),
        (&["run", &model, "--set", "tau=5"], "no parameter `tau`"),
        (&["run", &model, "--record", "log=x.csv"], "no record `log`"),
        (&["run", &model, "--stop", "0"], "stop must be positive"),
        (&["run", &model, "--stop", "soon"], "soon"),
        (&["modes", &model, "--in", "guide=slip"], "guide"),
        (&["bode", &model], "asks for no response"),
        (
            &["plot", "nowhere.csv"],
            "`nowhere.csv`: no such file or folder",
        ),
        (&["explain", "E9999"], "no code is called `E9999`"),
    ] {
        let output = hyde(line);
        assert_eq!(status(&output), 2, "{line:?}: {}", errors(&output));
        assert_eq!(text(&output), "", "{line:?}");
        let told = errors(&output);
        assert!(told.contains(word), "{line:?}: `{word}` is not in\n{told}");
    }
}

#[test]
fn status_3_when_the_solver_could_not_go_on_and_keeps_what_was_done() {
    let folder = Folder::new();
    let out = folder.path("out");
    let ball = "tests/models/bouncing_ball.hyde";
    let output = hyde(&["run", ball, "drop", "--stop", "6", "--out", &out]);
    assert_eq!(status(&output), 3, "{}", errors(&output));
    let told = errors(&output);
    assert!(told.contains("E0705"), "{told}");
    assert!(told.contains("when h < 0 then"), "{told}");
    let rows = rows(&read(&format!("{out}/results.csv")));
    assert!(
        rows.iter().all(|row| row[0] < 4.1),
        "rows beyond the failure"
    );
    assert!(rows.len() > 400, "{} rows", rows.len());
    assert!(read(&format!("{out}/events.csv")).lines().count() > 30);
    // No summary of a run that did not end.
    assert_eq!(folder.names("out"), ["events.csv", "results.csv"]);
}

#[test]
fn status_4_when_an_expectation_does_not_hold() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", &LAG.replace("< 1.5", "< 0.5"));
    let out = folder.path("out");
    let output = hyde(&["run", &model, "--out", &out]);
    assert_eq!(status(&output), 4);
    assert!(text(&output).contains("DOES NOT HOLD"), "{}", text(&output));
    // The run itself was good: its files are there.
    assert_eq!(
        folder.names("out"),
        ["events.csv", "report.html", "results.csv", "summary.json"]
    );
    let quiet = hyde(&["run", &model, "--quiet"]);
    assert_eq!((status(&quiet), text(&quiet).as_str()), (4, ""));
    assert!(errors(&quiet).contains("does not hold"));
    let json = hyde(&["run", &model, "--json"]);
    assert_eq!(status(&json), 4);
    let summary: Value = serde_json::from_str(&text(&json)).unwrap();
    assert_eq!(summary["expectations"][0]["holds"], false);
}

// ---- what is printed -----------------------------------------------------------------------------------------------

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

// ---- files ---------------------------------------------------------------------------------------------------------

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
    let expected = "floor,stuck,slip,\"floor.a.f > floor.Fs\",Translational.hyde:";
    assert!(first.contains(expected), "{first}");
}

// ---- settings, records, data ---------------------------------------------------------------------------------------

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
    // 12 cells fewer, an angle and a speed each.
    assert_eq!(unknowns(&["--set", "screw.n=12"]) + 24, unknowns(&[]));
}

#[test]
fn missing_data_are_told_in_plain_words() {
    let folder = Folder::new();
    let empty = folder.path("");
    let line = ["run", "examples/emps/emps.hyde", "--data", &empty];
    let output = hyde(&line);
    assert_eq!(status(&output), 1);
    let told = errors(&output);
    for part in ["E0802", "emps_est.csv", "no such file", "--record file="] {
        assert!(told.contains(part), "`{part}` is not in\n{told}");
    }
    // Without its record the model can still be checked.
    let output = hyde(&["check", "examples/emps/emps.hyde", "--data", &empty]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert!(errors(&output).contains("E0802"), "{}", errors(&output));
}

#[test]
fn records_are_found_by_data_and_by_name() {
    let folder = Folder::new();
    let log = folder.file("logs/emps_est.csv", &read("tests/records/emps.csv"));
    let model = "examples/emps/emps.hyde";
    let by_data = hyde(&[
        "run",
        model,
        "--stop",
        "0.1",
        "--json",
        "--data",
        &folder.path("logs"),
    ]);
    let by_name = format!("file={log}");
    let by_name = hyde(&[
        "run", model, "--stop", "0.1", "--json", "--record", &by_name,
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

// ---- figures and analyses ------------------------------------------------------------------------------------------

#[test]
fn results_are_plotted_from_their_folder() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let out = folder.path("out");
    assert_eq!(status(&hyde(&["run", &model, "--out", &out])), 0);
    let svg = folder.path("x.svg");
    let output = hyde(&["plot", &out, "x,u", "--out", &svg, "--title", "a step"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert!(read(&svg).contains("a step"));
    let png = folder.path("x.png");
    assert_eq!(status(&hyde(&["plot", &out, "x", "--out", &png])), 0);
    assert!(std::fs::read(&png).unwrap().starts_with(b"\x89PNG"));
    for (line, word) in [
        (["plot", &out, "speed", "--out", &svg], "speed"),
        (["plot", &out, "x", "--out", "x.pdf"], ".svg or a .png"),
    ] {
        let output = hyde(&line);
        assert_eq!(status(&output), 2);
        assert!(errors(&output).contains(word), "{}", errors(&output));
    }
    assert!(!Path::new("x.pdf").exists());
}

#[test]
fn modes_come_by_frequency() {
    let output = hyde(&["modes", BENCH, "--json", "--below", "2000"]);
    let value: Value = serde_json::from_str(&text(&output)).unwrap();
    let modes = value["modes"].as_array().unwrap();
    let frequencies: Vec<f64> = modes
        .iter()
        .map(|mode| mode["frequency_hz"].as_f64().unwrap())
        .collect();
    assert!(!frequencies.is_empty());
    assert!(frequencies.is_sorted() && frequencies.iter().all(|f| *f < 2000.0));
}

#[test]
fn a_linear_response_leaves_figure_and_numbers() {
    let folder = Folder::new();
    let out = folder.path("bode");
    let axis = "examples/y_axis/axis.hyde";
    let line = [
        "bode", axis, "swept", "--linear", "--points", "50", "--out", &out,
    ];
    let output = hyde(&line);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let names = folder.names("bode");
    for ending in [".csv", ".svg", ".png"] {
        assert!(names.iter().any(|name| name.ends_with(ending)), "{names:?}");
    }
    assert!(names.iter().all(|name| !name.starts_with('.')), "{names:?}");
}

#[test]
fn every_stage_is_printed() {
    for stage in ["ast", "flat", "structure", "dae", "clif", "asm"] {
        let output = hyde(&["emit", BENCH, "--stage", stage]);
        assert_eq!(status(&output), 0, "{stage}: {}", errors(&output));
        assert!(text(&output).lines().count() > 20, "{stage}");
    }
    // The tree is printed as source text, which says the same again.
    let folder = Folder::new();
    let once = text(&hyde(&["emit", BENCH, "--stage", "ast"]));
    let record = format!(
        "file={}",
        top().join("examples/bench_axis/strokes.csv").display()
    );
    let again = folder.file("again.hyde", &once);
    let again = hyde(&["emit", &again, "--stage", "ast", "--record", &record]);
    assert_eq!(text(&again), once);
}

// ---- how it is called ----------------------------------------------------------------------------------------------

fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hyde"));
    command.args(arguments).current_dir(top());
    command
}

fn hyde(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

fn status(output: &Output) -> i32 {
    output.status.code().unwrap()
}

fn text(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn errors(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn top() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[allow(clippy::disallowed_methods, reason = "tests read what was left")]
fn read(path: &str) -> String {
    std::fs::read_to_string(top().join(path)).unwrap()
}

/// The numbers of a CSV file below its header.
fn rows(csv: &str) -> Vec<Vec<f64>> {
    let lines = csv.lines().skip(1);
    lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

/// A folder that goes away with the test.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_string_lossy().into_owned()
    }

    #[allow(clippy::disallowed_methods, reason = "tests write their models")]
    fn file(&self, name: &str, content: &str) -> String {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path.to_string_lossy().into_owned()
    }

    /// The names in a folder below, hidden ones too.
    fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path().join(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = names.map(|n| n.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}
