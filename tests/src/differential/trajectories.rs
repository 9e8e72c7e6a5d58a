//! Runs of one model side by side: bit by bit, or within a bound around a reference.

use hyde_program::{Method, Program};
use hyde_sim::{Results, Setup, simulate};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// How far an event may be from its place in the reference, in s: a jump there is no disagreement.
const SHIFT: f64 = 2e-5;
/// Columns whose values all are smaller, or a smaller part of the largest of their unit, are nought but for rounding: forces of
/// a body at rest cancel. Loose tolerances leave more of them, a thousandth of the bound.
const NOTHING: f64 = 1e-7;
/// How much farther than a state a rate or a force may be: the tolerance of a step is for the states, which stiff parts
/// multiply.
const NO_STATE: f64 = 30.0;

/// How a run is made: the method, its tolerances, and where it ends, in s.
#[derive(Clone, Copy, Debug)]
pub(super) struct How {
    pub(super) method: Method,
    pub(super) rtol: f64,
    pub(super) atol: f64,
    pub(super) stop_s: f64,
}

/// A run with thirty rows.
///
/// # Errors
/// Why there is none.
pub(super) fn run(program: &Program, how: How) -> Result<Results, String> {
    let records = BTreeMap::new();
    let p = hyde_experiment::parameters(program, &records, &[])
        .map_err(|error| format!("{error:?}"))?;
    let mut setup = Setup::new(p, &records, how.stop_s);
    (setup.method, setup.rtol, setup.atol) = (how.method, how.rtol, how.atol);
    // Not at the round times at which things are switched and clocks tick.
    let rows = (0..30).map(|k| how.stop_s * (f64::from(k) + 0.37) / 30.0);
    setup.rows_s = [0.0].into_iter().chain(rows).collect();
    simulate(program, &setup).map_err(|failure| format!("{:?} at {} s", failure.kind, failure.t))
}

/// The first number in which two runs differ, however little.
pub(super) fn first_difference(program: &Program, a: &Results, b: &Results) -> Option<String> {
    if a.time != b.time {
        let first = a
            .time
            .iter()
            .zip(&b.time)
            .find(|(a, b)| a.to_bits() != b.to_bits());
        return Some(format!("rows at other times, first {first:?}"));
    }
    for ((number, a_column), (_, b_column)) in a.kept().zip(b.kept()) {
        for ((t, x), y) in a.time.iter().zip(a_column.iter()).zip(b_column.iter()) {
            if x.to_bits() != y.to_bits() && !(x.is_nan() && y.is_nan()) {
                let name = &program.outputs[number].name;
                return Some(format!("{name} at {t} s: {x:e} and {y:e}"));
            }
        }
    }
    None
}

/// The numbers of the rows from one time to another.
fn rows(results: &Results, from: f64, to: f64) -> Range<usize> {
    let from = results.time.partition_point(|&time| time < from);
    from..results.time.partition_point(|&time| time <= to)
}

fn largest(column: &[f64]) -> f64 {
    let sizes = column.iter().map(|value| value.abs());
    sizes.fold(0.0, f64::max)
}

/// The value that is farthest outside a bound around the reference, as a part of the largest of its column. Names of the
/// columns of `other` go through `renamed`.
pub(super) fn outside(
    (program, reference): (&Program, &Results),
    (other_program, other): (&Program, &Results),
    bound: f64,
) -> Option<String> {
    let mut worst: Option<(f64, String)> = None;
    let differential = program.differential(&reference.last.1);
    let states: BTreeSet<String> = (0..program.n_unknowns)
        .filter(|&unknown| differential[unknown])
        .map(|unknown| program.unknown_name(unknown))
        .collect();
    for (number, column) in reference.kept() {
        let column = column.values();
        let name = &program.outputs[number].name;
        let twin = name.replace('[', "_").replace(']', "");
        let found = other_program
            .outputs
            .iter()
            .position(|output| output.name == *name || output.name == twin);
        let Some(found) = found else {
            continue;
        };
        let Some(others) = other.column(found) else {
            continue;
        };
        let of_its_kind = program.outputs[number].dimension;
        let alike = reference.kept();
        let alike = alike.filter(|(other, _)| program.outputs[*other].dimension == of_its_kind);
        let most = alike.fold(0.0, |most: f64, (_, column)| {
            most.max(largest(&column.values()))
        });
        let size = Some(largest(&column)).filter(|own| *own > NOTHING * most);
        let size = size.unwrap_or(most);
        let part = if states.contains(name) {
            bound
        } else {
            NO_STATE * bound
        };
        let allowed = part * size + NOTHING.max(1e-3 * bound);
        for &t in reference.time.iter() {
            let Some((first, last)) = other.rows_at(t) else {
                continue;
            };
            // Rows of the reference near this instant, events among them.
            let near = &column[rows(reference, t - SHIFT, t + SHIFT)];
            let low = near.iter().fold(f64::INFINITY, |a, &b| a.min(b));
            let high = near.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b));
            let all_known = near.iter().all(|value| value.is_finite());
            // What was or comes so soon before or after it is a jump, whatever it is meanwhile.
            for near in [
                rows(other, t - SHIFT, t).start..first + 1,
                last..rows(other, t, t + SHIFT).end,
            ] {
                let values = &others[near];
                let off = |value: &f64| (low - value).max(value - high);
                let nearest = values.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
                let value = nearest.copied().unwrap_or(f64::NAN);
                let off = off(&value);
                let wrong = all_known != value.is_finite() || off > allowed;
                let times = off / allowed;
                if wrong && worst.as_ref().is_none_or(|(most, _)| times > *most) {
                    let text = format!(
                        "{name} at {t} s: {value:e}, reference {low:e} .. {high:e}, largest {size:e}, off {:e} of it, allowed {part:e}",
                        off / size
                    );
                    worst = Some((times, text));
                }
            }
        }
    }
    worst.map(|(_, text)| text)
}
