//! `start_to_first_step_ms`: from source text to the first step of the solver.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_compiler::Backend;
use hyde_sim::Setup;
use std::collections::BTreeMap;

pub(super) const FIGURE: Figure = Figure {
    name: "start_to_first_step_ms",
    unit: "ms",
    promise: Promise::AtMost(25.0),
    measure,
};

/// The file and the experiment that are started.
pub const START: (&str, &str) = ("examples/y_axis/axis.hyde", "swept");

/// Starts that are timed; the middle one counts.
const REPEATS: usize = 11;

/// A stop within the solver's first step.
const FIRST_STEP_S: f64 = 1e-9;

/// Parses, flattens, analyses, compiles, finds consistent initial conditions and makes one step. Reading files is left
/// out: the text is there, and a record would be read in the time its length takes.
///
/// # Errors
/// Every diagnostic, or why there is no step.
pub fn first_step(example: &Example) -> Result<u64, String> {
    let compiled = example.compile(Backend::Native)?;
    let program = &compiled.program;
    let records = BTreeMap::new();
    let parameters = hyde_experiment::parameters(program, &records, &[])
        .map_err(|error| format!("{error:?}"))?;
    let setup = Setup::new(parameters, &records, FIRST_STEP_S);
    let results = hyde_sim::simulate(program, &setup)
        .map_err(|failure| format!("{:?} at {} s", failure.kind, failure.t))?;
    Ok(results.statistics.steps)
}

fn measure(_: &Session) -> Result<Measured, String> {
    let example = Example::load(START.0, Some(START.1))?;
    let mut times = Vec::new();
    for _ in 0..REPEATS {
        let start = now();
        let steps = first_step(&example)?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        if steps == 0 {
            return Err("the solver made no step".to_owned());
        }
    }
    times.sort_by(f64::total_cmp);
    Ok(Measured::Value(times[REPEATS / 2]))
}
