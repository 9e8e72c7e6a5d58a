//! What stands in the equation at which a run failed: its unknowns and rates with their values, the part that each has in it,
//! and by how much its sides differ.

use crate::failure::{Failure, FailureKind};
use crate::moment::At;
use crate::state::State;
use hyde_program::{Function, Wrt};

/// Terms that are told at most, the largest first.
const MOST: usize = 6;
/// Sides that differ by less than this part of the largest term are equal to rounding.
const ROUNDING: f64 = 1e-9;

/// An unknown, or the rate of one, in an equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Name of the unknown.
    pub name: String,
    /// Whether it is its derivative by time.
    pub is_rate: bool,
    /// Its value, SI.
    pub value: f64,
    /// What the left side minus the right side would lose if it were 0, SI.
    pub part: f64,
}

impl Failure {
    /// Tells what stands in the equation of a row at a point. `left` is by how much its sides differed where the solver gave
    /// up; without it, it is that of the point.
    pub(crate) fn with_equation(
        mut self: Box<Self>,
        state: &mut State<'_>,
        at: At<'_>,
        row: usize,
        left: Option<f64>,
    ) -> Box<Self> {
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
        let has_value = self.kind != FailureKind::NotFinite;
        if has_value && told.is_finite() && told.abs() > ROUNDING * largest {
            self.residual = Some(told);
        }
        // What is nothing in it is not told, unless it has no value.
        terms.retain(|own| own.part != 0.0);
        terms.truncate(MOST);
        self.terms = terms;
        self
    }
}
