//! Stability margins of a loop that is cut at a signal.
//!
//! At the cut a test signal d is added: what reads the signal sees `sent = returned + d`. The closed loop answers with
//! `returned = E d`, so the open loop is `L = -returned/sent = -E/(1 + E)` and the sensitivity `S = sent/d = 1/(1 + L)`: both
//! are known where the plant alone, or the loop when it is open, is unstable. The sign is that of negative feedback: -1 is
//! critical (Åström and Murray, Feedback Systems, ch. 10).
//!
//! The curve of L is refined until it turns little from point to point, beginning with the poles of the open and the closed
//! loop; crossovers are then found as roots between two points. In a sampled loop d is a sequence of its clock, and L is the
//! exact discrete response.

mod crossover;
mod curve;
mod cut_loop;

use crate::linearize::Linear;
use hyde_program::{Cut, Program};
use nalgebra::Complex;

pub use crossover::{GainCrossover, PhaseCrossover};
pub use cut_loop::CutError;

/// A loop that is cut at a signal.
#[derive(Clone, Debug)]
pub struct Margins {
    /// The period in s by which the signal is sampled; `None` of a continuous signal.
    pub period_s: Option<f64>,
    /// The band that was searched, in Hz.
    pub band_hz: (f64, f64),
    /// Something comes back: the signal is in a loop.
    pub in_loop: bool,
    /// Frequencies in Hz, ascending, with the open loop L.
    pub open_loop: Vec<(f64, Complex<f64>)>,
    /// Where |L| is 1.
    pub gain_crossovers: Vec<GainCrossover>,
    /// Where L is real and negative.
    pub phase_crossovers: Vec<PhaseCrossover>,
    /// The largest |1/(1 + L)| and its frequency in Hz.
    pub sensitivity_peak: (f64, f64),
    /// The largest |L/(1 + L)| and its frequency in Hz.
    pub complementary_peak: (f64, f64),
    /// |L| where the frequency ends, at infinity or half the sampling rate.
    pub last_gain: f64,
}

/// How much longer a loop may take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DelayMargin {
    /// Any time: the loop gain is below 1 everywhere.
    Any,
    /// Up to this time in s, where it ends at a frequency in Hz.
    UpTo(f64, f64),
    /// None at all: at high frequencies the loop gain does not fall below 1. Of a sampled loop: not one period.
    Nothing,
}

impl Margins {
    /// The factor by which the gain may grow, and the frequency in Hz at which the loop is then at its limit.
    #[must_use]
    pub fn gain_margin(&self) -> Option<(f64, f64)> {
        let above = self.phase_crossovers.iter().filter(|c| c.gain < 1.0);
        let nearest = above.max_by(|a, b| a.gain.total_cmp(&b.gain))?;
        Some((1.0 / nearest.gain, nearest.frequency_hz))
    }

    /// The factor to which the gain may fall, and the frequency in Hz at which the loop is then at its limit.
    #[must_use]
    pub fn gain_reduction(&self) -> Option<(f64, f64)> {
        let below = self.phase_crossovers.iter().filter(|c| c.gain > 1.0);
        let nearest = below.min_by(|a, b| a.gain.total_cmp(&b.gain))?;
        Some((1.0 / nearest.gain, nearest.frequency_hz))
    }

    /// The angle in rad by which the loop may turn, and the frequency in Hz where: of all gain crossovers the smallest.
    #[must_use]
    pub fn phase_margin(&self) -> Option<(f64, f64)> {
        let size = |c: &&GainCrossover| c.phase_margin.abs();
        let all = self.gain_crossovers.iter();
        let least = all.min_by(|a, b| size(a).total_cmp(&size(b)))?;
        Some((least.phase_margin, least.frequency_hz))
    }

    /// The delay that the loop bears besides its own.
    #[must_use]
    pub fn delay_margin(&self) -> DelayMargin {
        if self.last_gain >= 1.0 {
            return DelayMargin::Nothing;
        }
        let all = self.gain_crossovers.iter();
        let least = all.min_by(|a, b| a.delay_s.total_cmp(&b.delay_s));
        least.map_or(DelayMargin::Any, |c| {
            DelayMargin::UpTo(c.delay_s, c.frequency_hz)
        })
    }
}

/// The margins of a loop that a program cuts, of its system linearised with the test signal as the one input; in a band in
/// Hz, or that of the loop's poles.
///
/// # Errors
/// There is no open loop at the signal.
pub fn margins(
    program: &Program,
    linear: &Linear,
    cut: &Cut,
    band: Option<(f64, f64)>,
) -> Result<Margins, CutError> {
    let cut_loop = cut_loop::CutLoop::new(program, linear, cut)?;
    let curve = curve::Curve::of(&cut_loop, band)?;
    let (gain_crossovers, phase_crossovers) = crossover::crossovers(&cut_loop, &curve)?;
    let peak = |of: fn(Complex<f64>) -> f64| curve.peak(&cut_loop, of);
    Ok(Margins {
        period_s: cut_loop.period_s(),
        band_hz: curve.band_hz,
        in_loop: curve
            .points
            .iter()
            .any(|(_, l)| l.norm() > cut_loop::NOTHING),
        gain_crossovers,
        phase_crossovers,
        sensitivity_peak: peak(|l| 1.0 / (l + 1.0).norm())?,
        complementary_peak: peak(|l| (l / (l + 1.0)).norm())?,
        last_gain: curve.last_gain,
        open_loop: curve.points,
    })
}
