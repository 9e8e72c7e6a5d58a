//! `c_step_over_plant`: a step of the bench axis as exported C, beside a step of the plant that calibrations run on the same
//! record.

use super::clock::now;
use super::process::this_program;
use super::promise::{Figure, Measured, Promise, Session};
use crate::bench_axis;
use crate::fixed_step::{inputs, lines};
use crate::fmu::succeed;
use hyde_calibrate::{Observer, Problem, Recording};
use hyde_compiler::Backend;
use std::path::Path;
use std::process::Command;

pub(super) const FIGURE: Figure = Figure {
    name: "c_step_over_plant",
    unit: "ratio",
    promise: Promise::AtMost(1.2),
    measure,
};

const RECORD: &str = "strokes.csv";
/// The plant halves the time between rows, 1 ms; the C code steps as far.
const STEPS_OF_A_ROW: usize = 2;
const STEP_S: f64 = 0.5e-3;
const STEPS: usize = 10_000;
const TURNS: usize = 7;

/// The quickest pass of each over the record, a step. That of the plant has its observer's correction a row in it.
fn measure(_: &Session) -> Result<Measured, String> {
    let plant_ns = plant_ns()?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let c_ns = c_ns(folder.path())?;
    Ok(Measured::Value(c_ns / plant_ns))
}

/// Nanoseconds of a step of the plant.
fn plant_ns() -> Result<f64, String> {
    let axis = bench_axis::declared()?.observed();
    let tables = axis.parse()?.tables;
    let program = axis.compile(Backend::Native)?.program;
    let recording =
        Recording::new(RECORD, &program, tables, &[]).map_err(|error| format!("{error:?}"))?;
    let rows = recording.rows();
    let recordings = [recording];
    let observer =
        Observer::new(&program, &recordings, &[]).map_err(|error| format!("{error:?}"))?;
    let problem = Problem {
        program: &program,
        recordings: &recordings,
        observer: &observer,
        varied: &[],
        set: &[],
        fold: None,
        reached: None,
    };
    let mut least = f64::INFINITY;
    for _ in 0..TURNS {
        let begin = now();
        problem
            .innovations(&[])
            .map_err(|error| format!("{error:?}"))?;
        least = least.min(begin.elapsed().as_secs_f64() * 1e9);
    }
    #[allow(clippy::cast_precision_loss, reason = "a few thousand rows")]
    let steps = (rows * STEPS_OF_A_ROW) as f64;
    Ok(least / steps)
}

/// Nanoseconds of a step of the C code, with the inputs of the record.
fn c_ns(folder: &Path) -> Result<f64, String> {
    let axis = bench_axis::declared()?;
    let path = folder.display().to_string();
    let step = STEP_S.to_string();
    let model = [
        "export",
        "c",
        "examples/bench_axis/axis.hyde",
        "bench",
        "--step",
        &step,
    ];
    let mut export = Command::new(this_program()?);
    export.args(model).args(["--name", "model", "--out", &path]);
    succeed(&mut export)?;
    let tables = axis.parse()?.tables;
    let program = axis.compile(Backend::Native)?.program;
    let p = hyde_experiment::parameters(&program, &tables, &[])
        .map_err(|error| format!("{error:?}"))?;
    let ((start_s, _), _) = hyde_experiment::extent(&program, &tables, &p);
    let times: Vec<f64> = (1..=STEPS)
        .map(|step| start_s + step as f64 * STEP_S)
        .collect();
    let text = lines(&inputs(&program, &tables, &times)?);
    let (given, timed) = (folder.join("inputs"), folder.join("timed"));
    #[allow(clippy::disallowed_methods, reason = "a file for the C program")]
    std::fs::write(&given, text).map_err(|error| error.to_string())?;
    let mut compiler = Command::new("cc");
    compiler
        .args(["-std=c11", "-O2", "-I", &path])
        .arg(folder.join("model.c"));
    compiler
        .arg("tests/exports/timed.c")
        .arg("-o")
        .arg(&timed)
        .arg("-lm");
    succeed(&mut compiler)?;
    let mut run = Command::new(&timed);
    run.args([STEPS.to_string(), TURNS.to_string()]).arg(&given);
    let output = succeed(&mut run)?;
    output
        .trim()
        .parse()
        .map_err(|_| format!("the C program printed `{output}`"))
}
