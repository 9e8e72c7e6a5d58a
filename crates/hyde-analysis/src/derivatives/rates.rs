//! One variable for each derivative: where an equation says `v = der(x)`, every other `der(x)` reads `v`.

use crate::cells::Cells;
use crate::system::{Cell, System};
use hyde_diag::MadeBy;
use hyde_ir::{Expr, ExprId, Index, Memo, Quantity, Range, VarId, Variable, VariableKind};
use std::collections::BTreeMap;

/// `target[j + shift] = der(var[j])` for the elements j in `first..=last`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rate {
    first: usize,
    last: usize,
    target: VarId,
    shift: i32,
    equation: usize,
}

/// Replaces `der(x)` by the variable that an equation `v = der(x)` names, everywhere else.
pub(super) fn name_derivatives(system: &mut System) -> bool {
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
    let reads_derivative = |id| {
        let exprs = &system.flat.exprs;
        exprs.any(id, |expr| matches!(expr, Expr::Der(..)))
    };
    if !reads_derivative(lhs) && !reads_derivative(rhs) {
        return false;
    }
    let own = if let Place::Equation(number) = place {
        Some(number)
    } else {
        None
    };
    let mut memo = Memo::default();
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

/// The equations `v = der(x)`, by x; where several name the same derivative, the one whose v is in an array is kept. An
/// element that an equation over a range differentiates keeps its derivative there, and so everywhere: else the equation
/// would say less of its first cell than of the others.
pub(super) fn rates(system: &System) -> BTreeMap<VarId, Vec<Rate>> {
    let ranged = in_ranges(system);
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
            let scalar = system.flat.variables[target].len.is_none();
            if scalar && ranged.contains(&(var, first)) {
                continue;
            }
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
pub(super) fn covering(
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

/// The elements that equations over ranges differentiate.
fn in_ranges(system: &System) -> Cells {
    let mut found = Cells::default();
    for equation in system.equations.iter().filter(|e| e.range != Range::SCALAR) {
        for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
            if let Expr::Der(var, index) = system.flat.exprs[id] {
                let (first, last) = System::interval(index, equation.range);
                found.insert(var, first, last);
            }
        }
    }
    found
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

/// A new variable for the derivative of a scalar or of an element.
pub(crate) fn new_rate(system: &mut System, cell: Cell) -> Option<ExprId> {
    let name = format!("der({})", system.cell_name(cell));
    let of = &system.flat.variables[cell.0];
    let dimension = of.quantity.dimension.divide(hyde_units::Dimension::TIME);
    let quantity = Quantity::usual(dimension);
    let origin = of.origin.made_by(MadeBy::Derivative);
    let variable = Variable::new(name, VariableKind::Continuous, quantity, origin);
    let id = system.flat.variables.push(variable);
    Some(system.exprs().add(Expr::Var(id, Index::SCALAR)))
}
