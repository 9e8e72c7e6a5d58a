//! Derivatives: one variable for each, and none of what is explicit.
//!
//! Repeated until nothing changes:
//! ```text
//! pulley.w = der(th[0]);  w[0] = der(th[0])     every other der(th[0]) reads w[0]; then pulley.w = w[0] is an alias (M5)
//! stretch = phi - n*th[0];  … der(stretch)      der(stretch) is w - n*w[0]
//! a.phi = n*b.phi, both differentiated          a.phi is explicit in b.phi, and der(a.phi) = n*der(b.phi)
//! ```
//! The last line is index reduction for constraints that can be solved for one state; those that only several equations
//! show together are [shown](hidden) before. What needs more is refused by
//! [`crate::matching`] with the names of the constrained variables.

use crate::alias;
use crate::cells::Cells;
use crate::solve::solve_for;
use crate::split;
use crate::system::{Cell, Equation, System};
use crate::whole_arrays;
use explicit::Explicit;
use hyde_diag::Diagnostics;
use hyde_ir::dae::Dependent;
use hyde_ir::{Expr, ExprArena, ExprId, Memo, Range, VariableKind};
use std::collections::{BTreeMap, BTreeSet};

mod chain_rule;
mod explicit;
mod fixed;
mod hidden;
mod inline;
mod inputs;
mod rates;
mod wanted;

pub(crate) use chain_rule::by_rates;
pub(crate) use rates::{differentiated, new_rate};
pub(crate) use wanted::kept as fixed_by_modes;

/// Eliminates aliases and derivatives of explicit variables.
pub(crate) fn simplify(system: &mut System, diagnostics: &mut Diagnostics) {
    fixed::name_rates(system);
    let before = (!system.slots.is_empty()).then(|| system.clone());
    settle(system);
    if let Some(mut before) = before {
        before.to_be_states = fixed::relative(system);
        if !before.to_be_states.is_empty() {
            settle(&mut before);
            *system = before;
        }
    }
    inputs::refuse(system, diagnostics);
}

/// Repeats the rewritings until nothing changes.
fn settle(system: &mut System) {
    let declared = system.declared_values();
    // Each round eliminates at least one variable or derivative.
    for _ in 0..10_000 {
        let aliased = alias::eliminate(system);
        let named = rates::name_derivatives(system);
        let expanded =
            whole_arrays::expand_one(system, &declared) || expand_some(system, &declared);
        if !aliased && !named && !expanded && !hidden::expose(system) {
            break;
        }
    }
}

/// Makes differentiated variables explicit where equations allow: `der(v)` becomes the derivative of its value. Whether one
/// was.
///
/// What modes fix stays a state as long as any other variable of any constraint can go.
fn expand_some(system: &mut System, declared: &[Vec<f64>]) -> bool {
    let mut differentiated = differentiated(system);
    for (var, element) in wanted::states(system) {
        differentiated.insert(var, element, element);
    }
    let wanted = wanted::at_start(system);
    let kept = wanted::kept(system);
    let mut explicit = Explicit::of(system);
    for pinned in [false, true] {
        // Rates of what became explicit in this pass, in its order. Equations that read it wait for the next pass.
        let mut rates: Vec<(Cell, ExprId)> = Vec::new();
        let mut fresh: BTreeSet<Cell> = BTreeSet::new();
        for number in 0..system.equations.len() {
            let Equation {
                range, lhs, rhs, ..
            } = system.equations[number];
            if range != Range::SCALAR {
                continue;
            }
            let Some(leaves) = state_leaves(system, lhs, rhs, &differentiated, &explicit) else {
                continue;
            };
            let settled = |cell: &Cell| differentiated.contains(cell) && !fresh.contains(cell);
            if !rates.is_empty() && !leaves.iter().all(settled) {
                continue;
            }
            let candidates: Vec<Cell> = leaves
                .into_iter()
                .filter(|cell| differentiated.contains(cell) || wanted.contains(cell))
                .filter(|cell| pinned || !kept.contains(cell))
                .collect();
            let form = (lhs, rhs);
            let states = (&differentiated, &kept);
            if let Some(rate) = expand(
                system,
                declared,
                number,
                form,
                candidates,
                states,
                &mut explicit,
            ) {
                fresh.insert(rate.0);
                rates.push(rate);
                // The equations of an array have been split.
                if pinned || system.flat.variables[rate.0.0].len.is_some() {
                    break;
                }
            }
        }
        // Reduction in general leaves pinned variables alone, so that their constraints are looked for further.
        if rates.is_empty() && !pinned && !kept.is_empty() {
            let states = (&differentiated, &kept);
            for (number, lhs, rhs, leaves) in inline::constraints(system, declared, &differentiated)
            {
                let free = leaves
                    .into_iter()
                    .filter(|cell| !kept.contains(cell))
                    .collect();
                let form = (lhs, rhs);
                rates.extend(expand(
                    system,
                    declared,
                    number,
                    form,
                    free,
                    states,
                    &mut explicit,
                ));
                if !rates.is_empty() {
                    break;
                }
            }
        }
        if !rates.is_empty() {
            replace_derivatives(system, rates);
            return true;
        }
    }
    false
}

/// Replaces the derivatives of what became explicit, the last first: rates are made of variables that did so later.
fn replace_derivatives(system: &mut System, rates: Vec<(Cell, ExprId)>) {
    let mut found: BTreeMap<Cell, ExprId> = BTreeMap::new();
    let replace = |found: &BTreeMap<Cell, ExprId>, expr: Expr| {
        let Expr::Der(var, index) = expr else {
            return None;
        };
        found.get(&System::cell(var, index)?).copied()
    };
    for (cell, rate) in rates.into_iter().rev() {
        let mut memo = Memo::default();
        let whole = |_: &mut ExprArena, _, expr| replace(&found, expr);
        let rate = system.flat.exprs.rewrite(rate, &mut memo, whole);
        found.insert(cell, rate);
    }
    system.rewrite_all(None, |_, expr| replace(&found, expr));
}

/// Makes the first candidate explicit that an equation, in the form given, can be solved for; gives its rate.
fn expand(
    system: &mut System,
    declared: &[Vec<f64>],
    number: usize,
    (lhs, rhs): (ExprId, ExprId),
    mut candidates: Vec<Cell>,
    (differentiated, kept): (&Cells, &BTreeSet<Cell>),
    explicit: &mut Explicit,
) -> Option<(Cell, ExprId)> {
    let in_array = |system: &System, cell: &Cell| system.flat.variables[cell.0].len.is_some();
    let is_left = |system: &System, cell: Cell| matches!(system.flat.exprs[lhs], Expr::Var(var, _) if var == cell.0);
    let fixed = |system: &System, cell: &Cell| {
        system
            .starts
            .get(cell)
            .is_some_and(|list| list.iter().any(|(_, fixed, _)| *fixed))
    };
    candidates.sort_by_key(|cell| {
        (
            kept.contains(cell),
            system.flat.variables[cell.0].state,
            in_array(system, cell),
            !is_left(system, *cell),
            fixed(system, cell),
            *cell,
        )
    });
    for cell in candidates {
        let leaf = Expr::Var(cell.0, System::cell_index(cell));
        let Some(value) = solve_for(&mut system.flat.exprs, lhs, rhs, leaf) else {
            continue;
        };
        if system.divides_by_zero(declared, lhs, rhs, leaf) {
            continue;
        }
        let Some(rate) = explicit.derivative(system, value, cell, differentiated) else {
            continue;
        };
        // An element leaves the equations of its array that differentiate it.
        if in_array(system, &cell) && !split::at_cell(system, cell) {
            continue;
        }
        explicit.forget(system, number);
        let equation = &mut system.equations[number];
        equation.lhs = system.flat.exprs.add(leaf);
        equation.rhs = value;
        let origin = equation.origin.clone();
        explicit.note(system, number);
        if system.dependent.iter().all(|d| (d.var, d.element) != cell) {
            system.dependent.push(Dependent {
                var: cell.0,
                element: cell.1,
                len: 1,
                origin,
            });
        }
        return Some((cell, rate));
    }
    None
}

/// The variables of an equation if it has no derivative and every variable in it can be differentiated.
fn state_leaves(
    system: &System,
    lhs: ExprId,
    rhs: ExprId,
    states: &Cells,
    explicit: &Explicit,
) -> Option<Vec<Cell>> {
    let mut found = Vec::new();
    for id in system.flat.exprs.below(&[lhs, rhs]) {
        let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
            continue;
        };
        if derivative {
            return None;
        }
        match system.flat.variables[var].kind {
            VariableKind::Continuous => {
                let cell = System::cell(var, index)?;
                if !states.contains(&cell) && !explicit.is_derivable(system, cell, states) {
                    return None;
                }
                found.push(cell);
            }
            VariableKind::Discrete | VariableKind::Held(..) => {}
            VariableKind::Clocked(_)
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => {
                return None;
            }
        }
    }
    Some(found)
}
