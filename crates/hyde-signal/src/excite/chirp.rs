//! [`chirp`]: one sine whose frequency rises through a band by equal ratios in equal times.

use super::limits::Bounds;
use super::multisine::window;
use std::f64::consts::TAU;

/// The part of the record over which it fades in, and out.
const FADE: f64 = 0.05;

/// A sine through a band, each frequency as large as its limits let it be, over so many samples.
pub(super) fn chirp(
    bounds: &Bounds,
    (from_hz, to_hz): (f64, f64),
    rows: usize,
    step_s: f64,
) -> Vec<f64> {
    let duration_s = (rows - 1) as f64 * step_s;
    let ratio = (to_hz / from_hz).ln();
    let fade = (FADE * duration_s).max(0.5 / from_hz).min(0.4 * duration_s) / duration_s;
    let at = |row: usize| {
        let along = row as f64 / (rows - 1) as f64;
        let grown = (ratio * along).exp();
        let angle = TAU * from_hz * duration_s * (grown - 1.0) / ratio;
        let size = match bounds {
            Bounds::Motion(limits) => limits.sine(TAU * from_hz * grown),
            Bounds::Effort(peak) => *peak,
        };
        size * window(along, fade) * angle.sin()
    };
    (0..rows).map(at).collect()
}
