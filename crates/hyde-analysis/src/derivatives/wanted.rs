//! Which variables should stay states, and which need a derivative though no equation has one.

use crate::alias;
use crate::system::{Cell, System};
use hyde_ir::{Expr, ExprId, StateChoice};
use std::collections::BTreeSet;

/// The cells that their authors or modes want as states, without those that are given by other states already.
pub(super) fn states(system: &System) -> Vec<Cell> {
    let variables = system.flat.variables.enumerate();
    let preferred = variables
        .filter(|(_, variable)| variable.state >= StateChoice::Prefer && variable.len.is_none());
    let given: BTreeSet<Cell> = system
        .dependent
        .iter()
        .map(|d| (d.var, d.element))
        .collect();
    preferred
        .map(|(var, _)| (var, 0))
        .chain(system.to_be_states.iter().copied())
        .filter(|cell| !system.aliases.contains_key(cell) && !given.contains(cell))
        .collect()
}

/// The cells under `der` in initial equations: `der(slip) = 0` needs the derivative of what `slip` is.
pub(super) fn at_start(system: &System) -> BTreeSet<Cell> {
    let equations = system.flat.initial_equations.iter();
    let sides: Vec<ExprId> = equations.flat_map(|e| [e.lhs, e.rhs]).collect();
    let below = system.flat.exprs.below(&sides).into_iter();
    below
        .filter_map(|id| {
            let (var, index, derivative) = system.flat.exprs[id].access()?;
            System::cell(var, index).filter(|_| derivative)
        })
        .collect()
}

/// The cells that modes fix to a constant, and those that they are the derivatives of.
pub(crate) fn kept(system: &System) -> BTreeSet<Cell> {
    let branches = system.slots.iter().flat_map(|slot| &slot.branches);
    let sides = branches.flat_map(|branch| [(branch.lhs, branch.rhs), (branch.rhs, branch.lhs)]);
    let fixes = sides.filter_map(|(a, b)| {
        let (cell, _) = alias::signed_cell(system, a)?;
        system.is_parametric(b).then_some(cell)
    });
    let mut found: BTreeSet<Cell> = fixes.collect();
    for equation in &system.equations {
        let exprs = &system.flat.exprs;
        for (v, d) in [(equation.lhs, equation.rhs), (equation.rhs, equation.lhs)] {
            if let (Some((cell, _)), Expr::Der(var, index)) =
                (alias::signed_cell(system, v), exprs[d])
                && found.contains(&cell)
                && let Some(below) = System::cell(var, index)
            {
                found.insert(below);
            }
        }
    }
    found
}
