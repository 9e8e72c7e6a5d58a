//! `long_run_mb` and `csv_share_percent`: ten minutes of an axis under a controller of 1 kHz with a row each millisecond. How
//! much memory does the run take, and how much of its time the results as text? The command is this program itself.

use super::process::{cpu_s, memory_kb, this_program};
use super::promise::{Figure, Measured, Promise, Session};
use std::process::{Command, Stdio};
use std::time::Duration;

pub(super) const MEMORY: Figure = Figure {
    name: "long_run_mb",
    unit: "MB",
    promise: Promise::AtMost(200.0),
    measure: |_: &Session| match run(&["--out", "out"])? {
        (0.0, _) => Ok(no_proc()),
        (most_kb, _) => Ok(Measured::Value(most_kb / 1024.0)),
    },
};

pub(super) const CSV: Figure = Figure {
    name: "csv_share_percent",
    unit: "%",
    promise: Promise::AtMost(30.0),
    measure: |_: &Session| {
        let (with, without) = (run(&["--out", "out"])?.1, run(&[])?.1);
        let (Some(with), Some(without)) = (with, without) else {
            return Ok(no_proc());
        };
        Ok(Measured::Value(100.0 * (with - without) / with))
    },
};

fn no_proc() -> Measured {
    Measured::Absent("memory and time of processes: this system has no /proc".to_owned())
}

/// The most memory in kB and the CPU time in s of a run.
fn run(options: &[&str]) -> Result<(f64, Option<f64>), String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let model = crate::root().join("tests/models/ten_minutes.hyde");
    let before = cpu_s(true);
    let mut child = Command::new(this_program()?)
        .arg("run")
        .arg(model)
        .args(options)
        .current_dir(folder.path())
        .stdout(Stdio::null())
        .spawn()
        .map_err(|error| error.to_string())?;
    let mut most = 0.0_f64;
    let status = loop {
        if let Some(status) = child.try_wait().map_err(|error| error.to_string())? {
            break status;
        }
        most = most.max(memory_kb(child.id()).unwrap_or(0.0));
        std::thread::sleep(Duration::from_millis(2));
    };
    if !status.success() {
        return Err(format!("the run ended with {status}"));
    }
    let took = cpu_s(true)
        .zip(before)
        .map(|(after, before)| after - before);
    Ok((most, took))
}
