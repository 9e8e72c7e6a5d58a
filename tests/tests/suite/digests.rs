//! What every example does in its first tenths of a second: where its states end, and what happened in which order.
//!
//! Trajectories are never kept. A value is printed to six digits of the largest the signal had, so that what is zero up
//! to rounding prints as zero. The runs are short and their tolerance is tight: nothing in them amplifies rounding to
//! the digits printed.

use crate::examples;
use crate::points::parameters;
use hyde_compiler::{Backend, Compiled};
use hyde_experiment::{Options, Run};
use hyde_program::Constant;
use hyde_sim::EventKind;
use hyde_tests::Example;
use std::fmt::Write as _;

/// Runs end here at the latest, in s, or soon behind the first rows where those are not compared.
const LONGEST_S: f64 = 0.4;

/// More events than this are counted and not listed.
const LISTED: usize = 60;

#[test]
fn every_example_responds_as_it_did() {
    for case in examples::all() {
        let options = Options {
            stop_s: Some(stop_s(&case.example)),
            rtol: Some(1e-9),
            atol: Some(1e-12),
            ..Options::default()
        };
        let run = case.example.run_with(&options);
        let (compiled, run) = run.unwrap_or_else(|error| panic!("{}: {error}", case.name));
        let name = format!("{}.response", case.name);
        insta::with_settings!({
            snapshot_path => "../../snapshots",
            prepend_module_to_snapshot => false,
            omit_expression => true,
        }, {
            insta::assert_snapshot!(name, digest(&compiled, &run));
        });
    }
}

/// Most of the experiment's own time where that is shorter.
fn stop_s(example: &Example) -> f64 {
    let program = example.compile(Backend::Native).unwrap().program;
    let p = parameters(&program, &[]);
    let own = program.kernels.constant(Constant::Stop, &p);
    let skip = program.kernels.constant(Constant::Skip, &p).unwrap_or(0.0);
    // An end that a record says is not known here.
    let own = own.filter(|own| *own > 0.0);
    own.map_or(LONGEST_S.max(skip + 0.1), |own| LONGEST_S.min(0.9 * own))
}

fn digest(compiled: &Compiled, run: &Run) -> String {
    let program = &compiled.program;
    let results = &run.results;
    let mut out = format!("at {} s\n\n", run.stop_s);
    for (number, output) in program.outputs.iter().enumerate() {
        let Some(values) = results.column(number) else {
            continue;
        };
        let Some(&last) = values.last() else { continue };
        // Of a field its two ends.
        let next = program.outputs.get(number + 1);
        let of_array = output.name.contains('[');
        let end = !output.name.ends_with("[0]")
            && next.is_some_and(|next| array(&next.name) == array(&output.name));
        if output.auxiliary || (of_array && end) {
            continue;
        }
        let value = to_digits(last, largest(&values), 6);
        let unit = output.dimension.usual_unit();
        let unit = if unit == "1" { "" } else { &unit };
        let _ = writeln!(out, "{} = {value} {unit}", output.name);
    }
    for channel in &run.channels {
        // An error is small against the signal; its digits are fewer.
        let scale = channel
            .measured
            .iter()
            .fold(0.0, |m: f64, v| m.max(v.abs()));
        let _ = writeln!(
            out,
            "rms of {} measured - simulated = {}",
            channel.name,
            to_digits(channel.rms, scale, 6)
        );
    }
    let _ = writeln!(out, "\n{} events", results.events.len());
    for event in results.events.iter().take(LISTED) {
        let what = match event.kind {
            EventKind::Transition {
                automaton,
                from,
                to,
            } => {
                let automaton = &program.automata[automaton];
                let (from, to) = (&automaton.modes[from], &automaton.modes[to]);
                format!("{}: {from} -> {to}", automaton.name)
            }
            EventKind::When => "when".to_owned(),
            EventKind::Relation(truth) => format!("if: {truth}"),
            EventKind::Slide { before, after, .. } => format!("slide: {before:?} -> {after:?}"),
        };
        let t = to_digits(event.t, event.t, 6);
        let _ = writeln!(out, "{t:>10} s  {what}, {}", event.cause);
    }
    out
}

/// `th` of `th[3]`.
fn array(name: &str) -> &str {
    name.split('[').next().unwrap_or(name)
}

fn largest(values: &[f64]) -> f64 {
    values
        .iter()
        .fold(0.0, |largest, value| largest.max(value.abs()))
}

/// A value to so many digits of a scale.
fn to_digits(value: f64, scale: f64, digits: i32) -> String {
    if scale == 0.0 {
        return "0".to_owned();
    }
    let last = scale.log10().floor() as i32 + 1 - digits;
    let step = 10_f64.powi(last);
    let rounded = (value / step).round();
    if rounded == 0.0 {
        return "0".to_owned();
    }
    if (-12..=0).contains(&last) {
        let decimals = usize::try_from(-last).unwrap();
        return format!("{:.decimals$}", value);
    }
    format!("{:e}", rounded * step)
}
