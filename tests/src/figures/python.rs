//! `python_sweep_ratio`: a thousand parameter sets of the first example in one process of Python, compiled once, against
//! `hyde sweep` of the same, both released and on all processors. `python_run_overhead_percent`: one run of the bench axis
//! in Python, against `hyde run` of it.

use super::clock::now;
use super::promise::{Figure, Measured, Promise};
use crate::fmu::{python, succeed};
use crate::root;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

pub(super) const SWEEP: Figure = Figure {
    name: "python_sweep_ratio",
    unit: "of the rate of `hyde sweep`",
    promise: Promise::AtLeast(0.9),
    measure: |_| beside(sweep),
};

pub(super) const RUN: Figure = Figure {
    name: "python_run_overhead_percent",
    unit: "% more time than `hyde run`",
    promise: Promise::AtMost(5.0),
    measure: |_| beside(overhead),
};

/// Added to the first example; `sweep.py` has the same masses.
const MASSES: &str = "
sweep masses of push
  vary table.M in 200 .. 400 [kg];
  grid 1000;
end masses;
";

/// Each is measured so often, by turns; the shortest time counts, as another program may take a processor.
const ROUNDS: usize = 4;

/// In Python the time is that of loading and of the runs, without the start of the interpreter; of the command it is that of the
/// whole process.
fn sweep(python: &Path, folder: &Path) -> Result<f64, String> {
    let model = folder.join("first.hyde");
    first_with_masses(&model).map_err(|error| error.to_string())?;

    let (mut in_python, mut by_command) = (f64::INFINITY, f64::INFINITY);
    for round in 0..ROUNDS {
        let mut script = script(python, "sweep.py", folder);
        let answer = json(&succeed(script.arg(&model))?)?;
        in_python = in_python.min(answer["s"].as_f64().unwrap_or(f64::NAN));

        let mut command = Command::new(root().join("target/release/hyde"));
        command.args(["sweep", "--json"]).arg(&model).arg("masses");
        command.arg("--out").arg(folder.join(round.to_string()));
        let start = now();
        let printed = succeed(&mut command)?;
        by_command = by_command.min(start.elapsed().as_secs_f64());
        let summary = json(printed.lines().last().unwrap_or_default())?;
        same(&answer["ways"], &summary["measures"][0]["quantiles"])?;
    }
    Ok(by_command / in_python)
}

/// The time in Python is that of loading and of the run, without the start of the interpreter; of the command it is that of the
/// whole process, which writes no files.
fn overhead(python: &Path, folder: &Path) -> Result<f64, String> {
    let model = root().join("examples/bench_axis/axis.hyde");

    let (mut in_python, mut by_command) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        let mut script = script(python, "run.py", folder);
        let answer = json(&succeed(script.arg(&model).arg("bench"))?)?;
        in_python = in_python.min(answer["s"].as_f64().unwrap_or(f64::NAN));

        let mut command = Command::new(root().join("target/release/hyde"));
        command.args(["run", "--json"]).arg(&model).arg("bench");
        let start = now();
        let printed = succeed(&mut command)?;
        by_command = by_command.min(start.elapsed().as_secs_f64());
        same_channels(&answer["channels"], &json(&printed)?["channels"])?;
    }
    Ok(100.0 * (in_python / by_command - 1.0))
}

/// Measures with an interpreter and a folder that it finds the package in; absent without an interpreter.
fn beside(measure: fn(&Path, &Path) -> Result<f64, String>) -> Result<Measured, String> {
    let python = match python() {
        Ok(python) => python,
        Err(reason) => return Ok(Measured::Absent(reason)),
    };
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    package(folder.path())?;
    measure(&python, folder.path()).map(Measured::Value)
}

/// A program beside this file, which finds the package in the folder.
fn script(python: &Path, name: &str, folder: &Path) -> Command {
    let mut script = Command::new(python);
    script.arg(root().join("tests/src/figures").join(name));
    script.env("PYTHONPATH", folder);
    script
}

/// The first example with its sweep.
#[allow(clippy::disallowed_methods, reason = "a file of both processes")]
fn first_with_masses(model: &Path) -> std::io::Result<()> {
    let first = fs::read_to_string(root().join("examples/first/first.hyde"))?;
    fs::write(model, first + MASSES)
}

/// Builds the command and the module, and lays the package out in a folder.
fn package(folder: &Path) -> Result<(), String> {
    for package in ["hyde-cli", "hyde-python"] {
        let build = ["build", "--release", "--locked", "-q", "-p", package];
        succeed(Command::new("cargo").args(build))?;
    }
    lay_out(&folder.join("hyde")).map_err(|error| error.to_string())
}

#[allow(clippy::disallowed_methods, reason = "files of the package")]
fn lay_out(package: &Path) -> std::io::Result<()> {
    fs::create_dir(package)?;
    for entry in fs::read_dir(root().join("crates/hyde-python/python/hyde"))? {
        let path = entry?.path();
        if path.extension().is_some_and(|ending| ending == "py") {
            fs::copy(&path, package.join(path.file_name().unwrap_or_default()))?;
        }
    }
    let module = root().join("target/release/lib_hyde.so");
    fs::copy(module, package.join("_hyde.abi3.so"))?;
    Ok(())
}

fn json(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|error| format!("{error}: {text}"))
}

/// The shortest and the longest way in Python are those of the command.
fn same(ways: &Value, quantiles: &Value) -> Result<(), String> {
    let quantiles = quantiles.as_array().map_or(&[][..], Vec::as_slice);
    let ends = [quantiles.first(), quantiles.last()].map(|end| end.map(|end| &end["value"]));
    let equal = (0..2).all(|index| ends[index].is_some_and(|end| *end == ways[index]));
    match equal {
        true => Ok(()),
        false => Err(format!("in Python {ways}, by the command {ends:?}")),
    }
}

/// The errors of the channels in Python are those of the command, to the last digit.
fn same_channels(ours: &Value, printed: &Value) -> Result<(), String> {
    let channels = printed.as_array().map_or(&[][..], Vec::as_slice);
    let equal = channels
        .iter()
        .all(|own| ours[own["name"].as_str().unwrap_or_default()] == own["rms"]);
    match equal && !channels.is_empty() {
        true => Ok(()),
        false => Err(format!("in Python {ours}, by the command {printed}")),
    }
}
