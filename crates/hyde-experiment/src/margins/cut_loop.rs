//! The open loop at a cut, one frequency after the other: continuous, or from tick to tick.

use crate::bode::{BodeError, frequency_response};
use crate::common_period::CommonPeriod;
use crate::linearize::Linear;
use crate::modes::{balanced, eigenvalues};
use hyde_program::{Cut, Program};
use nalgebra::{Complex, DMatrix};

/// What is below this is rounding.
pub(super) const NOTHING: f64 = 1e-12;
/// Responses that differ by less are the same.
const SAME: f64 = 1e-7;

/// Why there is no open loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CutError {
    /// A continuous signal in a loop that clocks close.
    SampledLoop,
    /// A clocked signal in a loop that a slower clock closes: its response differs from tick to tick.
    SlowerClock,
    /// The equation of the signal does not determine it, but something that it reads.
    Reversed,
    /// A clocked signal that nothing holds.
    NotHeld,
    /// The band of frequencies is empty.
    EmptyBand,
    /// The loop is singular at a frequency in Hz.
    Singular(f64),
}

/// A loop that is cut.
pub(super) struct CutLoop<'a> {
    kind: Kind<'a>,
}

enum Kind<'a> {
    /// The system with what clocks hold as it is, and the number of the output that reports what comes back.
    Continuous(Box<Linear>, usize),
    /// The ticks of a clock, by its place in the order of clocks, and the row of the signal in its memory.
    Sampled(CommonPeriod<'a>, usize, DMatrix<f64>, f64),
}

impl<'a> CutLoop<'a> {
    pub(super) fn new(program: &Program, linear: &'a Linear, cut: &Cut) -> Result<Self, CutError> {
        let Some(clock) = cut.clock else {
            return Self::continuous(linear, cut.back);
        };
        let sampled = linear.sampled.as_ref().ok_or(CutError::NotHeld)?;
        let order = program.clock_order.iter().position(|&known| known == clock);
        let order = order.ok_or(CutError::NotHeld)?;
        let row = sampled.outputs.rows(cut.back, 1).into_owned();
        let period = CommonPeriod::new(linear, sampled).ok_or(CutError::NotHeld)?;
        let period_s = sampled.clocks[order].period;
        let found = Self {
            kind: Kind::Sampled(period, order, row, period_s),
        };
        // A loop that is the same at every tick answers a sine with a sine.
        for part in [0.013, 0.17, 0.41] {
            found.returned(&[part / period_s])?;
        }
        Ok(found)
    }

    fn continuous(linear: &Linear, back: usize) -> Result<Self, CutError> {
        let held = Linear {
            sampled: None,
            ..linear.clone()
        };
        if linear.delayed.is_none() && (linear.d_input[(back, 0)] + 1.0).abs() < NOTHING {
            return Err(CutError::Reversed);
        }
        if let Some(sampled) = &linear.sampled {
            let longest = sampled.clocks.iter().map(|c| c.period).fold(0.0, f64::max);
            let some: Vec<f64> = [0.013, 0.17, 0.41].map(|part| part / longest).to_vec();
            let with = response(linear, back, &some)?;
            let without = response(&held, back, &some)?;
            let same = |(a, b): (&Complex<f64>, &Complex<f64>)| (a - b).norm() <= SAME * b.norm();
            if !with.iter().zip(&without).all(same) {
                return Err(CutError::SampledLoop);
            }
        }
        Ok(Self {
            kind: Kind::Continuous(Box::new(held), back),
        })
    }

    /// The sampling period of the signal in s.
    pub(super) fn period_s(&self) -> Option<f64> {
        match &self.kind {
            Kind::Continuous(..) => None,
            Kind::Sampled(.., period_s) => Some(*period_s),
        }
    }

    /// The open loop at frequencies in Hz.
    pub(super) fn open(&self, frequencies_hz: &[f64]) -> Result<Vec<Complex<f64>>, CutError> {
        let closed = self.returned(frequencies_hz)?;
        Ok(closed.into_iter().map(|e| -e / (e + 1.0)).collect())
    }

    /// The open loop at infinite frequency, where there is one.
    pub(super) fn at_infinity(&self) -> Option<f64> {
        match &self.kind {
            Kind::Continuous(linear, back) if linear.delayed.is_none() => {
                let e = linear.d_input[(*back, 0)];
                Some(-e / (1.0 + e))
            }
            Kind::Continuous(..) | Kind::Sampled(..) => None,
        }
    }

    /// What comes back for a test signal of 1, the loop closed.
    fn returned(&self, frequencies_hz: &[f64]) -> Result<Vec<Complex<f64>>, CutError> {
        match &self.kind {
            Kind::Continuous(linear, back) => response(linear, *back, frequencies_hz),
            Kind::Sampled(period, clock, row, _) => {
                let mut found = Vec::with_capacity(frequencies_hz.len());
                for &f in frequencies_hz {
                    let s = Complex::new(0.0, std::f64::consts::TAU * f);
                    let ticks = period.at_ticks(0, *clock, row, s);
                    let ticks = ticks.ok_or(CutError::Singular(f))?;
                    let first = ticks[0];
                    if ticks
                        .iter()
                        .any(|other| (other - first).norm() > SAME * first.norm())
                    {
                        return Err(CutError::SlowerClock);
                    }
                    // The signal itself has the test signal in it.
                    found.push(first - 1.0);
                }
                Ok(found)
            }
        }
    }

    /// Poles of the loop, closed and open, in rad/s: where the curve may turn.
    pub(super) fn poles(&self) -> Vec<Complex<f64>> {
        match &self.kind {
            Kind::Continuous(linear, back) => {
                let e = linear.d_input[(*back, 0)];
                let (b, c) = (linear.b_input.column(0), linear.c.row(*back));
                let opened = &linear.a - b * c / (1.0 + e);
                let mut all = balanced_eigenvalues(&linear.a);
                all.extend(balanced_eigenvalues(&opened));
                let times = linear.delayed.iter().flat_map(|delayed| &delayed.times);
                all.extend(times.map(|time| Complex::new(1.0 / time, 0.0)));
                all
            }
            Kind::Sampled(period, _, _, own) => {
                let common = period.period_s();
                let closed = balanced_eigenvalues(&period.transition());
                let inside = closed.into_iter().filter(|z| z.norm() > NOTHING);
                let slow: Vec<Complex<f64>> = inside.map(|z| z.ln() / common).collect();
                // Frequencies are known but for multiples of the common rate.
                let turns = (0.5 * common / own).ceil() as usize;
                let turn = std::f64::consts::TAU / common;
                let turned = |s: &Complex<f64>| {
                    let s = *s;
                    (0..=turns).map(move |k| s + Complex::new(0.0, k as f64 * turn))
                };
                slow.iter().flat_map(turned).collect()
            }
        }
    }
}

fn response(
    linear: &Linear,
    back: usize,
    frequencies_hz: &[f64],
) -> Result<Vec<Complex<f64>>, CutError> {
    let found = frequency_response(linear, 0, &[back], frequencies_hz);
    match found {
        Ok(mut lists) => Ok(lists.pop().unwrap_or_default()),
        Err(BodeError::Singular(f) | BodeError::AboveNyquist(f, _)) => Err(CutError::Singular(f)),
    }
}

fn balanced_eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    eigenvalues(&balanced(matrix).0)
}
