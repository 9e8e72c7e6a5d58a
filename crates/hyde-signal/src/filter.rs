//! Low-pass filtering without phase, and numerical derivatives.

use std::f64::consts::PI;
use std::fmt;

/// A digital Butterworth low-pass filter, as a cascade of sections of order two and at most one of order one.
///
/// Designed from the analogue prototype by the bilinear transform with the corner prewarped, so that the gain at the
/// corner is exactly 1/sqrt(2) (Oppenheim and Schafer, Discrete-Time Signal Processing, chapter 7).
#[derive(Clone, Debug, PartialEq)]
pub struct LowPass {
    sections: Vec<Section>,
    order: usize,
}

/// Why a filter cannot be designed or applied.
#[derive(Clone, Debug, PartialEq)]
pub enum FilterError {
    /// The order is not from 1 to 20.
    Order {
        /// The order.
        order: usize,
    },
    /// The corner is not above 0 and below half the sampling rate.
    Corner {
        /// The corner frequency in Hz.
        corner_hz: f64,
        /// The sampling rate in Hz.
        rate_hz: f64,
    },
    /// There are too few samples to extend them at both ends.
    TooShort {
        /// The samples there are.
        samples: usize,
        /// The samples there must be at least.
        needed: usize,
    },
}

/// `y = b0 u + z0`, `z0 = b1 u - a1 y + z1`, `z1 = b2 u - a2 y`, with a gain of 1 at frequency 0.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl LowPass {
    /// A Butterworth low-pass of the order given, with its corner at `corner_hz` for samples at `rate_hz`.
    ///
    /// # Errors
    /// If the order is not from 1 to 20, or the corner not between 0 and half the rate.
    pub fn butterworth(order: usize, corner_hz: f64, rate_hz: f64) -> Result<Self, FilterError> {
        if !(1..=20).contains(&order) {
            return Err(FilterError::Order { order });
        }
        if !(corner_hz > 0.0 && corner_hz < rate_hz / 2.0 && rate_hz.is_finite()) {
            return Err(FilterError::Corner { corner_hz, rate_hz });
        }
        let warped = (PI * corner_hz / rate_hz).tan();
        let mut sections: Vec<_> = (0..order / 2)
            .map(|pair| {
                let angle = PI * (2 * pair + 1) as f64 / (2 * order) as f64;
                Section::second_order(warped, 2.0 * angle.sin())
            })
            .collect();
        if order % 2 == 1 {
            sections.push(Section::first_order(warped));
        }
        Ok(Self { sections, order })
    }

    /// Filters equally spaced values forwards and then backwards: no phase, twice the attenuation (1/2 at the corner).
    ///
    /// The ends are treated as `scipy.signal.filtfilt` does by default: the values are extended at both ends by
    /// `3 * (order + 1)` samples reflected through the end point, and each pass starts in the steady state of its
    /// first value (Gustafsson, IEEE Trans. Signal Processing 44 (1996) 988, describes the alternatives). In exact
    /// arithmetic the result is that of `filtfilt` and of `sosfiltfilt`; the sections keep it accurate for low corners,
    /// where the polynomials of `filtfilt` do not.
    ///
    /// # Errors
    /// If there are not more samples than the extension has.
    pub fn zero_phase(&self, values: &[f64]) -> Result<Vec<f64>, FilterError> {
        let pad = 3 * (self.order + 1);
        if values.len() <= pad {
            return Err(FilterError::TooShort {
                samples: values.len(),
                needed: pad + 1,
            });
        }
        let mut extended = extend_oddly(values, pad);
        self.pass(&mut extended);
        extended.reverse();
        self.pass(&mut extended);
        extended.reverse();
        extended.truncate(pad + values.len());
        Ok(extended.split_off(pad))
    }

    /// Filters equally spaced values forwards, starting in the steady state of the first: what a real filter shows.
    #[must_use]
    pub fn causal(&self, values: &[f64]) -> Vec<f64> {
        let mut filtered = values.to_vec();
        self.pass(&mut filtered);
        filtered
    }

    fn pass(&self, values: &mut [f64]) {
        for section in &self.sections {
            section.pass(values);
        }
    }
}

impl Section {
    /// The bilinear transform of `1 / (s^2 + damping s + 1)`, s over the corner frequency.
    fn second_order(warped: f64, damping: f64) -> Self {
        let square = warped * warped;
        let scale = 1.0 / (1.0 + damping * warped + square);
        let b0 = square * scale;
        let a1 = 2.0 * (square - 1.0) * scale;
        let a2 = (1.0 - damping * warped + square) * scale;
        Self {
            b: [b0, 2.0 * b0, b0],
            a: [a1, a2],
        }
    }

    /// The bilinear transform of `1 / (s + 1)`, s over the corner frequency.
    fn first_order(warped: f64) -> Self {
        let b0 = warped / (1.0 + warped);
        Self {
            b: [b0, b0, 0.0],
            a: [(warped - 1.0) / (warped + 1.0), 0.0],
        }
    }

    fn pass(&self, values: &mut [f64]) {
        let Self { b, a } = self;
        let start = values.first().copied().unwrap_or(0.0);
        // The steady state of a constant: output and input are equal.
        let mut z = [(1.0 - b[0]) * start, (b[2] - a[1]) * start];
        for value in values {
            let input = *value;
            let output = b[0] * input + z[0];
            z = [
                b[1] * input - a[0] * output + z[1],
                b[2] * input - a[1] * output,
            ];
            *value = output;
        }
    }
}

/// The derivative of equally spaced values, `dt` (s) apart: central differences inside, one-sided ones at both ends.
///
/// As `numpy.gradient` with `edge_order=1`: error of order `dt^2` inside and `dt` at the ends. Fewer than two values
/// have the derivative 0.
#[must_use]
pub fn central_difference(values: &[f64], dt: f64) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    let slope = |row: usize| match row {
        _ if last == 0 => 0.0,
        0 => (values[1] - values[0]) / dt,
        _ if row == last => (values[last] - values[last - 1]) / dt,
        _ => (values[row + 1] - values[row - 1]) / (2.0 * dt),
    };
    (0..values.len()).map(slope).collect()
}

impl fmt::Display for FilterError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Order { order } => write!(f, "a filter of order {order} is not from 1 to 20"),
            Self::Corner { corner_hz, rate_hz } => {
                let half = rate_hz / 2.0;
                write!(
                    f,
                    "a corner of {corner_hz} Hz is not between 0 and {half} Hz, half the sampling rate"
                )
            }
            Self::TooShort { samples, needed } => {
                write!(
                    f,
                    "{samples} samples are too few to filter, {needed} are needed"
                )
            }
        }
    }
}

impl std::error::Error for FilterError {}

/// `pad` samples before and after, reflected through the first and the last value.
fn extend_oddly(values: &[f64], pad: usize) -> Vec<f64> {
    let (first, last) = (values[0], values[values.len() - 1]);
    let before = values[1..=pad]
        .iter()
        .rev()
        .map(|value| 2.0 * first - value);
    let after = values[values.len() - 1 - pad..values.len() - 1]
        .iter()
        .rev();
    before
        .chain(values.iter().copied())
        .chain(after.map(|value| 2.0 * last - value))
        .collect()
}

#[cfg(test)]
mod tests;
