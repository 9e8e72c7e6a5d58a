//! A relay with a width drives what it looks at to and fro between its two switching points.

use super::solved::solve;

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
