//! `emps_force_error_…_percent`: the measured axis diagnosed on the first half of its record, judged on the second.
//!
//! All are the closed loop over the whole record, the force compared in the second half only. Diagnosed: the model that `hyde
//! diagnose --out` writes for the first half, with the effects and the parameters that it finds there, and the controller as
//! the diagnosis says that it is to be written. After: the refined model of the example, fitted there.

use super::promise::{Figure, Measured, Promise, Session};
use crate::{Example, root};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

pub(super) const BEFORE: Figure = Figure {
    name: "emps_force_error_before_percent",
    unit: "%",
    promise: Promise::Within(5.9, 6.0),
    measure: before,
};

pub(super) const DIAGNOSED: Figure = Figure {
    name: "emps_force_error_diagnosed_percent",
    unit: "%",
    promise: Promise::AtMost(2.6),
    measure: diagnosed,
};

pub(super) const AFTER: Figure = Figure {
    name: "emps_force_error_after_percent",
    unit: "%",
    promise: Promise::AtMost(2.5),
    measure: after,
};

const FILE: &str = "examples/emps/emps.hyde";
const RECORD: &str = "emps/emps_est.csv";
/// The model with the effects that are found, as the diagnosis names it.
const FOUND: &str = "Axis2";
/// The row where the second half begins, and its time.
const HALF: usize = 12_420;
const SECOND: (&str, &str) = ("skip 49 [ms]", "skip 12.42 [s]");

fn before(session: &Session) -> Result<Measured, String> {
    let record = session.data.join(RECORD);
    if !record.is_file() {
        return Ok(absent());
    }
    let example = Example::load(FILE, Some("tracking"))?.record("file", record);
    force(&example.rewritten(SECOND.0, SECOND.1)).map(Measured::Value)
}

fn absent() -> Measured {
    let what = "emps/emps_est.csv, the record of EMPS (nonlinearbenchmark.org), is not below the data folder";
    Measured::Absent(what.to_owned())
}

/// The relative error of the force in percent.
fn force(example: &Example) -> Result<f64, String> {
    let (_, run) = example.run()?;
    let channel = run.channels.iter().find(|channel| channel.name == "force");
    channel
        .map(|channel| channel.relative_percent)
        .ok_or_else(|| "the experiment measures no force".to_owned())
}

fn after(session: &Session) -> Result<Measured, String> {
    let record = session.data.join(RECORD);
    if !record.is_file() {
        return Ok(absent());
    }
    // This very program is the command.
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    crate::benchmarks::second_half(&own, &record).map(Measured::Value)
}

#[allow(
    clippy::disallowed_methods,
    reason = "the record is cut in two in a folder of its own"
)]
fn diagnosed(session: &Session) -> Result<Measured, String> {
    let record = session.data.join(RECORD);
    if !record.is_file() {
        return Ok(absent());
    }
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string());
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).map_err(|error| error.to_string())
    };
    let (model, rows) = (read(&root().join(FILE))?, read(&record)?);
    let halves = halves(&rows);
    write("fit-1.csv", &halves[0])?;
    write("holdout-1.csv", &halves[1])?;
    write("emps.hyde", &model)?;
    let found = hyde(
        folder.path(),
        &["diagnose", "emps.hyde", "emps", "--json", "--out", "."],
    )?;
    let written = folder.path().join(FOUND).with_extension("hyde");
    if !written.is_file() {
        return Err(format!("no effect was found: {}", found["sentence"]));
    }
    // The first experiment of the file is that of the closed loop.
    let text = read(&written)?.replacen("of Axis(q0", &format!("of {FOUND}(q0"), 1);
    let edits = found["command_timings"].as_array().into_iter().flatten();
    let edits =
        edits.filter_map(|own| own["edit"]["from"].as_str().zip(own["edit"]["to"].as_str()));
    let mended = edits.fold(text, |text, (from, to)| text.replace(from, to));
    let example = Example::load(FILE, Some("tracking"))?.record("file", &record);
    let example = example.replaced(&mended, "tracking");
    force(&example.rewritten(SECOND.0, SECOND.1)).map(Measured::Value)
}

/// Both halves of the record, the time of either from 0: the record's own clock drifts by less than a thousandth of a row.
fn halves(rows: &str) -> [String; 2] {
    let mut lines = rows.lines();
    let head = format!("{}\n", lines.next().unwrap_or_default());
    let mut halves = [head.clone(), head];
    for (number, line) in lines.enumerate() {
        let half = usize::from(number >= HALF);
        let time = (number - half * HALF) as f64 * 1e-3;
        let rest = line.split_once(',').map_or("", |(_, rest)| rest);
        halves[half].push_str(&format!("{time:.3},{rest}\n"));
    }
    halves
}

/// Runs the command, which this very program is, and reads what it prints.
fn hyde(folder: &Path, arguments: &[&str]) -> Result<Value, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new(own)
        .current_dir(folder)
        .args(arguments)
        .output()
        .map_err(|error| error.to_string())?;
    serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("{error}: {}", String::from_utf8_lossy(&output.stderr)))
}
