//! The loop on the shipped sets of the bench axis, whose records are of another simulator: nothing is found where nothing is
//! missing; a cogging motor is found and measured, and the model that is written says what the axis does.

use crate::command::{self, report};
use hyde_tests::root;
use serde_json::Value;
use std::path::Path;

const AXIS: &str = "examples/bench_axis/axis.hyde";

/// What SOURCE.md of the bench says of the motor: `A*sin(N*phi_m + p)`.
const AMPLITUDE: f64 = 0.30;
const PERIODS: f64 = 12.0;
const PHASE: f64 = 0.4;

/// The plain command on a set, as its README tells it.
fn diagnosed(set: &str, out: &Path) -> Value {
    let data = format!("examples/bench_axis/{set}");
    let out = out.to_str().unwrap();
    report(
        &root(),
        &["diagnose", AXIS, "bench", "--data", &data, "--out", out],
    )
}

/// The records held out: mean square of innovations before and after.
fn held_out(report: &Value) -> (f64, f64) {
    let records = report["records"].as_array().unwrap();
    let held: Vec<&Value> = records.iter().filter(|r| r["holdout"] == true).collect();
    let [record] = held.as_slice() else {
        panic!("{} records are held out", held.len());
    };
    for channel in record["channels"].as_array().unwrap() {
        for measure in ["innovations", "windows", "free_run"] {
            for when in ["before_over_floor", "after_over_floor"] {
                let error = channel[measure][when].as_f64().unwrap();
                assert!(error > 0.0, "{} {measure} {when}", channel["channel"]);
            }
        }
    }
    let of = |when: &str| record["chi"][when].as_f64().unwrap();
    (of("before"), of("after"))
}

/// How far the angle of the motor is from the record held out, rms, the loop closed.
fn angle_error(model: &str, experiment: &str) -> f64 {
    let record = "file=examples/bench_axis/cogging/validate-strokes.csv";
    let run = report(&root(), &["run", model, experiment, "--record", record]);
    let channels = run["channels"].as_array().unwrap();
    let angle = channels.iter().find(|c| c["name"] == "phi_m").unwrap();
    angle["rms"].as_f64().unwrap()
}

#[test]
fn nothing_is_found_where_nothing_is_missing() {
    let folder = tempfile::tempdir().unwrap();
    let report = diagnosed("empty", folder.path());
    assert_eq!(report["verdict"], "none", "{}", report["sentence"]);
    assert_eq!(report["effects"], serde_json::json!([]));
    let (before, after) = held_out(&report);
    assert!((before - 1.0).abs() < 0.1, "{before}");
    assert!((after - 1.0).abs() < 0.1, "{after}");
}

#[test]
fn a_cogging_motor_is_found_and_its_model_says_what_the_axis_does() {
    let folder = tempfile::tempdir().unwrap();
    let report = diagnosed("cogging", folder.path());
    assert_eq!(report["verdict"], "effect", "{}", report["sentence"]);
    let [found] = report["effects"].as_array().unwrap().as_slice() else {
        panic!("{}", report["sentence"]);
    };
    assert_eq!(
        (&found["effect"], &found["site"]),
        (&"Cogging".into(), &"motor.shaft".into())
    );
    let size = found["size"].as_f64().unwrap();
    assert!((size / AMPLITUDE - 1.0).abs() < 0.15, "{size}");
    let shape = |name: &str, end: usize| found["shape"][name]["interval"][end].as_f64().unwrap();
    for (name, value) in [("N", PERIODS), ("phase", PHASE)] {
        let (low, high) = (shape(name, 0), shape(name, 1));
        assert!(low <= value && value <= high, "{name}: {low} .. {high}");
    }
    // Far more than noise at first, noise alone then.
    let (before, after) = held_out(&report);
    assert!(before > 10.0, "{before}");
    assert!((after - 1.0).abs() < 0.1, "{after}");

    // The page and the model are there; the model is in order, and runs.
    assert!(folder.path().join("report.html").is_file());
    let name = report["new_model"].as_str().unwrap();
    let model = folder.path().join(format!("{name}.hyde"));
    let model = model.to_str().unwrap();
    let record = "file=examples/bench_axis/cogging/validate-strokes.csv";
    let checked = command::report(&root(), &["check", model, "--record", record]);
    assert_eq!(checked["ok"], true);
    let experiment = report["new_experiment"].as_str().unwrap();
    let (declared, found) = (angle_error(AXIS, "bench"), angle_error(model, experiment));
    assert!(found < 0.02 * declared, "{declared} rad -> {found} rad");
}
