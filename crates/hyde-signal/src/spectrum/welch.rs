//! Welch's method: spectra averaged over segments that overlap by half.

use super::{CrossPower, FrequencyResponse, SpectrumError, check_pair, transform};
use crate::statistics::mean;
use realfft::RealFftPlanner;
use std::f64::consts::PI;

/// The response of `output` to a broadband `input`, by H1 = S_uy / S_uu, and their coherence.
///
/// Segments of `segment` samples (never fewer than 4), each without its mean, under a periodic Hann window, overlapping
/// by half; what is left at the end is not used. As `scipy.signal.csd` over `welch` and `coherence` with the same segment
/// (Welch, IEEE Trans. Audio Electroacoustics 15 (1967) 70). With a single segment the coherence is 1 and means nothing.
///
/// # Errors
/// If the lengths differ, there are fewer samples than a segment has, or the rate is not positive.
pub fn welch_response(
    input: &[f64],
    output: &[f64],
    rate_hz: f64,
    segment: usize,
) -> Result<FrequencyResponse, SpectrumError> {
    check_pair(input, output, segment.max(4), rate_hz)?;
    let segment = segment.max(4);
    let window = hann(segment);
    let mut planner = RealFftPlanner::new();
    let mut power = vec![CrossPower::default(); segment / 2 + 1];
    for start in starts(input.len(), segment) {
        let range = start..start + segment;
        let input = transform(&mut planner, windowed(&input[range.clone()], &window));
        let output = transform(&mut planner, windowed(&output[range], &window));
        for (sum, (input, output)) in power.iter_mut().zip(input.into_iter().zip(output)) {
            sum.add(CrossPower::of(input, output));
        }
    }
    Ok(FrequencyResponse {
        frequency_hz: frequencies(segment, rate_hz),
        response: power.iter().map(CrossPower::response).collect(),
        coherence: power.iter().map(CrossPower::coherence).collect(),
    })
}

/// The one-sided power spectral density of a signal: frequencies in Hz, and the unit of the signal squared per Hz.
///
/// Segments as in [`welch_response`]. The sum times the line spacing is the mean square of the signal about the means
/// of its segments. As `scipy.signal.welch` with the same segment.
///
/// # Errors
/// If there are fewer samples than a segment has, or the rate is not positive.
pub fn power_spectral_density(
    values: &[f64],
    rate_hz: f64,
    segment: usize,
) -> Result<(Vec<f64>, Vec<f64>), SpectrumError> {
    check_pair(values, values, segment.max(4), rate_hz)?;
    let segment = segment.max(4);
    let window = hann(segment);
    let mut planner = RealFftPlanner::new();
    let mut density = vec![0.0; segment / 2 + 1];
    let mut segments = 0.0;
    for start in starts(values.len(), segment) {
        segments += 1.0;
        let lines = transform(
            &mut planner,
            windowed(&values[start..start + segment], &window),
        );
        for (sum, line) in density.iter_mut().zip(lines) {
            *sum += line.norm_sqr();
        }
    }
    let energy: f64 = window.iter().map(|weight| weight * weight).sum();
    for (line, density) in density.iter_mut().enumerate() {
        // Lines between 0 and half the rate stand for their mirror image too.
        let sides = if line == 0 || 2 * line == segment {
            1.0
        } else {
            2.0
        };
        *density *= sides / (rate_hz * energy * segments);
    }
    Ok((frequencies(segment, rate_hz), density))
}

/// The frequencies in Hz of the lines of a transform of `samples` values.
pub(super) fn frequencies(samples: usize, rate_hz: f64) -> Vec<f64> {
    (0..=samples / 2)
        .map(|line| line as f64 * rate_hz / samples as f64)
        .collect()
}

fn starts(samples: usize, segment: usize) -> impl Iterator<Item = usize> {
    (0..=samples - segment).step_by(segment - segment / 2)
}

fn hann(samples: usize) -> Vec<f64> {
    let angle = |k: usize| 2.0 * PI * k as f64 / samples as f64;
    (0..samples).map(|k| 0.5 - 0.5 * angle(k).cos()).collect()
}

fn windowed(values: &[f64], window: &[f64]) -> Vec<f64> {
    let mean = mean(values);
    values
        .iter()
        .zip(window)
        .map(|(value, weight)| (value - mean) * weight)
        .collect()
}
