//! [`multisine`]: sines at all lines of a band, whole periods, faded in and out.

use super::crest::{Spectrum, low_crest};
use super::limits::{Bounds, Impossible};
use std::f64::consts::TAU;

/// Whole periods in a record, if it is long enough.
const PERIODS: usize = 2;

/// A multisine over the samples of a record.
pub(super) struct Multisine {
    pub(super) samples: Vec<f64>,
    /// Crest factor within a period.
    pub(super) crest: f64,
    /// Its first line and their number.
    pub(super) first: usize,
    pub(super) lines: usize,
    /// Samples of a period.
    pub(super) period: usize,
}

/// Sines at all lines of a band, each as large as its limits let it be.
pub(super) fn multisine(
    bounds: &Bounds,
    (from_hz, to_hz): (f64, f64),
    rows: usize,
    step_s: f64,
) -> Result<Multisine, Impossible> {
    let duration_s = (rows - 1) as f64 * step_s;
    let fade_s = (1.0 / from_hz).min(0.1 * duration_s);
    let whole_s = duration_s - 2.0 * fade_s;
    // Two periods show what is noise; where the band begins too low for two, one has to do.
    // A period is at least as long as the lowest line, and has a line in the band.
    let coarsest_hz = from_hz.min(to_hz - from_hz);
    let of = |periods: usize| (whole_s / step_s / periods as f64 + 1e-9).floor() as usize;
    let enough = |period: &usize| *period as f64 * step_s * coarsest_hz >= 1.0;
    let period = Some(of(PERIODS)).filter(enough).unwrap_or_else(|| of(1));
    let length_s = period as f64 * step_s;
    // A tenth at each end fades.
    let needed_s = 1.25 / coarsest_hz + 3.0 * step_s;
    if length_s * from_hz < 1.0 - 1e-9 {
        return Err(Impossible::Low { from_hz, needed_s });
    }
    let first = ((from_hz * length_s - 1e-9).ceil() as usize).max(1);
    let last = ((to_hz * length_s + 1e-9).floor() as usize).min((period - 1) / 2);
    if last < first {
        return Err(Impossible::Narrow { needed_s });
    }
    let sizes: Vec<f64> = (first..=last)
        .map(|line| match bounds {
            Bounds::Motion(limits) => limits.sine(TAU * line as f64 / length_s),
            Bounds::Effort(peak) => *peak,
        })
        .collect();
    let spectrum = Spectrum {
        first,
        sizes,
        period,
        step_s,
    };
    let (values, crest) = low_crest(&spectrum, bounds);
    let fade = fade_s / duration_s;
    let begin = (fade_s / step_s).round() as usize % period;
    let at = |row: usize| {
        let along = row as f64 / (rows - 1) as f64;
        values[(row + period - begin) % period] * window(along, fade)
    };
    Ok(Multisine {
        samples: (0..rows).map(at).collect(),
        crest,
        first,
        lines: last + 1 - first,
        period,
    })
}

/// From 0 to 1 over a part of the record at its begin, and back at its end.
pub(super) fn window(along: f64, fade: f64) -> f64 {
    step(along / fade) * step((1.0 - along) / fade)
}

/// From 0 to 1, three times continuously differentiable.
pub(super) fn step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t.powi(4) * (35.0 + t * (-84.0 + t * (70.0 - 20.0 * t)))
}
