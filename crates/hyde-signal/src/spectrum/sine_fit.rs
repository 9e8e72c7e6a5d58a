//! The response at single frequencies, by fitting sines.

use super::{FrequencyResponse, SpectrumError, check_pair};
use realfft::num_complex::Complex;
use std::f64::consts::PI;

/// The response of `output` to `input` at each of the frequencies, from samples at the instants `time` (s).
///
/// At each frequency a sine, a constant and a slope are fitted to both signals by least squares; the response is the
/// quotient of the two sines. This is one line of the Fourier transform with the drift taken out, and needs neither
/// equal spacing nor whole periods (IEEE Std 1057, the three-parameter fit, here with a slope). It is exact for a
/// steady sine on a drift. The squares are weighted with a Hann window, so that other sines, harmonics and the lines of
/// a multisine, do not leak in if they are two periods of the record away or more. The coherence given is the share of
/// the output's weighted variance about its drift that the sine explains: near 1 for a single sine.
///
/// # Errors
/// If the lengths differ, there are fewer than 5 samples, the last instant is not after the first, or a frequency has
/// less than a period in the record or is at or above half the mean sampling rate.
pub fn response_at(
    frequencies_hz: &[f64],
    time: &[f64],
    input: &[f64],
    output: &[f64],
) -> Result<FrequencyResponse, SpectrumError> {
    let duration = time.last().unwrap_or(&0.0) - time.first().unwrap_or(&0.0);
    let rate_hz = time.len().saturating_sub(1) as f64 / duration;
    check_pair(time, input, MIN_SAMPLES, rate_hz)?;
    check_pair(input, output, MIN_SAMPLES, rate_hz)?;
    // Rows of a whole period lack the last instant: their duration is one step short of it.
    let (lowest_hz, highest_hz) = (rate_hz / (rate_hz * duration + 1.0), rate_hz / 2.0);
    let mut result = FrequencyResponse {
        frequency_hz: vec![],
        response: vec![],
        coherence: vec![],
    };
    for &frequency_hz in frequencies_hz {
        // A little below, because the duration of a drifting clock is not exact.
        if !(frequency_hz > 0.999 * lowest_hz && frequency_hz < highest_hz) {
            return Err(SpectrumError::Frequency {
                frequency_hz,
                lowest_hz,
                highest_hz,
            });
        }
        let fit = SineFit::new(frequency_hz, time);
        let (input, _) = fit.amplitude(input);
        let (output, explained) = fit.amplitude(output);
        result.frequency_hz.push(frequency_hz);
        result.response.push(output / input);
        result.coherence.push(explained);
    }
    Ok(result)
}

/// The amplitudes of the harmonics 2 to 10 together over that of the fundamental (IEC 61000-4-7, total harmonic
/// distortion), each fitted as [`response_at`] does it. Harmonics at or above half the mean sampling rate are left out.
///
/// # Errors
/// As of [`response_at`], for the fundamental.
pub fn harmonic_distortion(
    frequency_hz: f64,
    time: &[f64],
    values: &[f64],
) -> Result<f64, SpectrumError> {
    response_at(&[frequency_hz], time, values, values)?;
    let duration = time[time.len() - 1] - time[0];
    let highest_hz = 0.5 * (time.len() - 1) as f64 / duration;
    let fundamental = SineFit::new(frequency_hz, time);
    let rest = fundamental.without(values);
    let amplitude = |order: u32| {
        let frequency_hz = f64::from(order) * frequency_hz;
        let below = frequency_hz < highest_hz;
        below.then(|| SineFit::new(frequency_hz, time).amplitude(&rest).0.norm())
    };
    let harmonics = (2..=10).filter_map(amplitude);
    let together = harmonics
        .map(|harmonic| harmonic * harmonic)
        .sum::<f64>()
        .sqrt();
    Ok(together / fundamental.amplitude(values).0.norm())
}

const MIN_SAMPLES: usize = 5;

/// Orthonormal sequences that span a constant, a slope, cosine and sine, in this order, all of them weighted.
struct SineFit {
    weight: Vec<f64>,
    basis: Vec<Vec<f64>>,
    /// Cosine and sine in terms of the last two of the basis: `cos = .. + c0 q2`, `sin = .. + s0 q2 + s1 q3`.
    cosine: f64,
    sine: [f64; 2],
}

impl SineFit {
    fn new(frequency_hz: f64, time: &[f64]) -> Self {
        let middle = 0.5 * (time[0] + time[time.len() - 1]);
        let angle = |t: &f64| 2.0 * PI * frequency_hz * (t - middle);
        let weight = root_of_hann(time);
        let spanning: [Vec<f64>; 4] = [
            vec![1.0; time.len()],
            time.iter().map(|t| t - middle).collect(),
            time.iter().map(|t| angle(t).cos()).collect(),
            time.iter().map(|t| angle(t).sin()).collect(),
        ];
        let mut basis: Vec<Vec<f64>> = Vec::with_capacity(spanning.len());
        let along = spanning.map(|vector| {
            let mut vector = product(&vector, &weight);
            let mut along = [0.0; 4];
            // Twice is enough for orthogonality to rounding (Giraud and others, Numer. Math. 101 (2005) 87).
            for _ in 0..2 {
                for (along, direction) in along.iter_mut().zip(&basis) {
                    *along += remove(direction, &mut vector);
                }
            }
            let length = dot(&vector, &vector).sqrt();
            along[basis.len()] = length;
            vector.iter_mut().for_each(|value| *value /= length);
            basis.push(vector);
            along
        });
        let [_, _, cosine, sine] = along;
        Self {
            weight,
            basis,
            cosine: cosine[2],
            sine: [sine[2], sine[3]],
        }
    }

    /// The complex amplitude of the fitted sine, `Re(A exp(i w t))` with t from the middle of the record, and the share
    /// of the variance about the drift that it explains.
    fn amplitude(&self, values: &[f64]) -> (Complex<f64>, f64) {
        let mut rest = product(values, &self.weight);
        let (drift, sines) = self.basis.split_at(2);
        for direction in drift {
            remove(direction, &mut rest);
        }
        let variance = dot(&rest, &rest);
        let (q2, q3) = (dot(&sines[0], &rest), dot(&sines[1], &rest));
        let sine = q3 / self.sine[1];
        let cosine = (q2 - self.sine[0] * sine) / self.cosine;
        (Complex::new(cosine, -sine), (q2 * q2 + q3 * q3) / variance)
    }

    /// What the fit leaves of the values: without drift and sine.
    fn without(&self, values: &[f64]) -> Vec<f64> {
        let mut rest = product(values, &self.weight);
        for direction in &self.basis {
            remove(direction, &mut rest);
        }
        let unweighted = rest.iter().zip(&self.weight);
        unweighted.map(|(rest, weight)| rest / weight).collect()
    }
}

/// The square root of a Hann window over the record, half a mean step longer at both ends: zero at no sample.
fn root_of_hann(time: &[f64]) -> Vec<f64> {
    let (start, end) = (time[0], time[time.len() - 1]);
    let step = (end - start) / (time.len() - 1) as f64;
    time.iter()
        .map(|t| (PI * (t - start + 0.5 * step) / (end - start + step)).sin())
        .collect()
}

fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

/// Takes the part along a unit vector out of `values`, and says how long it was.
fn remove(direction: &[f64], values: &mut [f64]) -> f64 {
    let along = dot(direction, values);
    for (value, direction) in values.iter_mut().zip(direction) {
        *value -= along * direction;
    }
    along
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
