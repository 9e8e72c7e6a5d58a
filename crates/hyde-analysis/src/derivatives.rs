//! Derivatives: one variable for each, and none of what is explicit.
//!
//! Repeated until nothing changes:
//! ```text
//! pulley.w = der(th[0]);  w[0] = der(th[0])     every other der(th[0]) reads w[0]; then pulley.w = w[0] is an alias (M5)
//! stretch = phi - n*th[0];  … der(stretch)      der(stretch) is w - n*w[0]
//! a.phi = n*b.phi, both differentiated          a.phi is explicit in b.phi, and der(a.phi) = n*der(b.phi)
//! ```
//! The last line is index reduction for constraints that can be solved for one state. What needs more is refused by
//! [`crate::matching`] with the names of the constrained variables.

use crate::alias;
use crate::cells::Cells;
use crate::solve::solve_for;
use crate::split;
use crate::system::{Cell, Equation, System};
use crate::whole_arrays;
use hyde_diag::Diagnostics;
use hyde_ir::dae::Dependent;
use hyde_ir::{Expr, ExprId, Index, Range, StateChoice, VarId, VariableKind};
use std::collections::{BTreeMap, BTreeSet};

mod inline;
mod inputs;
mod wanted;

/// `target[j + shift] = der(var[j])` for the elements j in `first..=last`.
#[derive(Clone, Copy, Debug)]
struct Rate {
    first: usize,
    last: usize,
    target: VarId,
    shift: i32,
    equation: usize,
}

/// Eliminates aliases and derivatives of explicit variables.
pub(crate) fn simplify(system: &mut System, diagnostics: &mut Diagnostics) {
    let declared = system.declared_values();
    // Each round eliminates at least one variable or derivative.
    for _ in 0..10_000 {
        let aliased = alias::eliminate(system);
        let named = name_derivatives(system);
        let expanded = whole_arrays::expand_one(system, &declared) || expand_one(system, &declared);
        if !aliased && !named && !expanded {
            break;
        }
    }
    inputs::refuse(system, diagnostics);
}

/// Replaces `der(x)` by the variable that an equation `v = der(x)` names, everywhere else.
fn name_derivatives(system: &mut System) -> bool {
    let rates = rates(system);
    let mut changed = false;
    for number in 0..system.equations.len() {
        let range = system.equations[number].range;
        changed |= rename(system, &rates, Place::Equation(number), range);
    }
    for slot in 0..system.slots.len() {
        for branch in 0..system.slots[slot].branches.len() {
            changed |= rename(system, &rates, Place::Branch(slot, branch), Range::SCALAR);
        }
    }
    // Guards, actions, samples and outputs read derivatives too.
    let before = system.flat.exprs.len();
    let equations = std::mem::take(&mut system.equations);
    let slots = std::mem::take(&mut system.slots);
    system.rewrite_all(None, |arena, expr| {
        let Expr::Der(var, index) = expr else {
            return None;
        };
        let rate = covering(&rates, var, index, Range::SCALAR, None)?;
        Some(arena.add(Expr::Var(rate.target, shifted(index, rate.shift))))
    });
    system.equations = equations;
    system.slots = slots;
    changed || system.flat.exprs.len() > before
}

#[derive(Clone, Copy)]
enum Place {
    Equation(usize),
    Branch(usize, usize),
}

fn rename(
    system: &mut System,
    rates: &BTreeMap<VarId, Vec<Rate>>,
    place: Place,
    range: Range,
) -> bool {
    let (lhs, rhs) = match place {
        Place::Equation(number) => (system.equations[number].lhs, system.equations[number].rhs),
        Place::Branch(slot, branch) => {
            let branch = &system.slots[slot].branches[branch];
            (branch.lhs, branch.rhs)
        }
    };
    let own = if let Place::Equation(number) = place {
        Some(number)
    } else {
        None
    };
    let mut memo = std::collections::HashMap::new();
    let mut replace = |system: &mut System, id: ExprId| {
        system.flat.exprs.rewrite(id, &mut memo, |arena, _, expr| {
            let Expr::Der(var, index) = expr else {
                return None;
            };
            let rate = covering(rates, var, index, range, own)?;
            Some(arena.add(Expr::Var(rate.target, shifted(index, rate.shift))))
        })
    };
    let (left, right) = (replace(system, lhs), replace(system, rhs));
    let changed = left != lhs || right != rhs;
    match place {
        Place::Equation(number) => {
            system.equations[number].lhs = left;
            system.equations[number].rhs = right;
        }
        Place::Branch(slot, branch) => {
            let branch = &mut system.slots[slot].branches[branch];
            branch.lhs = left;
            branch.rhs = right;
        }
    }
    changed
}

/// The equations `v = der(x)`, by x; where several name the same derivative, the one whose v is in an array is kept.
fn rates(system: &System) -> BTreeMap<VarId, Vec<Rate>> {
    let mut found: BTreeMap<VarId, Vec<Rate>> = BTreeMap::new();
    for (number, equation) in system.equations.iter().enumerate() {
        let exprs = &system.flat.exprs;
        for (v, d) in [(equation.lhs, equation.rhs), (equation.rhs, equation.lhs)] {
            let (Expr::Var(target, to), Expr::Der(var, from)) = (exprs[v], exprs[d]) else {
                continue;
            };
            if !system.is_continuous(target)
                || to.stride != from.stride
                || (from.stride != 0 && from.stride != 1)
            {
                continue;
            }
            let (first, last) = System::interval(from, equation.range);
            let rate = Rate {
                first,
                last,
                target,
                shift: to.offset - from.offset,
                equation: number,
            };
            let list = found.entry(var).or_default();
            match list
                .iter_mut()
                .find(|old| old.first == first && old.last == last)
            {
                Some(old) => {
                    let better = |t: VarId| system.flat.variables[t].len.is_some();
                    if better(target) && !better(old.target) {
                        *old = rate;
                    }
                }
                None => list.push(rate),
            }
            break;
        }
    }
    found
}

/// The rate that covers an access over a range, if one target does, and the equation asking is not its own.
fn covering(
    rates: &BTreeMap<VarId, Vec<Rate>>,
    var: VarId,
    index: Index,
    range: Range,
    own: Option<usize>,
) -> Option<Rate> {
    let list = rates.get(&var)?;
    let (first, last) = System::interval(index, range);
    let mut at = first;
    let mut found: Option<Rate> = None;
    while at <= last {
        let rate = *list
            .iter()
            .find(|rate| (rate.first..=rate.last).contains(&at))?;
        if own == Some(rate.equation) {
            return None;
        }
        if found.is_some_and(|other| other.target != rate.target || other.shift != rate.shift) {
            return None;
        }
        found = Some(rate);
        at = rate.last + 1;
    }
    found
}

fn shifted(index: Index, by: i32) -> Index {
    Index {
        offset: index.offset + by,
        ..index
    }
}

/// Makes one differentiated variable explicit, if an equation allows: `der(v)` becomes the derivative of its value.
///
/// What modes fix stays a state as long as any other variable of any constraint can go.
fn expand_one(system: &mut System, declared: &[Vec<f64>]) -> bool {
    let mut differentiated = differentiated(system);
    for (var, variable) in system.flat.variables.enumerate() {
        let eliminated = system.aliases.contains_key(&(var, 0));
        if variable.state >= StateChoice::Prefer && variable.len.is_none() && !eliminated {
            differentiated.insert(var, 0, 0);
        }
    }
    let wanted = wanted::at_start(system);
    let kept = wanted::kept(system);
    for pinned in [false, true] {
        for number in 0..system.equations.len() {
            let Equation {
                range, lhs, rhs, ..
            } = system.equations[number];
            if range != Range::SCALAR {
                continue;
            }
            let Some(leaves) = state_leaves(system, lhs, rhs, &differentiated) else {
                continue;
            };
            let candidates: Vec<Cell> = leaves
                .into_iter()
                .filter(|cell| differentiated.contains(cell) || wanted.contains(cell))
                .filter(|cell| pinned || !kept.contains(cell))
                .collect();
            if expand(
                system,
                declared,
                number,
                (lhs, rhs),
                candidates,
                &differentiated,
                &kept,
            ) {
                return true;
            }
        }
        // Reduction in general leaves pinned variables alone, so that their constraints are looked for further.
        if !pinned && !kept.is_empty() {
            let states = &differentiated;
            for (number, lhs, rhs, leaves) in inline::constraints(system, declared, states) {
                let free = leaves
                    .into_iter()
                    .filter(|cell| !kept.contains(cell))
                    .collect();
                if expand(system, declared, number, (lhs, rhs), free, states, &kept) {
                    return true;
                }
            }
        }
    }
    false
}

/// Makes the first candidate explicit that an equation, in the form given, can be solved for.
fn expand(
    system: &mut System,
    declared: &[Vec<f64>],
    number: usize,
    (lhs, rhs): (ExprId, ExprId),
    mut candidates: Vec<Cell>,
    differentiated: &Cells,
    kept: &BTreeSet<Cell>,
) -> bool {
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
        let Some(rate) = derivative(system, value, cell, differentiated, 0) else {
            continue;
        };
        // An element leaves the equations of its array that differentiate it.
        if in_array(system, &cell) && !split::at_cell(system, cell) {
            continue;
        }
        let equation = &mut system.equations[number];
        equation.lhs = system.flat.exprs.add(leaf);
        equation.rhs = value;
        let origin = equation.origin.clone();
        system.dependent.push(Dependent {
            var: cell.0,
            element: cell.1,
            len: 1,
            origin,
        });
        system.rewrite_all(None, |_, expr| {
            (expr == Expr::Der(cell.0, System::cell_index(cell))).then_some(rate)
        });
        return true;
    }
    false
}

/// The cells of continuous variables that stand under `der` anywhere in the equations.
pub(crate) fn differentiated(system: &System) -> Cells {
    let mut found = Cells::default();
    let sides = system.equations.iter().map(|e| (e.range, [e.lhs, e.rhs]));
    let branches = system
        .slots
        .iter()
        .flat_map(|s| &s.branches)
        .map(|b| (Range::SCALAR, [b.lhs, b.rhs]));
    for (range, sides) in sides.chain(branches) {
        for id in system.flat.exprs.below(&sides) {
            if let Expr::Der(var, index) = system.flat.exprs[id] {
                let (first, last) = System::interval(index, range);
                found.insert(var, first, last);
            }
        }
    }
    found
}

/// The variables of an equation if it has no derivative and every variable in it can be differentiated.
fn state_leaves(system: &System, lhs: ExprId, rhs: ExprId, states: &Cells) -> Option<Vec<Cell>> {
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
                if !states.contains(&cell) && !derivable(system, cell, states, 0) {
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

/// Whether a cell has an explicit value whose variables can all be differentiated.
fn derivable(system: &System, cell: Cell, states: &Cells, depth: usize) -> bool {
    let Some((_, rhs)) = explicit_equation(system, cell) else {
        return false;
    };
    if depth > 50 {
        return false;
    }
    system.flat.exprs.below(&[rhs]).into_iter().all(|id| {
        let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
            return true;
        };
        match system.flat.variables[var].kind {
            _ if derivative => false,
            VariableKind::Continuous => System::cell(var, index).is_some_and(|inner| {
                inner != cell
                    && (states.contains(&inner) || derivable(system, inner, states, depth + 1))
            }),
            VariableKind::Discrete | VariableKind::Held(..) => true,
            VariableKind::Clocked(_)
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => false,
        }
    })
}

/// `cell = rhs`, as an equation says it.
fn explicit_equation(system: &System, cell: Cell) -> Option<(usize, ExprId)> {
    let leaf = Expr::Var(cell.0, System::cell_index(cell));
    let found = system.equations.iter().enumerate().find(|(_, equation)| {
        equation.range == Range::SCALAR && system.flat.exprs[equation.lhs] == leaf
    });
    found.map(|(number, equation)| (number, equation.rhs))
}

/// The time derivative of an expression of states, inputs of which nothing moves, and derivable variables.
fn derivative(
    system: &mut System,
    id: ExprId,
    of: Cell,
    states: &Cells,
    depth: usize,
) -> Option<ExprId> {
    if depth > 50 {
        return None;
    }
    let leaves: Vec<Cell> = system
        .flat
        .exprs
        .below(&[id])
        .into_iter()
        .filter_map(|id| {
            let Expr::Var(var, index) = system.flat.exprs[id] else {
                return None;
            };
            System::cell(var, index).filter(|_| system.is_continuous(var))
        })
        .collect();
    let mut rates = BTreeMap::new();
    for cell in leaves {
        if cell == of {
            return None;
        }
        let rate = if states.contains(&cell) {
            system
                .exprs()
                .add(Expr::Der(cell.0, System::cell_index(cell)))
        } else {
            let (_, value) = explicit_equation(system, cell)?;
            derivative(system, value, of, states, depth + 1)?
        };
        rates.insert(cell, rate);
    }
    Some(by_rates(system, id, &rates))
}

/// The time derivative of an expression by the chain rule; variables without a rate do not change.
pub(crate) fn by_rates(system: &mut System, id: ExprId, rates: &BTreeMap<Cell, ExprId>) -> ExprId {
    let one = system.exprs().constant(1.0);
    system.flat.exprs.tangent(id, |_, leaf| {
        if leaf == Expr::Time {
            return Some(one);
        }
        let Expr::Var(var, index) = leaf else {
            return None;
        };
        rates.get(&System::cell(var, index)?).copied()
    })
}
