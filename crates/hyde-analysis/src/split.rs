//! Splits array equations round an element whose derivative is no unknown any more.
//!
//! ```text
//! for i in 0..24: w[i] = der(th[i])         with th[0] = 0 becomes   w[0] = der(th[0]);  for i in 1..24: …
//! ```
//! That is how the end of a field is held, or joined to the end of another one.

use crate::system::{Cell, Equation, System};
use crate::unroll;
use hyde_ir::{Expr, Range};
use std::collections::BTreeSet;

/// Makes every equation over a range that differentiates the cell an equation of its own at that element; whether it could
/// be done.
pub(crate) fn at_cell(system: &mut System, cell: Cell) -> bool {
    let mut cuts: Vec<(usize, BTreeSet<i32>)> = Vec::new();
    for (number, equation) in system.equations.iter().enumerate() {
        if equation.range == Range::SCALAR {
            continue;
        }
        let mut counters = BTreeSet::new();
        for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
            let Expr::Der(var, index) = system.flat.exprs[id] else {
                continue;
            };
            if var != cell.0 {
                continue;
            }
            let at = equation.range.iter().find(|&counter| {
                usize::try_from(index.at(counter)).is_ok_and(|element| element == cell.1)
            });
            if index.stride == 0 && at.is_some() {
                return false;
            }
            counters.extend(at);
        }
        if !counters.is_empty() {
            cuts.push((number, counters));
        }
    }
    for (number, counters) in cuts {
        let whole = system.equations[number].clone();
        let mut parts = Vec::new();
        let mut first = whole.range.first;
        for counter in counters {
            parts.extend(part(system, &whole, first, counter - 1));
            parts.extend(part(system, &whole, counter, counter));
            first = counter + 1;
        }
        parts.extend(part(system, &whole, first, whole.range.last));
        let mut parts = parts.into_iter();
        if let Some(equation) = parts.next() {
            system.equations[number] = equation;
        }
        system.equations.extend(parts);
    }
    true
}

/// The equation over a part of its range; a scalar one at a single element, none at none.
fn part(system: &mut System, whole: &Equation, first: i32, last: i32) -> Option<Equation> {
    if last < first {
        return None;
    }
    let mut equation = whole.clone();
    if first == last {
        equation.range = Range::SCALAR;
        equation.lhs = unroll::at(system, whole.lhs, first);
        equation.rhs = unroll::at(system, whole.rhs, first);
    } else {
        equation.range = Range { first, last };
    }
    Some(equation)
}
