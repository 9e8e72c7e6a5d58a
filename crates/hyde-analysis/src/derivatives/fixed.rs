//! Rates that modes fix: `der(rel) = 0` becomes `w = 0` with `w = der(rel)`, and w, which others may give, one of the states.

use super::rates::{covering, new_rate, rates};
use crate::alias;
use crate::pins::Values;
use crate::segments;
use crate::system::{Branch, Cell, Equation, System};
use hyde_diag::MadeBy;
use hyde_ir::{Expr, Range};

/// Names the rates that modes fix and no equation names.
pub(super) fn name_rates(system: &mut System) {
    let known = rates(system);
    let mut found: Vec<(Cell, hyde_diag::Origin)> = Vec::new();
    for branch in system.slots.iter().flat_map(|slot| &slot.branches) {
        for (side, value) in [(branch.lhs, branch.rhs), (branch.rhs, branch.lhs)] {
            let Expr::Der(var, index) = system.flat.exprs[side] else {
                continue;
            };
            let Some(cell) = System::cell(var, index).filter(|_| system.is_parametric(value))
            else {
                continue;
            };
            let named = covering(&known, var, index, Range::SCALAR, None).is_some();
            if !named && found.iter().all(|(other, _)| *other != cell) {
                found.push((cell, branch.origin.clone()));
            }
        }
    }
    for (cell, origin) in found {
        if let Some(lhs) = new_rate(system, cell) {
            let rhs = system
                .exprs()
                .add(Expr::Der(cell.0, System::cell_index(cell)));
            system.equations.push(Equation {
                range: Range::SCALAR,
                lhs,
                rhs,
                origin: origin.made_by(MadeBy::Derivative),
                order: 0,
                constraint: false,
            });
        }
    }
}

/// What modes fix and other equations give by several states: it has to be a state in the place of one of them.
pub(super) fn relative(system: &mut System) -> Vec<Cell> {
    let states = segments::state_cells(system);
    let is_state = |cell: Cell| states.contains(&cell);
    let values = Values::new(system, &is_state);
    let branches: Vec<Branch> = system
        .slots
        .iter()
        .flat_map(|s| s.branches.clone())
        .collect();
    let mut found = Vec::new();
    for branch in branches {
        for (side, value) in [(branch.lhs, branch.rhs), (branch.rhs, branch.lhs)] {
            let Some((cell, _)) = alias::signed_cell(system, side) else {
                continue;
            };
            let fixed = system.is_parametric(value) && !states.contains(&cell);
            let several = |(_, states): (_, Vec<Cell>)| states.len() > 1;
            if fixed && values.of(system, &branch).is_some_and(several) {
                found.push(cell);
            }
        }
    }
    found
}
