//! Frequency responses from records of input and output, and the spectrum of a signal.
//!
//! Which estimate is right depends on how the input was made:
//!
//! * [`welch_response`]: broadband noise, or any long stationary record. Many averaged segments; the resolution is
//!   the rate over the segment length, and a resonance narrower than a few of those is flattened.
//! * [`periodic_response`]: a multisine over several whole periods without its first ones; [`period`] finds how long they
//!   are. Exact at the excited lines, and the periods tell how much of it is noise.
//! * [`response_at`]: steps of single sines. Exact for a steady sine; it knows nothing of transients, so cut them off.
//!   The instants need not be equally spaced.
//! * [`swept_response`]: one sweep from rest to rest. The whole record is one segment, so that what the resonance
//!   rings after the sweep has passed it counts; neighbouring lines are averaged instead.
//!
//! What is not linear in a steady sine is told by [`harmonic_distortion`].
//!
//! All but that of a multisine are the estimate H1, which is unbiased if the noise is on the output alone. In a closed
//! loop the noise is on the input too: take the responses of both to the injected signal, and divide them with
//! [`FrequencyResponse::over`] (the joint input-output estimate; Pintelon and Schoukens, System Identification, 2nd ed.
//! 2012, chapter 2).

mod periodic;
mod sine_fit;
mod strongest;
mod sweep;
mod welch;

pub use periodic::{PeriodicResponse, period, periodic_response};
pub use realfft::num_complex::Complex;
pub use sine_fit::{harmonic_distortion, response_at};
pub use strongest::strongest_frequency;
pub use sweep::swept_response;
pub use welch::{power_spectral_density, welch_response};

use realfft::RealFftPlanner;
use std::fmt;

/// The response of an output to an input at some frequencies; the three vectors have one length.
#[derive(Clone, Debug, PartialEq)]
pub struct FrequencyResponse {
    /// Frequencies in Hz, rising.
    pub frequency_hz: Vec<f64>,
    /// Output over input; a positive phase leads.
    pub response: Vec<Complex<f64>>,
    /// The share of the output's power that is linear in the input, 0 to 1.
    pub coherence: Vec<f64>,
}

/// Why a spectrum cannot be estimated.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumError {
    /// Sequences that belong together have different lengths.
    UnequalLength {
        /// The lengths.
        lengths: (usize, usize),
    },
    /// There are fewer samples than the estimate needs.
    TooShort {
        /// The samples there are.
        samples: usize,
        /// The samples there must be at least.
        needed: usize,
    },
    /// The sampling rate is not a positive number.
    Rate {
        /// The rate in Hz.
        rate_hz: f64,
    },
    /// A frequency is below one period in the record or not below half the sampling rate.
    Frequency {
        /// The frequency in Hz.
        frequency_hz: f64,
        /// One over the duration of the record, in Hz.
        lowest_hz: f64,
        /// Half the mean sampling rate, in Hz.
        highest_hz: f64,
    },
}

impl FrequencyResponse {
    /// This response over another one to the same input: from `r` to `y` over from `r` to `u` is from `u` to `y`.
    ///
    /// The coherence is the product of both, an estimate of how far the quotient can be trusted.
    ///
    /// # Panics
    /// If the two are not at the same number of frequencies.
    #[must_use]
    pub fn over(&self, input: &Self) -> Self {
        assert_eq!(
            self.response.len(),
            input.response.len(),
            "both are at the same frequencies"
        );
        let pairs = || self.response.iter().zip(&input.response);
        let coherences = self.coherence.iter().zip(&input.coherence);
        Self {
            frequency_hz: self.frequency_hz.clone(),
            response: pairs().map(|(output, input)| output / input).collect(),
            coherence: coherences.map(|(a, b)| a * b).collect(),
        }
    }

    /// The lines from `low_hz` to `high_hz`, both included: those that were excited.
    #[must_use]
    pub fn between(&self, low_hz: f64, high_hz: f64) -> Self {
        let first = self.frequency_hz.partition_point(|&f| f < low_hz);
        let end = self
            .frequency_hz
            .partition_point(|&f| f <= high_hz)
            .max(first);
        Self {
            frequency_hz: self.frequency_hz[first..end].to_vec(),
            response: self.response[first..end].to_vec(),
            coherence: self.coherence[first..end].to_vec(),
        }
    }
}

impl fmt::Display for SpectrumError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnequalLength { lengths: (a, b) } => {
                write!(f, "sequences of {a} and {b} samples do not belong together")
            }
            Self::TooShort { samples, needed } => {
                write!(f, "{samples} samples are too few, {needed} are needed")
            }
            Self::Rate { rate_hz } => write!(f, "a sampling rate of {rate_hz} Hz is not positive"),
            Self::Frequency {
                frequency_hz,
                lowest_hz,
                highest_hz,
            } => {
                write!(
                    f,
                    "{frequency_hz} Hz is not between {lowest_hz} and {highest_hz} Hz, what the record can show"
                )
            }
        }
    }
}

impl std::error::Error for SpectrumError {}

/// Sums of products of the lines of input and output, from which H1 and the coherence follow.
#[derive(Clone, Copy, Debug, Default)]
struct CrossPower {
    input: f64,
    output: f64,
    cross: Complex<f64>,
}

impl CrossPower {
    fn of(input: Complex<f64>, output: Complex<f64>) -> Self {
        Self {
            input: input.norm_sqr(),
            output: output.norm_sqr(),
            cross: input.conj() * output,
        }
    }

    fn add(&mut self, other: Self) {
        self.input += other.input;
        self.output += other.output;
        self.cross += other.cross;
    }

    /// H1, output over input; NaN where there is no input.
    fn response(&self) -> Complex<f64> {
        self.cross / self.input
    }

    /// NaN where there is no input or no output.
    fn coherence(&self) -> f64 {
        self.cross.norm_sqr() / (self.input * self.output)
    }
}

/// The spectrum of a real sequence at `k * rate / n`, k from 0 to n/2.
fn transform(planner: &mut RealFftPlanner<f64>, mut values: Vec<f64>) -> Vec<Complex<f64>> {
    let plan = planner.plan_fft_forward(values.len());
    let mut lines = plan.make_output_vec();
    // The lengths are those the plan asks for, so there is nothing to fail.
    let done = plan.process(&mut values, &mut lines);
    debug_assert!(done.is_ok(), "the transform has the lengths of its plan");
    lines
}

fn check_pair(
    input: &[f64],
    output: &[f64],
    needed: usize,
    rate_hz: f64,
) -> Result<(), SpectrumError> {
    if input.len() != output.len() {
        return Err(SpectrumError::UnequalLength {
            lengths: (input.len(), output.len()),
        });
    }
    if input.len() < needed {
        return Err(SpectrumError::TooShort {
            samples: input.len(),
            needed,
        });
    }
    if !(rate_hz > 0.0 && rate_hz.is_finite()) {
        return Err(SpectrumError::Rate { rate_hz });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
