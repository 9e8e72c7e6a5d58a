//! A command that the model puts out at another time than the record: a sled with a sampled loop, simulated here row by row.

use crate::command::{report, write};
use crate::points::Random;
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

const MODEL: &str = "package sled;
import SI.*;
import Translational.*;

model Controller
  input Length r, s;
  output Force u(start = 0);
  Length last(start = 0) = s;
  Force result(start = 0);
equation
  result = clamp(2 [kN/m]*(r - s) - 120 [N.s/m]*(s - pre(last))/interval(), -200 [N], 200 [N]);
  u = result;
end Controller;

model Sled
  input Length r;
  parameter Mass M = 2.04 [kg] ~ ±5%;
  Rail a;
  Length s(start = 0, fixed = true);
  Velocity v(start = 0, fixed = true) = der(s);
  Force F = hold(cnc.control.u);
  clocked cnc(2 [ms])
    Controller control(r = sample(r), s = sample(s));
  end cnc;
equation
  a.s = s;
  M*der(v) = a.f + F - 20 [N.s/m]*v;
end Sled;

experiment moves(record file every 1 [ms] = \"record.csv\") of Sled
  stimulus r = file.r;
  measured file.s = s ~ 1 [um];
  replay F = file.F;
  solve ida(rtol = 1e-8) stop file.end every 1 [ms];
end moves;

calibrate sled of Sled
  fit moves(\"record.csv\");
  vary uncertain;
end sled;

diagnose sled of calibrate sled
  candidates Effects.Pull;
  max_effects 1;
end sled;
";

/// Writes a record of 4 s whose controller puts its result out so many ticks late; its column of the force is recorded so many
/// rows late.
fn record(folder: &Path, ticks_late: usize, rows_late: usize) {
    const M: f64 = 2.0;
    const B: f64 = 20.0;
    const STEP: f64 = 1e-3;
    let (mut s, mut v, mut last) = (0.0_f64, 0.0_f64, 0.0_f64);
    let (mut results, mut forces) = (vec![0.0; ticks_late], Vec::new());
    let mut random = Random(7);
    let mut text = "t [s],r [m],s [m],F [N]\n".to_owned();
    for row in 0..4000_usize {
        let t = STEP * row as f64;
        let r = 0.02 * (5.0 * t).sin() * (1.0 - (-2.0 * t).exp()) + 0.005 * (23.0 * t).sin();
        if row % 2 == 0 {
            let result = 2000.0 * (r - s) - 120.0 * (s - last) / (2.0 * STEP);
            last = s;
            results.push(result.clamp(-200.0, 200.0));
        }
        let force: f64 = results[results.len() - 1 - ticks_late];
        forces.push(force);
        let recorded = forces[row.saturating_sub(rows_late)];
        let _ = writeln!(
            text,
            "{t:.3},{r:.9},{:.9},{recorded:.9}",
            s + 1e-6 * random.normal()
        );
        // M v' = F - B v with a constant force.
        let (end, decay) = (force / B, (-B / M * STEP).exp());
        s += end * STEP + (v - end) * (1.0 - decay) * M / B;
        v = end + (v - end) * decay;
    }
    write(&folder.join("record.csv"), &text);
}

/// The report on such a record, of the model with some text changed.
fn diagnosed(change: (&str, &str), ticks_late: usize, rows_late: usize) -> Value {
    let folder = tempfile::tempdir().unwrap();
    record(folder.path(), ticks_late, rows_late);
    assert!(MODEL.contains(change.0), "{}", change.0);
    write(
        &folder.path().join("sled.hyde"),
        &MODEL.replace(change.0, change.1),
    );
    report(folder.path(), &["diagnose", "sled.hyde", "sled"])
}

/// By how much the command is late in s, and whether its column is at fault.
fn timing(report: &Value) -> (f64, bool) {
    let all = report["command_timings"].as_array().unwrap();
    assert_eq!(all.len(), 1, "{report:#}");
    let late_s = all[0]["late_s"].as_f64().unwrap();
    (
        (1e3 * late_s).round() / 1e3,
        all[0]["of_column"].as_bool().unwrap(),
    )
}

fn says(report: &Value, words: &str) {
    let text = report.to_string();
    assert!(text.contains(words), "{words}: {report:#}");
}

const AS_IT_IS: (&str, &str) = ("u = result", "u = result");

#[test]
fn a_command_at_its_time_is_told_as_such_and_raises_no_doubt() {
    let report = diagnosed(AS_IT_IS, 0, 0);
    assert_eq!(timing(&report), (0.0, false));
    assert_eq!(report["sentence"], "no missing effect detected");
    assert_eq!(report["doubts"].as_array().unwrap().len(), 0, "{report:#}");
    let error = report["command_timings"][0]["error"].as_f64().unwrap();
    assert!(error < 0.05, "{error}");
}

#[test]
fn a_register_that_the_controller_does_not_have_is_found_and_the_repair_mends_it() {
    let report = diagnosed(("u = result", "u = pre(result)"), 0, 0);
    assert_eq!(timing(&report), (0.002, false));
    says(&report, "the model puts out F 2 ms too late");
    let edit = &report["command_timings"][0]["edit"];
    assert_eq!(edit["file"], "sled.hyde");
    let line = MODEL
        .lines()
        .position(|line| line == "  u = result;")
        .unwrap();
    assert_eq!(edit["line"], line + 1);
    let (from, to) = (edit["from"].as_str().unwrap(), edit["to"].as_str().unwrap());
    let wrong = MODEL.replace("u = result", "u = pre(result)");
    assert_eq!(wrong.replace(from, to), MODEL);
}

#[test]
fn a_delay_that_the_model_lacks_is_found_and_the_repair_mends_it() {
    let report = diagnosed(AS_IT_IS, 1, 0);
    assert_eq!(timing(&report), (-0.002, false));
    says(&report, "the model puts out F 2 ms too early");
    says(&report, "the `delay` of the clock cnc is to be 2 ms");
    let mended = ("cnc(2 [ms])", "cnc(2 [ms], delay = 2 [ms])");
    assert_eq!(timing(&diagnosed(mended, 1, 0)), (0.0, false));
}

#[test]
fn a_column_that_is_recorded_late_is_not_blamed_on_the_controller() {
    let report = diagnosed(AS_IT_IS, 0, 2);
    assert_eq!(timing(&report), (-0.002, true));
    assert_eq!(
        report["sentence"],
        "no missing effect detected; the column of F was recorded 2 ms too late"
    );
    says(
        &report,
        "the diagnosis has moved this column in all records",
    );
}

#[test]
fn a_scaled_replay_is_compared_too() {
    let late = MODEL.replace("u = result", "u = pre(result)");
    for (model, late_s) in [(MODEL, 0.0), (&late, 0.002)] {
        let scaled = model.replace("replay F = file.F", "replay F = 0.5*(file.F + file.F)");
        let folder = tempfile::tempdir().unwrap();
        record(folder.path(), 0, 0);
        write(&folder.path().join("sled.hyde"), &scaled);
        let report = report(folder.path(), &["diagnose", "sled.hyde", "sled"]);
        assert_eq!(timing(&report), (late_s, false));
        assert_eq!(not_compared(&report), "");
    }
}

/// Why the command is not compared with its record; empty where it is.
fn not_compared(report: &Value) -> String {
    let all = report["commands_not_compared"].as_array().unwrap();
    let why = all.first().map(|own| own["why"].as_str().unwrap());
    why.unwrap_or_default().to_owned()
}

#[test]
fn a_command_that_is_not_compared_is_told_with_the_reason() {
    let cases = [
        (
            ("replay F = file.F", "replay F = file.F + 1 [mN/m]*file.r"),
            "its replay does not read exactly one column",
        ),
        (
            ("cnc(2 [ms])", "cnc(1.5 [ms])"),
            "its clock cnc ticks every 1.5 ms, and the record has a sample every 1 ms",
        ),
        (("2 [kN/m]*(r - s)", "2 [kN/m]*r"), "however it is moved"),
    ];
    for (change, why) in cases {
        let report = diagnosed(change, 0, 0);
        assert_eq!(
            report["command_timings"].as_array().unwrap().len(),
            0,
            "{why}"
        );
        let told = not_compared(&report);
        assert!(told.contains(why), "{why}: {told}");
        says(
            &report,
            "whether the model puts out F at the right time is not known",
        );
    }
}
