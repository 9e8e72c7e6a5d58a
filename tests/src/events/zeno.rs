//! Bounces that add up to a finite time: the run ends with that time.

use super::solved::{close, failure, tells, time_told};
use hyde_experiment::Options;

/// The time in s to which bounces add up: after a fall from a height in m every flight is `e` times the one before.
fn sum(height: f64, e: f64) -> f64 {
    (2.0 * height / 9.81).sqrt() * (1.0 + 2.0 * e / (1.0 - e))
}

/// A mode that leads to itself, two balls of which one is first, and a ball whose bounces are few, above zero.
pub(super) fn sums() -> Result<(), String> {
    let cases = [
        // A dozen flights of rtol 1e-9, the last of them as low as the tolerance.
        ("again", "h < 0", sum(1.0, 0.7), 1e-5, "zeno.hyde:10"),
        ("two", "h < 0", sum(1.0, 0.7), 1e-5, "zeno.hyde:23"),
        ("dull", "h < 10", sum(1.0, 0.1), 1e-5, "zeno.hyde:36"),
    ];
    for (experiment, cause, expected, tolerance, place) in cases {
        let told = failure("events/zeno", experiment, &Options::default())?;
        tells(&told, &["Zeno", cause, place])?;
        let number = told
            .split_once("sum_s: ")
            .and_then(|(_, rest)| rest.split_once(' '));
        let number = number.and_then(|(number, _)| number.parse().ok());
        close(experiment, number.ok_or("no sum")?, expected, tolerance)?;
        // Flights are then a ten-thousandth of the first.
        close("end", time_told(&told)?, expected, 1e-4 * expected)?;
    }
    Ok(())
}

/// A ball that lies on the floor from the start bounces there without end.
pub(super) fn at_once() -> Result<(), String> {
    let told = failure("events/zeno", "lying", &Options::default())?;
    tells(&told, &["Chattering", "h < 0", "zeno.hyde:47"])?;
    close("end", time_told(&told)?, 0.0, 0.0)
}
