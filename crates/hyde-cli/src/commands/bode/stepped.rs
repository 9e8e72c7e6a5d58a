//! The stepped sine of an experiment: planned, run, told.

use super::response::{Response, band, frequencies};
use super::{seen, watch};
use crate::args::ModelArgs;
use crate::exit::Exit;
use crate::interruption::interrupted;
use crate::project::{Aim, Project, Told as _, complain};
use hyde_experiment::{Level, Options, SteppedPoint, Steps, parameters, stepped_response};
use hyde_present::summary;
use hyde_program::{Constant, Program};
use hyde_study::run_failure;
use hyde_study::settings::Setting;
use hyde_units::{Dimension, NamedUnit, engineering_as, engineering_difference, significant};
use std::fmt::Write as _;

/// Runs the response of that number; puts what came out beside the linearised responses, and tells it. Whether every
/// expectation held at every frequency comes with it.
pub(crate) fn measured(
    args: &ModelArgs,
    project: &mut Project,
    number: usize,
    responses: &mut [Response],
) -> Result<(String, bool), Exit> {
    let Some(input) = responses.first().map(|response| response.input.clone()) else {
        return Ok((String::new(), true));
    };
    // Which frequency does not matter here: a run sets its own.
    let hertz = NamedUnit::usual(Dimension::FREQUENCY);
    let frequency = Setting::of(format!("{input}.frequency"), 1.0, Some(hertz));
    project.settings.push(frequency);
    let compiled = project.compile(Aim::Run);
    project.settings.pop();
    let compiled = compiled.inspect_err(|_| {
        project.finish_with_errors(args);
    })?;
    let program = &compiled.program;
    let wrong = |reason: &str| complain(args, Exit::Model, reason);
    let tables = hyde_study::tables(&project.records);
    let p = parameters(program, &tables, &project.set())
        .map_err(|error| project.report_refused(args, program, &error))?;
    let steps = steps(program, number, &p).ok_or_else(|| {
        wrong(
            "`by stepped` needs a positive amplitude, two points or more, and two periods or more",
        )
    })?;
    let options = Options {
        set: project.set(),
        interrupted: interrupted(),
        ..Options::default()
    };
    let bode = &program.experiment.bodes[number];
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let watch = watch(args, &options.reached);
    let points = stepped_response(program, &tables, &options, bode, &steps, threads);
    drop(watch);
    let points = match points {
        Ok(points) => points,
        Err(error) => {
            let (diagnostic, fault) = run_failure::diagnostic(&error, program, None);
            project.diagnostics.push(diagnostic);
            project.finish_with_errors(args);
            return Err(fault.into());
        }
    };
    for (output, response) in responses.iter_mut().enumerate() {
        let of =
            |point: &SteppedPoint| (point.frequency_hz, point.amplitude, point.outputs[output]);
        response.stepped = points.iter().map(of).collect();
    }
    Ok(told(program, &input, responses, &points))
}

/// What the experiment says of its steps; `None` where that makes no sense.
fn steps(program: &Program, number: usize, p: &[f64]) -> Option<Steps> {
    let constant = |which| program.kernels.constant(which, p);
    let bode = &program.experiment.bodes[number];
    let amplitude = constant(Constant::Amplitude(number))?;
    let (points, periods) = (
        constant(Constant::Points(number))?,
        constant(Constant::Periods(number))?,
    );
    let settle_s = constant(Constant::Settle(number))?;
    let sound = amplitude > 0.0 && (2.0..1e4).contains(&points) && (2.0..1e4).contains(&periods);
    let level = match bode.stepped?.keep {
        None => None,
        Some(output) => {
            let most = constant(Constant::Level(number))?;
            Some(Level { output, most })
        }
    };
    let sound = sound && settle_s >= 0.0 && level.is_none_or(|level| level.most > 0.0);
    sound.then_some(Steps {
        frequencies_hz: frequencies(band(program, number, p)?, points.round() as usize),
        amplitude,
        settle_s,
        periods: periods.round() as u32,
        level,
    })
}

/// A table an output, then the measures from the least to the most, and the expectations with the frequencies at which
/// they do not hold.
fn told(
    program: &Program,
    input: &str,
    responses: &[Response],
    points: &[SteppedPoint],
) -> (String, bool) {
    let mut text = String::new();
    let amplitude = program.parameter(&format!("{input}.amplitude"));
    let number = NamedUnit::usual(Dimension::DIMENSIONLESS);
    let unit = amplitude.map_or(&number, |(parameter, _)| &parameter.unit);
    for response in responses {
        if !response.unit.is_empty() {
            let (output, unit) = (&response.output, &response.unit);
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
            let norm = response.factor * found.response.norm();
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
    let mut all = true;
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
            all &= fails.is_empty();
            let _ = writeln!(text, "  expect {}: {verdict}", measure.name);
        } else if let Some(point) = points
            .iter()
            .find(|point| point.measures[number].missing.is_some())
        {
            let why = summary::why_missing(&point.measures[number]);
            let at = significant(point.frequency_hz, 4);
            all &= point.measures[number].holds;
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
    (text, all)
}
