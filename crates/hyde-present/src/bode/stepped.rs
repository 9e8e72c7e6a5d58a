//! What came out of a stepped sine.

use super::{drawn, seen};
use crate::summary;
use hyde_experiment::SteppedPoint;
use hyde_program::Program;
use hyde_study::responses::Response;
use hyde_units::{Dimension, NamedUnit, engineering_as, engineering_difference, significant};
use std::fmt::Write as _;

/// A table an output, then the measures from the least to the most, and the expectations with the frequencies at which
/// they do not hold.
pub(super) fn told(
    program: &Program,
    input: &str,
    responses: &[Response],
    points: &[SteppedPoint],
) -> String {
    let mut text = String::new();
    let amplitude = program.parameter(&format!("{input}.amplitude"));
    let number = NamedUnit::usual(Dimension::DIMENSIONLESS);
    let unit = amplitude.map_or(&number, |(parameter, _)| &parameter.unit);
    for response in responses {
        let (per, factor) = drawn(response);
        if !per.is_empty() {
            let (output, unit) = (&response.output, &per);
            let _ = writeln!(text, "  {output} in dB re 1 {unit}");
        }
        let _ = writeln!(
            text,
            "  {:<12} {:>12} {:>9} {:>8} {:>10} {:>11}",
            response.output, input, "dB", "°", "coherence", "distortion"
        );
        for (f, amplitude, found) in &response.stepped {
            let start = format!(
                "  {:>9} Hz {:>12}",
                significant(*f, 4),
                engineering_difference(*amplitude, unit)
            );
            let norm = factor * found.response.norm();
            let _ = if norm > 0.0 {
                writeln!(
                    text,
                    "{start} {:>9.2} {:>8.1} {:>10.4} {:>9.2} %",
                    20.0 * norm.log10(),
                    found.response.arg().to_degrees(),
                    found.coherence,
                    100.0 * found.distortion
                )
            } else {
                let none = if norm.is_nan() {
                    "unknown"
                } else {
                    "does not move"
                };
                writeln!(text, "{start}   {none}")
            };
        }
    }
    for response in responses {
        let apart = seen::stepped_apart(response);
        let _ = writeln!(text, "  {}: stepped is {apart}", response.output);
    }
    for (number, measure) in program.experiment.measures.iter().enumerate() {
        let values = || points.iter().map(|point| &point.measures[number]);
        if measure.expectation {
            let fails: Vec<String> = points
                .iter()
                .filter(|point| !point.measures[number].holds)
                .map(|point| format!("{} Hz", significant(point.frequency_hz, 4)))
                .collect();
            let verdict = if fails.is_empty() {
                format!("holds at all {} frequencies", points.len())
            } else {
                format!("DOES NOT HOLD at {}", fails.join(", "))
            };
            let _ = writeln!(text, "  expect {}: {verdict}", measure.name);
        } else if let Some(point) = points
            .iter()
            .find(|point| point.measures[number].missing.is_some())
        {
            let why = summary::why_missing(&point.measures[number]);
            let at = significant(point.frequency_hz, 4);
            let _ = writeln!(text, "  {}: no value at {at} Hz{why}", measure.name);
        } else {
            let least = values()
                .map(|value| value.value)
                .fold(f64::INFINITY, f64::min);
            let most = values()
                .map(|value| value.value)
                .fold(f64::NEG_INFINITY, f64::max);
            let of = |value| engineering_as(value, &measure.unit);
            let _ = writeln!(text, "  {} = {} .. {}", measure.name, of(least), of(most));
        }
    }
    text
}
