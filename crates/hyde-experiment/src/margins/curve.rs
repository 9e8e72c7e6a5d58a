//! The curve of an open loop, with points where it turns.

use super::cut_loop::{CutError, CutLoop};
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Points a decade to begin with.
const A_DECADE: f64 = 40.0;
/// How far the band goes beyond the poles of the loop, as a factor.
const BEYOND: f64 = 100.0;
/// From point to point the curve turns by less, in rad, and grows by less, as a logarithm.
const TURN: f64 = 0.1;
/// Outside of these gains it is not looked at more closely, and has no phase crossovers.
pub(super) const GAINS: std::ops::Range<f64> = 1e-5..1e5;
/// The curve is refined this often, and up to so many points.
const ROUNDS: usize = 40;
const MOST_POINTS: usize = 20_000;
/// Neighbours are not closer than this, as a part of the frequency.
const CLOSEST: f64 = 1e-10;

/// The curve.
pub(super) struct Curve {
    pub(super) band_hz: (f64, f64),
    /// Frequencies in Hz, ascending, with the open loop.
    pub(super) points: Vec<(f64, Complex<f64>)>,
    /// |L| where the frequency ends.
    pub(super) last_gain: f64,
}

impl Curve {
    pub(super) fn of(cut: &CutLoop<'_>, band: Option<(f64, f64)>) -> Result<Self, CutError> {
        let poles = cut.poles();
        let limit = cut.period_s().map_or(f64::INFINITY, |period| 0.5 / period);
        let (from, to) = match band {
            Some((from, to)) => (from, to.min(limit)),
            None => around(&poles, limit),
        };
        if !(from > 0.0 && to > from) {
            return Err(CutError::EmptyBand);
        }
        let mut seeds = Vec::new();
        let count = (A_DECADE * (to / from).log10()).ceil().max(1.0);
        let mut k = 0.0;
        while k <= count {
            seeds.push(from * (to / from).powf(k / count));
            k += 1.0;
        }
        for pole in &poles {
            // A lightly damped pole, and a zero beside it, are seen within some of its widths.
            for widths in [-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0] {
                seeds.push((pole.im.abs() + widths * pole.re) / TAU);
            }
            seeds.push(pole.norm() / TAU);
        }
        seeds.retain(|f| (from..=to).contains(f));
        seeds.sort_by(f64::total_cmp);
        seeds.dedup_by(|a, b| *a <= *b * (1.0 + CLOSEST));
        let open = cut.open(&seeds)?;
        let mut points: Vec<(f64, Complex<f64>)> = seeds.into_iter().zip(open).collect();
        for _ in 0..ROUNDS {
            let between: Vec<f64> = points
                .windows(2)
                .filter(|pair| turns(pair[0], pair[1]))
                .map(|pair| (pair[0].0 * pair[1].0).sqrt())
                .collect();
            if between.is_empty() || points.len() > MOST_POINTS {
                break;
            }
            let open = cut.open(&between)?;
            points.extend(between.into_iter().zip(open));
            points.sort_by(|a, b| a.0.total_cmp(&b.0));
        }
        // At half the rate every response is real.
        if let Some((f, l)) = points.last_mut()
            && *f >= limit * (1.0 - CLOSEST)
        {
            l.im = 0.0;
        }
        let last = points.last().map_or(0.0, |(_, l)| l.norm());
        let last_gain = cut.at_infinity().map_or(last, f64::abs);
        Ok(Self {
            band_hz: (from, to),
            points,
            last_gain,
        })
    }

    /// The largest value of something along the curve, and its frequency in Hz: refined between neighbours by the golden
    /// section.
    pub(super) fn peak(
        &self,
        cut: &CutLoop<'_>,
        of: fn(Complex<f64>) -> f64,
    ) -> Result<(f64, f64), CutError> {
        let values = self.points.iter().map(|(_, l)| of(*l));
        let found = values.enumerate().filter(|(_, value)| value.is_finite());
        let Some((at, best)) = found.max_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Ok((0.0, self.band_hz.0));
        };
        let frequency = |at: usize| self.points[at.min(self.points.len() - 1)].0;
        let (mut low, mut high) = (frequency(at.saturating_sub(1)), frequency(at + 1));
        let part = 0.5 * (5.0_f64.sqrt() - 1.0);
        let value = |f: f64| cut.open(&[f]).map(|l| of(l[0]));
        let (mut a, mut b) = (high - part * (high - low), low + part * (high - low));
        let (mut at_a, mut at_b) = (value(a)?, value(b)?);
        while high - low > 1e-9 * high {
            if at_a > at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - part * (high - low);
                at_a = value(a)?;
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + part * (high - low);
                at_b = value(b)?;
            }
        }
        let inside = if at_a > at_b { (at_a, a) } else { (at_b, b) };
        let on_grid = (best, frequency(at));
        Ok(if inside.0 > on_grid.0 {
            inside
        } else {
            on_grid
        })
    }
}

/// The band from below the slowest pole to above the fastest, in Hz, or to the limit.
fn around(poles: &[Complex<f64>], limit: f64) -> (f64, f64) {
    let sizes = poles.iter().map(|pole| pole.norm() / TAU);
    let largest = sizes.clone().fold(0.0, f64::max);
    let moving = sizes.filter(|size| *size > 1e-8 * largest);
    let least = moving.fold(f64::INFINITY, f64::min);
    let (least, largest) = match (least.is_finite(), limit.is_finite()) {
        (true, _) => (least, largest),
        (false, true) => (limit, limit),
        (false, false) => (1.0, 1.0),
    };
    (least.min(limit) / BEYOND, (BEYOND * largest).min(limit))
}

/// Whether the curve turns between two points so much that something may lie between them.
fn turns((f, l): (f64, Complex<f64>), (g, m): (f64, Complex<f64>)) -> bool {
    let outside = |l: Complex<f64>| !GAINS.contains(&l.norm());
    if g <= f * (1.0 + CLOSEST) || (outside(l) && outside(m)) {
        return false;
    }
    let ratio = m / l;
    let near = (m - l).norm() > TURN * (l + 1.0).norm().min((m + 1.0).norm());
    ratio.arg().abs() > TURN || ratio.norm().ln().abs() > 2.0 * TURN || near
}
