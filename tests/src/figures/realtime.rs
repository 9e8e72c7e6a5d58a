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
    promise: Promise::AtLeast(30.0),
    measure,
};

/// What is simulated: ten seconds in operation, sampled every 10 ms, every reversal of friction and play an event.
const EXAMPLE: (&str, &str) = ("examples/y_axis/axis.hyde", "swept");
const AS_WRITTEN: &str = "solve ida(rtol = 1e-6) stop 30 [s] every 1 [ms]";
/// The method of sampled drives, at the tolerance that is usual for engineering; a row a tick, beside those at events.
const TEN_SECONDS: &str = "solve auto(rtol = 1e-4) stop 10 [s] every 10 [ms]";
/// The cells that `fem(f_max = 500 [Hz])` chooses for this screw: waves of 500 Hz are longer than it, so it is the least number.
const CELLS: f64 = 4.0;

/// Runs that are timed; the middle one counts.
const REPEATS: usize = 3;

fn measure(_: &Session) -> Result<Measured, String> {
    let example = Example::load(EXAMPLE.0, Some(EXAMPLE.1))?
        .rewritten(AS_WRITTEN, TEN_SECONDS)
        .set("screw.n", CELLS);
    let program = example.compile(Backend::Native)?.program;
    let mut factors = Vec::new();
    for _ in 0..REPEATS {
        let start = now();
        let run = hyde_experiment::run(&program, &BTreeMap::new(), &Options::default())
            .map_err(|error| format!("{error:?}"))?;
        let took_s = start.elapsed().as_secs_f64();
        if run.results.statistics.events < 100 {
            return Err("the axis does not reverse".to_owned());
        }
        factors.push(run.stop_s / took_s);
    }
    factors.sort_by(f64::total_cmp);
    Ok(Measured::Value(factors[REPEATS / 2]))
}
