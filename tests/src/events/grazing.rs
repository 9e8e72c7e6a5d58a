//! A sine that reaches a level by a millionth, or falls short of it by as much.

use super::solved::solve;
use std::f64::consts::PI;

/// It crosses up and down again within 2.8 ms, in each of three periods.
pub(super) fn touches() -> Result<(), String> {
    let rise = (1.0_f64 - 1e-6).asin();
    let crossings = |above: &'static str, below: &'static str| -> Vec<(f64, &'static str)> {
        let periods = [0.0, 2.0 * PI, 4.0 * PI].into_iter();
        periods
            .flat_map(|start| [(start + rise, above), (start + PI - rise, below)])
            .collect()
    };
    // An error of 1e-8 of the integrated sine (rtol 1e-10 over three periods) shifts a crossing of slope 1.4e-3 by 1e-5.
    let integrated = solve("events/grazing", "touches")?;
    integrated.happened(&crossings("x > level", "x < level"), 1e-5)?;
    // A given sine is exact, only the search for its crossing is not; the steps know nothing of it.
    let given = solve("events/grazing", "signal_touches")?;
    given.happened(&crossings("u > level", "u < level"), 1e-11)
}

/// Nothing happens.
pub(super) fn misses() -> Result<(), String> {
    solve("events/grazing", "misses")?.happened(&[], 0.0)?;
    solve("events/grazing", "signal_misses")?.happened(&[], 0.0)
}
