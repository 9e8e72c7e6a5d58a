//! Where the curve of an open loop crosses the unit circle and the negative real axis.

use super::curve::{Curve, GAINS};
use super::cut_loop::{CutError, CutLoop};
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// Steps of a search for a root.
const STEPS: usize = 80;
/// A root is known to this part of its frequency.
const EXACT: f64 = 1e-13;

/// The loop gain is 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainCrossover {
    /// In Hz.
    pub frequency_hz: f64,
    /// 180 degrees plus the phase of L there, in rad, from -pi to pi.
    pub phase_margin: f64,
    /// The delay in s that turns L to -1 there.
    pub delay_s: f64,
}

/// The open loop is real and negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseCrossover {
    /// In Hz; 0 or infinite where it is the end of the curve.
    pub frequency_hz: f64,
    /// |L| there.
    pub gain: f64,
}

pub(super) fn crossovers(
    cut: &CutLoop<'_>,
    curve: &Curve,
) -> Result<(Vec<GainCrossover>, Vec<PhaseCrossover>), CutError> {
    let (mut gains, mut phases) = (Vec::new(), Vec::new());
    phases.extend(at_rest(curve).filter(|c| GAINS.contains(&c.gain)));
    for pair in curve.points.windows(2) {
        let ends = (pair[0], pair[1]);
        let both = |test: fn(Complex<f64>) -> f64| test(ends.0.1) * test(ends.1.1) < 0.0;
        if both(|l| l.norm().ln()) {
            let (f, l) = root(cut, ends, |l| l.norm().ln())?;
            let phase_margin = (-l).arg();
            // Where L is -1 already, any delay is too much.
            let lag = if phase_margin < 0.0 {
                phase_margin + TAU
            } else {
                phase_margin
            };
            gains.push(GainCrossover {
                frequency_hz: f,
                phase_margin,
                delay_s: lag / (TAU * f),
            });
        }
        // At a pole on the axis L changes its sign as well: there it is too large.
        if both(|l| l.im) && ends.0.1.re.min(ends.1.1.re) < 0.0 {
            let (f, l) = root(cut, ends, |l| l.im)?;
            if l.re < 0.0 && GAINS.contains(&l.norm()) {
                phases.push(PhaseCrossover {
                    frequency_hz: f,
                    gain: l.norm(),
                });
            }
        }
    }
    phases.extend(at_the_end(cut, curve).filter(|c| GAINS.contains(&c.gain)));
    Ok((gains, phases))
}

/// A static gain that is negative: the curve begins on the negative axis.
fn at_rest(curve: &Curve) -> impl Iterator<Item = PhaseCrossover> {
    let first = curve.points.first().zip(curve.points.get(1));
    let found = first.filter(|((_, l), (_, next))| {
        let flat = (l - next).norm() < 1e-2 * l.norm();
        flat && l.re < 0.0 && (PI - l.arg().abs()) < 1e-2
    });
    found
        .map(|((_, l), _)| PhaseCrossover {
            frequency_hz: 0.0,
            gain: l.norm(),
        })
        .into_iter()
}

/// The response at half the sampling rate is real, and that at infinite frequency.
fn at_the_end(cut: &CutLoop<'_>, curve: &Curve) -> impl Iterator<Item = PhaseCrossover> {
    let end = match cut.at_infinity() {
        Some(l) => Some((f64::INFINITY, l)),
        None => curve
            .points
            .last()
            .filter(|(_, l)| cut.period_s().is_some() && l.im == 0.0)
            .map(|(f, l)| (*f, l.re)),
    };
    let negative = end.filter(|(_, l)| *l < 0.0);
    negative
        .map(|(frequency_hz, l)| PhaseCrossover {
            frequency_hz,
            gain: l.abs(),
        })
        .into_iter()
}

/// The frequency in Hz between two points where something of L is 0, and L there: secants that are kept within the bracket
/// (Illinois: Dowell and Jarratt, BIT 11 (1971) 168).
fn root(
    cut: &CutLoop<'_>,
    (mut low, mut high): ((f64, Complex<f64>), (f64, Complex<f64>)),
    of: fn(Complex<f64>) -> f64,
) -> Result<(f64, Complex<f64>), CutError> {
    let (mut at_low, mut at_high) = (of(low.1), of(high.1));
    for _ in 0..STEPS {
        if high.0 - low.0 <= EXACT * high.0 {
            break;
        }
        let part = at_low / (at_low - at_high);
        let f = low.0 + part.clamp(0.01, 0.99) * (high.0 - low.0);
        let l = cut.open(&[f])?[0];
        let value = of(l);
        if value == 0.0 {
            return Ok((f, l));
        }
        if value * at_low < 0.0 {
            (high, at_high) = ((f, l), value);
            at_low *= 0.5;
        } else {
            (low, at_low) = ((f, l), value);
            at_high *= 0.5;
        }
    }
    Ok(if at_low.abs() < at_high.abs() {
        low
    } else {
        high
    })
}
