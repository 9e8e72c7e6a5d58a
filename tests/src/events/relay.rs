//! A relay that drives what it looks at back across its switching point.

use super::solved::{close, failure, solve, tells, time_told};
use hyde_experiment::Options;

/// Without a width it switches for ever where x comes down to 0; both guards are named, by file and line.
pub(super) fn chatters() -> Result<(), String> {
    let told = failure("events/relay", "bare", &Options::default())?;
    tells(&told, &["relay.hyde:10", "relay.hyde:14"])?;
    // From 1 at a rate of -1/s; it is told after some switching.
    close("end", time_told(&told)?, 1.0, 1e-9)?;
    let kind = ["Chattering", "TooManyEvents"];
    let named = kind.iter().any(|kind| told.contains(kind));
    named.then_some(()).ok_or(told)
}

/// With a width of ±0.1 it falls for 0.2 s and rises for 0.1 s.
pub(super) fn oscillates() -> Result<(), String> {
    let relay = solve("events/relay", "wide")?;
    let (low, high) = ("x < -width", "x > width");
    let periods = (0..7).map(|k| 1.1 + 0.3 * f64::from(k));
    let mut expected: Vec<(f64, &str)> = periods
        .flat_map(|fall| [(fall, low), (fall + 0.1, high)])
        .collect();
    // The last rise ends at 3 s, after the run.
    expected.pop();
    // Straight lines: nothing but rounding.
    relay.happened(&expected, 1e-12)
}
