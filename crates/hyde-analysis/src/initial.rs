//! The initial system: which states start where, and which equations hold at the start (I1 to I3).
//!
//! One condition is needed for each state that no initial mode fixes. Each has its start value; initial equations make as
//! many of them yield, the loosest first ([`Firmness`]), and the run chooses which by numbers. Those that are fixed for this
//! model never do: what is too much is reported.

mod taken;

use crate::refusals::states as refused;
use crate::system::{Cell, System};
use hyde_diag::{Diagnostics, Origin, Span};
use hyde_ir::dae::{Dae, Firmness, InitialCondition};
use hyde_ir::{Expr, ExprId, Range, VarId};
use std::collections::{BTreeMap, BTreeSet};
use taken::{Free, take};

/// A state that needs a condition, or several of one array.
struct Condition {
    position: usize,
    len: usize,
    firmness: Firmness,
    origin: Origin,
}

/// Fills in the initial conditions of the DAE.
pub(crate) fn conditions(dae: &mut Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    refuse_conflicts(dae, system, diagnostics);
    let equations = system.flat.initial_equations.iter();
    let mut equations: Vec<(Range, ExprId, Origin)> = equations
        .map(|equation| {
            let value = dae.exprs.minus(equation.lhs, equation.rhs);
            (equation.range, value, equation.origin.clone())
        })
        .collect();
    let conditions = conditions_of_states(dae, system);
    // What may yield, the loosest first; parameters that are to be found are looser still.
    let mut loose: Vec<&Condition> = conditions
        .iter()
        .filter(|condition| condition.firmness < Firmness::Given)
        .collect();
    loose.sort_by_key(|condition| condition.firmness);
    let below = |firmness: Firmness| {
        let looser = loose
            .iter()
            .filter(|condition| condition.firmness < firmness);
        Free::of(looser.map(|condition| (condition.position, condition.len)))
    };
    let (guesses, with_defaults) = (below(Firmness::Default), below(Firmness::Given));
    let to_find = dae.parameters.iter().filter(|p| p.found);
    let to_find: usize = to_find.map(hyde_ir::Parameter::size).sum();
    let needed: usize = equations.iter().map(|(range, ..)| range.len()).sum();
    let constrained = take(dae, &[], &with_defaults).len();
    let open = with_defaults.len() - constrained + to_find;
    if needed > open {
        too_many(dae, &equations, &conditions, open, diagnostics);
        return;
    }
    let mut checks: Vec<(VarId, ExprId, ExprId)> = Vec::new();
    for start in starts_of_algebraic(dae, system) {
        // Start values given for this model come before those that parts declare for every use.
        let given = dae.variables[start.given_by].start_given;
        let open = if given { &with_defaults } else { &guesses };
        let before = take(dae, &equations, open).len();
        let equation = (Range::SCALAR, start.condition, start.origin.clone());
        equations.push(equation);
        if take(dae, &equations, open).len() == before {
            equations.pop();
            if given {
                checks.push((start.given_by, start.value, start.start));
            }
        }
    }
    checks.extend(starts_in_groups(dae, system));
    let known = system.known_starts.iter().copied();
    checks.extend(known.filter(|(given_by, ..)| dae.variables[*given_by].start_given));
    let yielding = yielding(dae, &equations, &with_defaults, to_find);
    let mut fixed = Vec::new();
    for condition in conditions {
        let each = condition.position..condition.position + condition.len;
        let whole = yielding.range(each.clone()).next().is_none();
        let pieces = match whole {
            true => vec![(condition.position, condition.len)],
            false => each.map(|position| (position, 1)).collect(),
        };
        for (state, len) in pieces {
            fixed.push(InitialCondition::Fixed {
                state,
                len,
                firmness: condition.firmness,
                yields: yielding.contains(&state),
                origin: condition.origin.clone(),
            });
        }
    }
    let of_equations = equations.into_iter();
    let of_equations = of_equations.map(|(range, value, origin)| InitialCondition::Equation {
        range,
        value,
        origin,
    });
    dae.initial.extend(fixed);
    dae.initial.extend(of_equations);
    for (var, value, start) in checks {
        dae.initial
            .push(InitialCondition::Check { var, value, start });
    }
}

/// The states that no initial mode fixes, in blocks; a state whose start is declared fixed is in any case one of them.
fn conditions_of_states(dae: &Dae, system: &System) -> Vec<Condition> {
    let pinned: BTreeSet<usize> = dae
        .pins
        .iter()
        .filter(|pin| dae.automata[pin.automaton].initial == pin.mode)
        .map(|pin| pin.state)
        .collect();
    let blocks = dae.unknowns.iter().filter(|block| block.differential);
    let conditions = blocks.map(|block| {
        let variable = &dae.variables[block.var];
        let starts = system.starts.get(&(block.var, block.first));
        let starts = starts.map_or(&[][..], |list| list.as_slice());
        let mut firmness = match (variable.len.is_some(), variable.fixed) {
            (true, true) if variable.start_given => Firmness::Given,
            (true, true) => Firmness::Default,
            (_, false) if variable.freed => Firmness::Free,
            (true, false) if !variable.start.is_empty() => Firmness::Guess,
            (true, false) | (false, _) => Firmness::Open,
        };
        let mut said_by = block.var;
        // An array that is in the vector in pieces has elements that components are joined to.
        if block.len == 1 {
            for &(_, fixed, given_by) in starts {
                let given = &dae.variables[given_by];
                let this = match fixed {
                    true if given.start_given => Firmness::Given,
                    true => Firmness::Default,
                    false if given.freed => Firmness::Free,
                    false => Firmness::Guess,
                };
                if this > firmness {
                    (firmness, said_by) = (this, given_by);
                }
            }
        }
        let origin = dae.variables[said_by].origin.clone();
        let span = system
            .component(&origin)
            .map_or(origin.span, |(_, span)| span);
        Condition {
            position: block.offset,
            len: block.len,
            firmness,
            origin: Origin { span, ..origin },
        }
    });
    conditions
        .filter(|condition| {
            condition.firmness >= Firmness::Default || !pinned.contains(&condition.position)
        })
        .collect()
}

/// Start values given for this model of variables that constraints tie: the run chooses which of them are conditions.
fn starts_in_groups(dae: &mut Dae, system: &System) -> Vec<(VarId, ExprId, ExprId)> {
    let mut found = Vec::new();
    let cells = system.groups.iter().flat_map(|group| &group.candidates);
    for (cell, _) in cells {
        for (start, fixed, given_by) in system.starts.get(cell).into_iter().flatten() {
            if *fixed && dae.variables[*given_by].start_given {
                let leaf = Expr::Var(cell.0, System::cell_index(*cell));
                let value = dae.exprs.add(leaf);
                found.push((*given_by, value, *start));
            }
        }
    }
    found
}

/// A fixed start value of a variable that is no state.
struct AlgebraicStart {
    given_by: VarId,
    value: ExprId,
    start: ExprId,
    condition: ExprId,
    origin: Origin,
}

/// Fixed start values of variables that are no states: each is an equation, if it determines a state that is still free.
/// Those given for this model first.
fn starts_of_algebraic(dae: &mut Dae, system: &System) -> Vec<AlgebraicStart> {
    let blocks = dae.unknowns.iter().filter(|block| block.differential);
    let lengths: BTreeMap<Cell, usize> = blocks
        .map(|block| ((block.var, block.first), block.len))
        .collect();
    let is_state = |cell: Cell| {
        let before = lengths.range(..=cell).next_back();
        before.is_some_and(|(&(var, first), len)| var == cell.0 && cell.1 < first + len)
    };
    let mut found = Vec::new();
    for (&(var, element), starts) in &system.starts {
        let Some(&(start, _, given_by)) = starts.iter().find(|(_, fixed, _)| *fixed) else {
            continue;
        };
        if is_state((var, element)) || dae.places[var].is_none() {
            continue;
        }
        let value = dae
            .exprs
            .add(Expr::Var(var, System::cell_index((var, element))));
        found.push(AlgebraicStart {
            given_by,
            value,
            start,
            condition: dae.exprs.minus(value, start),
            origin: dae.variables[var].origin.clone(),
        });
    }
    found.sort_by_key(|start| !dae.variables[start.given_by].start_given);
    found
}

/// The states that initial equations and constraints take, by the names that these read.
fn yielding(
    dae: &Dae,
    equations: &[(Range, ExprId, Origin)],
    loose: &Free,
    to_find: usize,
) -> BTreeSet<usize> {
    let needed: usize = equations.iter().map(|(range, ..)| range.len()).sum();
    let constraints = take(dae, &[], loose).len();
    let taken = take(dae, equations, loose);
    let placed = taken.len() - constraints;
    let unplaced = needed.saturating_sub(placed + to_find);
    // Equations that name no state directly determine some through the others: the loosest, and of those the last declared.
    let left = (0..loose.len())
        .rev()
        .filter(|number| !taken.contains(number));
    let also: Vec<usize> = left.take(unplaced).collect();
    let all = taken.iter().chain(&also);
    all.map(|&number| loose.position(number)).collect()
}

fn too_many(
    dae: &Dae,
    equations: &[(Range, ExprId, Origin)],
    conditions: &[Condition],
    free: usize,
    diagnostics: &mut Diagnostics,
) {
    let equations: Vec<Span> = equations.iter().map(|(.., origin)| origin.span).collect();
    let given = conditions.iter().filter(|c| c.firmness == Firmness::Given);
    let fixed = given.take(8).map(|condition| {
        let name = dae.unknown_name(condition.position);
        (name, condition.origin.span)
    });
    let fixed: Vec<(String, Span)> = fixed.collect();
    diagnostics.push(refused::too_many_conditions(&equations, free, &fixed));
}

/// Joined states with different fixed start values (I1).
fn refuse_conflicts(dae: &Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    // Values are compared with declared parameters; the expressions live in the DAE now.
    system.flat.exprs = dae.exprs.clone();
    let declared = system.declared_values();
    let starts: Vec<(Cell, Vec<(ExprId, VarId)>)> = system
        .starts
        .iter()
        .map(|(cell, list)| {
            let fixed = list
                .iter()
                .filter(|(_, fixed, _)| *fixed)
                .map(|(value, _, var)| (*value, *var));
            (*cell, fixed.collect())
        })
        .collect();
    for (cell, fixed) in starts {
        let Some(&(first, given_first)) = fixed.first() else {
            continue;
        };
        let value = system.value_with(&declared, first);
        for &(other, given_by) in &fixed[1..] {
            let second = system.value_with(&declared, other);
            let equal = other == first
                || matches!((value, second), (Some(a), Some(b)) if (a - b).abs() <= 1e-12 * a.abs().max(b.abs()));
            if equal {
                continue;
            }
            let (a, b) = (&dae.variables[given_first], &dae.variables[given_by]);
            let show = |value: Option<f64>| {
                value.map_or("another value".to_owned(), |value| value.to_string())
            };
            let place = |variable: &hyde_ir::Variable| {
                let component = system.component(&variable.origin);
                component.map_or(variable.origin.span, |(_, span)| span)
            };
            let state = dae.variables[cell.0].element_name(cell.1);
            diagnostics.push(refused::different_starts(
                (&a.name, &show(value), place(a)),
                (&b.name, &show(second), place(b)),
                &state,
            ));
        }
    }
}
