//! Exit status: who is at fault.

use crate::command::{BENCH, Folder, LAG, errors, hyde, read, rows, status, text};
use serde_json::Value;

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
    let model = folder.file("wrong.hyde", &LAG.replace("10 [ms]", "10 [mm]"));
    for command in ["check", "run"] {
        let output = hyde(&[command, &model]);
        assert_eq!(status(&output), 1);
        assert_eq!(text(&output), "");
        let told = errors(&output);
        // Code, place, the line itself, and how to go on.
        for part in [
            "error[E0301]",
            "wrong.hyde:6:",
            "parameter Time T = 10 [mm];",
        ] {
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
        (
            &["run", &model, "--set", "T=fast"],
            "`fast` is not a number",
        ),
        (&["run", &model, "--set", "T=5"], "`T` has a unit"),
        (
            &["run", &model, "--set", "T=5 [m]"],
            "`T` is in ms, not in m",
        ),
        (&["run", &model, "--set", "tau=5"], "no parameter `tau`"),
        (&["run", &model, "--record", "log=x.csv"], "no record `log`"),
        (&["run", &model, "--stop", "soon"], "soon"),
        (&["modes", &model, "--in", "guide=slip"], "guide"),
        (&["bode", &model], "has no `bode` or `margins`"),
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
    // The summary and the page say that the run did not end.
    assert_eq!(
        folder.names("out"),
        ["events.csv", "report.html", "results.csv", "summary.json"]
    );
    let summary: Value = serde_json::from_str(&read(&format!("{out}/summary.json"))).unwrap();
    let reached = summary["incomplete"]["reached_s"].as_f64().unwrap();
    assert!((3.9..4.1).contains(&reached), "{reached}");
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

/// Half an answer is none, whatever was asked for.
#[cfg(target_os = "linux")]
#[test]
fn status_2_when_standard_output_is_full() {
    for line in [
        &["check", BENCH][..],
        &["run", BENCH, "--stop", "0.02", "--json"],
        &["params", BENCH],
        &["explain", "E0503"],
        &["--help"],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
        let output = crate::command::command(line)
            .stdout(full.unwrap())
            .output()
            .unwrap();
        assert_eq!(status(&output), 2, "{line:?}");
        let told = errors(&output);
        assert!(
            told.contains("cannot write to standard output: the disk is full"),
            "{line:?}: {told}"
        );
    }
}

/// What keeps nothing of what is unfinished ends at once, with the status of what was interrupted.
#[cfg(unix)]
#[test]
fn status_130_when_it_was_interrupted() {
    let cogging = "examples/bench_axis/cogging";
    // A calibration alone may have ended by then: with profiles it takes several seconds.
    let profiles = ["Tcs", "bs", "bearing.T", "bearing.b", "guide.F", "guide.b"];
    let fit: Vec<&str> = (["fit", BENCH, "bench", "--data", cogging].into_iter())
        .chain(profiles.into_iter().flat_map(|name| ["--profile", name]))
        .collect();
    for line in [&fit[..], &["diagnose", BENCH, "bench", "--data", cogging]] {
        let mut child = crate::command::command(line)
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(std::time::Duration::from_millis(700));
        let signal = std::process::Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(signal.unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(130), "{line:?}");
    }
}
