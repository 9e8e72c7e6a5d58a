//! The response from one sweep, with the whole record as one segment.

use super::welch::frequencies;
use super::{CrossPower, FrequencyResponse, SpectrumError, check_pair, transform};
use realfft::RealFftPlanner;
use std::f64::consts::PI;

/// The response of `output` to `input` over one swept sine, samples `dt` (s) apart.
///
/// The straight line through both signals is taken out, they are taken to stay at their first sample for 2 % of their time
/// before it, these 2 % and the last ones are faded with a cosine, and H1 is formed at every line of the whole from the sums over the `2 * neighbours + 1` lines round it (Bendat and
/// Piersol, Random Data, 4th ed. 2010: frequency smoothing). More neighbours, less noise and a coarser
/// resolution of `(2 * neighbours + 1) / duration`; with none the coherence is 1 and means nothing. Only the lines that
/// the sweep excited are any good: see [`FrequencyResponse::between`]. The record should begin and end at rest, else
/// the cut transient is in the result. What it begins with is not faded: a sweep passes its first frequencies only there,
/// and an output is late by more than a fade allows for.
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
    let samples = input.len() + input.len() / FADED;
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
        frequency_hz: frequencies(samples, rate_hz),
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

/// The part of a record before its first sample, and at its end, that is faded: one of so many.
const FADED: usize = 50;

/// Without its straight line (least squares), with what was before, faded in and out.
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
    let fade = values.len() / FADED;
    let before = std::iter::repeat_n(0, fade);
    let rows: Vec<usize> = before.chain(0..values.len()).collect();
    let weight = |place: usize| {
        let edge = place.min(rows.len() - 1 - place);
        let phase = PI * (edge as f64 + 0.5) / fade.max(1) as f64;
        if edge < fade {
            0.5 - 0.5 * phase.cos()
        } else {
            1.0
        }
    };
    let detrended = |k: usize| values[k] - mean - slope * position(k);
    let all = rows.iter().enumerate();
    all.map(|(place, &k)| detrended(k) * weight(place))
        .collect()
}
