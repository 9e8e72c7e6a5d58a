//! What stands in the equation at which a run failed: its unknowns and rates with their values, the part that each has in it,
//! and by how much its sides differ; and what the condition reads at which it did.

use crate::failure::{Failure, FailureKind, Reading};
use crate::moment::At;
use crate::state::State;
use hyde_program::{Function, Wrt};

/// Terms that are told at most, the largest first.
const MOST: usize = 6;
/// Sides that differ by less than this part of the largest term are equal to rounding.
const ROUNDING: f64 = 1e-9;

/// Tells what stands in the equation of a row at a point. `left` is by how much its sides differed where the solver gave
/// up; without it, it is that of the point.
pub(crate) fn with_equation(
    mut failure: Box<Failure>,
    state: &mut State<'_>,
    at: At<'_>,
    row: usize,
    left: Option<f64>,
) -> Box<Failure> {
    let program = state.program;
    let mut out = vec![0.0; program.n_unknowns];
    let mut residual = |at: At<'_>| {
        state.evaluate(Function::Residual, at, &mut out);
        out.get(row).copied().unwrap_or(f64::NAN)
    };
    let here = residual(at);
    let mut terms: Vec<Reading> = Vec::new();
    let entries = program.partials(Function::Residual).iter();
    for entry in entries.filter(|entry| entry.row == row) {
        let (column, is_rate) = match entry.wrt {
            Wrt::Unknown(column) => (column, false),
            Wrt::Derivative(column) => (column, true),
            Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => continue,
        };
        let mut changed = at.to_moment();
        let values = match is_rate {
            true => &mut changed.yp,
            false => &mut changed.y,
        };
        let value = std::mem::replace(&mut values[column], 0.0);
        let name = program.unknown_name(column);
        if terms
            .iter()
            .all(|own| own.name != name || own.is_rate != is_rate)
        {
            terms.push(Reading {
                part: here - residual(changed.at()),
                name,
                is_rate,
                value,
            });
        }
    }
    let size = |part: f64| {
        if part.is_finite() {
            part.abs()
        } else {
            f64::MAX
        }
    };
    terms.sort_by(|a, b| size(b.part).total_cmp(&size(a.part)));
    let largest = terms.iter().map(|own| size(own.part));
    let largest = largest.fold(0.0, f64::max);
    let told = left.unwrap_or(here);
    let has_value = failure.kind != FailureKind::NotFinite;
    if has_value && told.is_finite() && told.abs() > ROUNDING * largest {
        failure.residual = Some(told);
    }
    // What is nothing in it is not told, unless it has no value.
    terms.retain(|own| own.part != 0.0);
    terms.truncate(MOST);
    failure.terms = terms;
    failure
}

/// Names what a condition, as printed, reads, with the values at a time, of unknowns and their rates.
pub(crate) fn with_values(
    mut failure: Box<Failure>,
    state: &mut State<'_>,
    at: At<'_>,
    condition: &str,
) -> Box<Failure> {
    let program = state.program;
    let values = state.values(Function::Outputs, at);
    let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']');
    for word in condition.split(|c| !is_name(c)) {
        let known = failure.unknowns.iter().any(|(name, _)| name == word);
        if let (false, Some(output)) = (known, program.output(word)) {
            failure.unknowns.push((word.to_owned(), values[output]));
        }
    }
    failure
}
