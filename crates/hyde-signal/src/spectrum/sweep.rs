//! The response from one sweep, with the whole record as one segment.

use super::welch::frequencies;
use super::{CrossPower, FrequencyResponse, SpectrumError, check_pair, transform};
use realfft::RealFftPlanner;
use std::f64::consts::PI;

/// The response of `output` to `input` over one swept sine, samples `dt` (s) apart.
///
/// The straight line through both signals is taken out, the first and last 2 % are faded with a cosine, and H1 is
/// formed at every line of the whole record from the sums over the `2 * neighbours + 1` lines round it (Bendat and
/// Piersol, Random Data, 4th ed. 2010: frequency smoothing). More neighbours, less noise and a coarser
/// resolution of `(2 * neighbours + 1) / duration`; with none the coherence is 1 and means nothing. Only the lines that
/// the sweep excited are any good: see [`FrequencyResponse::between`]. The record should begin and end at rest, else
/// the cut transient is in the result.
///
/// # Errors
/// If the lengths differ, there are fewer than 16 samples, or `dt` is not positive.
pub fn swept_response(
    input: &[f64],
    output: &[f64],
    dt: f64,
    neighbours: usize,
) -> Result<FrequencyResponse, SpectrumError> {
    let rate_hz = 1.0 / dt;
    check_pair(input, output, 16, rate_hz)?;
    let mut planner = RealFftPlanner::new();
    let inputs = transform(&mut planner, prepared(input));
    let outputs = transform(&mut planner, prepared(output));
    let lines: Vec<_> = inputs
        .into_iter()
        .zip(outputs)
        .map(|(u, y)| CrossPower::of(u, y))
        .collect();
    let smooth: Vec<_> = (0..lines.len())
        .map(|line| sum_round(&lines, line, neighbours))
        .collect();
    Ok(FrequencyResponse {
        frequency_hz: frequencies(input.len(), rate_hz),
        response: smooth.iter().map(CrossPower::response).collect(),
        coherence: smooth.iter().map(CrossPower::coherence).collect(),
    })
}

/// The sum over a line and as many neighbours on either side as there are on both: never lopsided.
fn sum_round(lines: &[CrossPower], line: usize, neighbours: usize) -> CrossPower {
    let reach = neighbours.min(line).min(lines.len() - 1 - line);
    let mut sum = CrossPower::default();
    for &power in &lines[line - reach..=line + reach] {
        sum.add(power);
    }
    sum
}

/// Without its straight line (least squares), faded in and out.
fn prepared(values: &[f64]) -> Vec<f64> {
    let position = |k: usize| k as f64 - 0.5 * (values.len() - 1) as f64;
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let moment: f64 = values
        .iter()
        .enumerate()
        .map(|(k, value)| position(k) * value)
        .sum();
    let inertia: f64 = (0..values.len()).map(|k| position(k) * position(k)).sum();
    let slope = moment / inertia;
    let fade = values.len() / 50;
    let weight = |k: usize| {
        let edge = k.min(values.len() - 1 - k);
        let phase = PI * (edge as f64 + 0.5) / fade.max(1) as f64;
        if edge < fade {
            0.5 - 0.5 * phase.cos()
        } else {
            1.0
        }
    };
    let detrended = values
        .iter()
        .enumerate()
        .map(|(k, value)| value - mean - slope * position(k));
    detrended
        .enumerate()
        .map(|(k, value)| value * weight(k))
        .collect()
}
