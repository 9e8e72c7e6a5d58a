//! `realtime_factor_y_axis`: simulated time over the time its solution takes, of the Y axis under sampled control.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_compiler::Backend;
use hyde_experiment::Options;
use std::collections::BTreeMap;

pub(super) const FIGURE: Figure = Figure {
    name: "realtime_factor_y_axis",
    unit: "",
    promise: Promise::AtLeast(20.0),
    measure,
};

/// What is simulated, as it stands in the example: rtol 1e-6, rows every 1 ms; every reversal of friction and play and every
/// tick of the control is an event.
const EXAMPLE: (&str, &str) = ("examples/y_axis/axis.hyde", "positioning");

/// Runs that are timed; the middle one counts.
const REPEATS: usize = 3;

fn measure(_: &Session) -> Result<Measured, String> {
    let example = Example::load(EXAMPLE.0, Some(EXAMPLE.1))?;
    let program = example.compile(Backend::Native)?.program;
    let mut factors = Vec::new();
    for _ in 0..REPEATS {
        let start = now();
        let run = hyde_experiment::run(&program, &BTreeMap::new(), &Options::default())
            .map_err(|error| format!("{error:?}"))?;
        let took_s = start.elapsed().as_secs_f64();
        if run.results.statistics.events < 10 {
            return Err("the axis does not reverse".to_owned());
        }
        factors.push(run.stop_s / took_s);
    }
    factors.sort_by(f64::total_cmp);
    Ok(Measured::Value(factors[REPEATS / 2]))
}
