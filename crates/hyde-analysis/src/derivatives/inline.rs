//! Constraints between states that go through variables which are none: those are replaced by their values.
//!
//! ```text
//! a.phi_rel = i1.phi - p;  b.phi_rel = i2.phi - p;  a.phi_rel = n*b.phi_rel      says  i1.phi - p = n*(i2.phi - p)
//! ```
//! Each variable that is no state is taken from one equation, and no equation is taken twice: so k equations give k
//! variables, and what is left over relates states alone.

use crate::cells::Cells;
use crate::solve::solve_for;
use crate::system::{Cell, System};
use hyde_ir::{Expr, ExprId, Memo, Range, VariableKind};
use std::collections::{BTreeMap, BTreeSet};

/// Variables looked at for one equation at most: a constraint goes through few.
const MAX_VARIABLES: usize = 200;

/// A constraint: the number of its equation, its sides in states alone, and the states.
type Constraint = (usize, ExprId, ExprId, Vec<Cell>);

/// The equations that relate states alone once everything else in them is replaced.
pub(super) fn constraints(
    system: &mut System,
    declared: &[Vec<f64>],
    states: &Cells,
) -> Vec<Constraint> {
    let mut usable: Vec<(usize, Vec<Cell>)> = (0..system.equations.len())
        .filter_map(|number| Some((number, variables(system, number)?)))
        .collect();
    leave_out_ends(&mut usable, states);
    let mut of: BTreeMap<Cell, Vec<usize>> = BTreeMap::new();
    for (number, cells) in &usable {
        for &cell in cells.iter().filter(|cell| !states.contains(cell)) {
            of.entry(cell).or_default().push(*number);
        }
    }
    let mut found = Vec::new();
    for (number, cells) in usable {
        if cells.iter().all(|cell| states.contains(cell)) {
            continue;
        }
        let mut search = Search {
            of: &of,
            states,
            declared,
            used: vec![number],
            values: BTreeMap::new(),
            left: MAX_VARIABLES,
        };
        if !cells.iter().all(|&cell| search.value(system, cell)) {
            continue;
        }
        let values = search.values;
        let (lhs, rhs) = (system.equations[number].lhs, system.equations[number].rhs);
        let (lhs, rhs) = (
            replaced(system, &values, lhs),
            replaced(system, &values, rhs),
        );
        let leaves = system.flat.exprs.below(&[lhs, rhs]).into_iter();
        let cells = leaves.filter_map(|id| cell_of(system, system.flat.exprs[id]));
        let mut cells: Vec<Cell> = cells.collect();
        cells.sort_unstable();
        cells.dedup();
        found.push((number, lhs, rhs, cells));
    }
    found
}

/// Leaves out equations that have a variable of their own, for no other equation gives it a value; then those that have one once
/// these are gone, and so on. What is left is on ways around.
fn leave_out_ends(equations: &mut Vec<(usize, Vec<Cell>)>, states: &Cells) {
    let mut of: BTreeMap<Cell, BTreeSet<usize>> = BTreeMap::new();
    for (at, (_, cells)) in equations.iter().enumerate() {
        for &cell in cells.iter().filter(|cell| !states.contains(cell)) {
            of.entry(cell).or_default().insert(at);
        }
    }
    let mut stays = vec![true; equations.len()];
    let only = |of: &BTreeSet<usize>| of.first().copied().filter(|_| of.len() == 1);
    let mut ends: Vec<usize> = of.values().filter_map(only).collect();
    while let Some(at) = ends.pop() {
        if !std::mem::replace(&mut stays[at], false) {
            continue;
        }
        for cell in &equations[at].1 {
            if let Some(others) = of.get_mut(cell) {
                others.remove(&at);
                ends.extend(only(others));
            }
        }
    }
    let mut stays = stays.into_iter();
    equations.retain(|_| stays.next() == Some(true));
}

/// The values found for one equation.
struct Search<'a> {
    of: &'a BTreeMap<Cell, Vec<usize>>,
    states: &'a Cells,
    declared: &'a [Vec<f64>],
    used: Vec<usize>,
    values: BTreeMap<Cell, ExprId>,
    left: usize,
}

impl Search<'_> {
    /// Whether a variable is a state or has a value in states; the value is kept.
    fn value(&mut self, system: &mut System, cell: Cell) -> bool {
        if self.states.contains(&cell) || self.values.contains_key(&cell) {
            return true;
        }
        let leaf = Expr::Var(cell.0, System::cell_index(cell));
        for &number in self.of.get(&cell).into_iter().flatten() {
            if self.left == 0 || self.used.contains(&number) {
                continue;
            }
            self.left -= 1;
            let (lhs, rhs) = (system.equations[number].lhs, system.equations[number].rhs);
            let Some(value) = solve_for(&mut system.flat.exprs, lhs, rhs, leaf) else {
                continue;
            };
            if system.divides_by_zero(self.declared, lhs, rhs, leaf) {
                continue;
            }
            self.used.push(number);
            let below = system.flat.exprs.below(&[value]).into_iter();
            let cells: Vec<Cell> = below
                .filter_map(|id| cell_of(system, system.flat.exprs[id]))
                .collect();
            if cells.into_iter().all(|inner| self.value(system, inner)) {
                let value = replaced(system, &self.values, value);
                self.values.insert(cell, value);
                return true;
            }
            self.used.pop();
        }
        false
    }
}

/// The continuous variables of a scalar equation; `None` if it has a derivative or what cannot be differentiated.
fn variables(system: &System, number: usize) -> Option<Vec<Cell>> {
    let equation = &system.equations[number];
    if equation.range != Range::SCALAR {
        return None;
    }
    let mut cells = Vec::new();
    for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
        let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
            continue;
        };
        match system.flat.variables[var].kind {
            _ if derivative => return None,
            VariableKind::Continuous => cells.push(System::cell(var, index)?),
            VariableKind::Discrete | VariableKind::Held(..) => {}
            VariableKind::Clocked(_)
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => {
                return None;
            }
        }
    }
    Some(cells)
}

/// The continuous variable that a leaf is.
fn cell_of(system: &System, leaf: Expr) -> Option<Cell> {
    let Expr::Var(var, index) = leaf else {
        return None;
    };
    System::cell(var, index).filter(|_| system.is_continuous(var))
}

/// An expression with every variable that has a value replaced by it.
fn replaced(system: &mut System, values: &BTreeMap<Cell, ExprId>, id: ExprId) -> ExprId {
    let mut memo = Memo::default();
    system.flat.exprs.rewrite(id, &mut memo, |_, _, expr| {
        let Expr::Var(var, index) = expr else {
            return None;
        };
        values.get(&System::cell(var, index)?).copied()
    })
}
