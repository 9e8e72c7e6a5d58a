//! Takes algebraic variables out of the solver's vector: each that its equation gives explicitly becomes a definition.
//!
//! States and their derivatives count as known, so `a.tau = J*der(w)` is explicit too. The definitions are ordered by
//! Tarjan's algorithm; of a loop one variable after the other is torn (kept in the vector with its equation as the
//! residual) until the rest is explicit, those with a guess first. A variable that reads much of an array (a field at a
//! place that moves) stays in the vector: in its place every equation that reads it would depend on all of that. So does an
//! array of which one equation reads much: the derivative of that equation would repeat the definition for every element. A
//! [shape](crate::shapes), as the weights at such a place are, does not: its derivatives are arrays too. Array variables are
//! kept or taken whole, in as many pieces as equations give them. The unknown of a `modes` block stays in the vector where
//! a mode fixes a state (its row changes place then) or does not give it explicitly without a division by parameters.

mod torn;

use crate::graph::strongly_connected_components;
use crate::matching::{Matched, Node, sides};
use crate::shapes::{A_FEW, is_shape};
use crate::solve::{divisor, solve_for};
use crate::system::System;
use hyde_ir::{Expr, ExprId, Index, Range, VarId};
use rustc_hash::{FxHashMap, FxHashSet};
use torn::tear;

/// What becomes of the unknowns.
pub(crate) struct Order {
    /// Explicit ones in the order of computation: number of the unknown, range, element, value.
    pub(crate) definitions: Vec<Explicit>,
    /// Whether each unknown stays in the vector.
    pub(crate) in_vector: Vec<bool>,
}

/// An explicit unknown.
pub(crate) struct Explicit {
    pub(crate) unknown: usize,
    pub(crate) range: Range,
    pub(crate) index: Index,
    pub(crate) value: ExprId,
}

/// Chooses what becomes explicit.
pub(crate) fn choose(system: &mut System, matched: &Matched) -> Order {
    let count = matched.unknowns.len();
    let mut in_vector: Vec<bool> = matched
        .unknowns
        .iter()
        .map(|unknown| unknown.state)
        .collect();
    let declared = system.declared_values();
    let much = read_much_of(system);
    let mut explicit: Vec<Option<Explicit>> = (0..count).map(|_| None).collect();
    for number in 0..count {
        if in_vector[number] {
            continue;
        }
        explicit[number] = solve(system, matched, number, &declared);
        let of_much = much.contains(&matched.unknowns[number].var);
        in_vector[number] = explicit[number].as_ref().is_none_or(|solution| {
            let is_shape = is_shape(&system.flat.exprs, solution.range, solution.value);
            of_much && !is_shape || reads_much(system, solution)
        });
    }
    keep_arrays_together(matched, &mut in_vector);
    let reads = |number: usize| match &explicit[number] {
        Some(solution) if !in_vector[number] => depends_on(system, matched, solution, &in_vector),
        _ => Vec::new(),
    };
    let mut edges: Vec<Vec<usize>> = (0..count).map(reads).collect();
    let known = (matched, explicit.as_slice());
    tear(system, known, &declared, &mut edges, &mut in_vector);
    let order = strongly_connected_components(&edges).into_iter().flatten();
    let order = order.filter(|&number| !in_vector[number]);
    let definitions = order.filter_map(|number| explicit[number].take()).collect();
    Order {
        definitions,
        in_vector,
    }
}

/// The access through which an equation determines its unknown.
pub(crate) fn access(system: &System, matched: &Matched, number: usize) -> Option<(Range, Index)> {
    let unknown = matched.unknowns[number];
    for (range, lhs, rhs) in sides(system, matched.equation_of[number]) {
        for id in system.flat.exprs.below(&[lhs, rhs]) {
            let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
                continue;
            };
            let fits = var == unknown.var
                && derivative == unknown.state
                && System::interval(index, range) == (unknown.first, unknown.last)
                && unknown.len() == range.len();
            if fits {
                return Some((range, index));
            }
        }
    }
    None
}

fn solve(
    system: &mut System,
    matched: &Matched,
    number: usize,
    declared: &[Vec<f64>],
) -> Option<Explicit> {
    let unknown = matched.unknowns[number];
    let (range, index) = access(system, matched, number)?;
    let leaf = Expr::Var(unknown.var, index);
    match matched.equation_of[number] {
        Node::Equation(equation) => {
            let (lhs, rhs) = (
                system.equations[equation].lhs,
                system.equations[equation].rhs,
            );
            let value = solve_for(&mut system.flat.exprs, lhs, rhs, leaf)?;
            if system.divides_by_zero(declared, lhs, rhs, leaf) {
                return None;
            }
            let itself = system.flat.exprs.any(
                value,
                |expr| matches!(expr, Expr::Var(var, _) if var == unknown.var),
            );
            (!itself || unknown.len() == 1).then_some(Explicit {
                unknown: number,
                range,
                index,
                value,
            })
        }
        Node::Slot(slot) => {
            let branches = system.slots[slot].branches.clone();
            if branches.iter().any(|branch| branch.pin.is_some()) {
                return None;
            }
            let automaton = system.slots[slot].automaton;
            let mut value: Option<ExprId> = None;
            for (mode, branch) in branches.iter().enumerate().rev() {
                let solution = solve_for(&mut system.flat.exprs, branch.lhs, branch.rhs, leaf)?;
                // A diode without resistance fixes its voltage, blocking without conductance its current: no mode may divide
                // by what can be 0 there.
                let divisor = divisor(&mut system.flat.exprs, branch.lhs, branch.rhs, leaf);
                if divisor.is_some_and(|divisor| system.flat.exprs.as_constant(divisor).is_none()) {
                    return None;
                }
                value = Some(match value {
                    None => solution,
                    Some(others) => {
                        let mode = u32::try_from(mode).unwrap_or(u32::MAX);
                        let in_mode = system.flat.exprs.add(Expr::InMode(automaton, mode));
                        system.flat.exprs.if_else(in_mode, solution, others)
                    }
                });
            }
            Some(Explicit {
                unknown: number,
                range,
                index,
                value: value?,
            })
        }
    }
}

/// Whether a definition reads more than a few values.
fn reads_much(system: &System, solution: &Explicit) -> bool {
    let leaves = system.flat.exprs.below(&[solution.value]);
    let read = leaves
        .into_iter()
        .filter(|&id| system.flat.exprs[id].access().is_some());
    read.count() > A_FEW
}

/// The arrays of which one equation reads more than a few elements.
fn read_much_of(system: &System) -> FxHashSet<VarId> {
    let mut found = FxHashSet::default();
    for equation in &system.equations {
        let mut read: FxHashMap<VarId, usize> = FxHashMap::default();
        for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
            if let Expr::Var(var, _) = system.flat.exprs[id] {
                *read.entry(var).or_default() += 1;
            }
        }
        let much = read.into_iter().filter(|(_, count)| *count > A_FEW);
        found.extend(much.map(|(var, _)| var));
    }
    found
}

/// An array of which a piece stays in the vector stays there whole.
fn keep_arrays_together(matched: &Matched, in_vector: &mut [bool]) {
    let mut stays: FxHashMap<VarId, bool> = FxHashMap::default();
    for (unknown, kept) in matched.unknowns.iter().zip(&*in_vector) {
        *stays.entry(unknown.var).or_default() |= *kept;
    }
    for (unknown, kept) in matched.unknowns.iter().zip(in_vector) {
        *kept |= stays[&unknown.var];
    }
}

fn depends_on(
    system: &System,
    matched: &Matched,
    solution: &Explicit,
    in_vector: &[bool],
) -> Vec<usize> {
    let mut found = Vec::new();
    for id in system.flat.exprs.below(&[solution.value]) {
        let Expr::Var(var, index) = system.flat.exprs[id] else {
            continue;
        };
        let (first, last) = System::interval(index, solution.range);
        let start = matched
            .unknowns
            .partition_point(|unknown| unknown.var < var);
        for (offset, unknown) in matched.unknowns[start..].iter().enumerate() {
            if unknown.var != var {
                break;
            }
            let number = start + offset;
            if !in_vector[number] && unknown.overlaps(first, last) && !found.contains(&number) {
                found.push(number);
            }
        }
    }
    found
}
