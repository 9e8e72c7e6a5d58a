//! `p2_event_time_error`, `p3_event_time_error`: are events found when they happen, all of them?
//!
//! Stick-slip and backlash of which the number of events is known; the times at rtol 1e-6 against a run at 1e-10.

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_experiment::Options;

pub(super) const P2: Figure = Figure {
    name: "p2_event_time_error",
    unit: "s",
    promise: Promise::AtMost(1e-5),
    measure: |_: &Session| error(("tests/models/p2.hyde", "draw"), 65),
};

pub(super) const P3: Figure = Figure {
    name: "p3_event_time_error",
    unit: "s",
    promise: Promise::AtMost(1e-5),
    measure: |_: &Session| error(("tests/models/p3.hyde", "swing"), 91),
};

/// The largest difference of the events' times; a missing or an additional event is an error.
fn error((model, experiment): (&str, &str), count: usize) -> Result<Measured, String> {
    let example = Example::load(model, Some(experiment))?;
    let times = |rtol: f64, atol: f64| -> Result<Vec<f64>, String> {
        let options = Options {
            rtol: Some(rtol),
            atol: Some(atol),
            ..Options::default()
        };
        let (_, run) = example.run_with(&options)?;
        Ok(run.results.events.iter().map(|event| event.t).collect())
    };
    let (found, reference) = (times(1e-6, 1e-8)?, times(1e-10, 1e-12)?);
    if found.len() != count || reference.len() != count {
        let (a, b) = (found.len(), reference.len());
        return Err(format!("{a} and {b} events instead of {count}"));
    }
    let differences = found.iter().zip(&reference).map(|(a, b)| (a - b).abs());
    Ok(Measured::Value(differences.fold(0.0, f64::max)))
}
