//! What an equation of a mode says of states: variables that other equations give explicitly are replaced by their values.
//!
//! ```text
//! mode stuck { far.w = 0; }  with  far.w = motor.w/20        says  motor.w/20 = 0
//! ```

use crate::solve::solve_for;
use crate::system::{Branch, Cell, System};
use hyde_ir::{Expr, ExprId, Memo, Range};
use std::collections::BTreeMap;

/// Explicit values within each other at most.
const MAX_DEPTH: usize = 50;

/// The explicit values of the scalars that are no states.
pub(crate) struct Values<'a> {
    explicit: BTreeMap<Cell, ExprId>,
    is_state: &'a dyn Fn(Cell) -> bool,
}

impl<'a> Values<'a> {
    pub(crate) fn new(system: &mut System, is_state: &'a dyn Fn(Cell) -> bool) -> Self {
        let mut explicit = BTreeMap::new();
        let mut implicit = Vec::new();
        for equation in system.equations.iter().filter(|e| e.range == Range::SCALAR) {
            let sides = (equation.lhs, equation.rhs);
            let derivative = |expr| matches!(expr, Expr::Der(..));
            if [sides.0, sides.1]
                .iter()
                .any(|&side| system.flat.exprs.any(side, derivative))
            {
                continue;
            }
            let left = match system.flat.exprs[equation.lhs].access() {
                Some((var, index, _)) if system.is_continuous(var) => System::cell(var, index),
                Some(_) | None => None,
            };
            match left.filter(|&cell| !is_state(cell)) {
                Some(cell) => drop(explicit.insert(cell, equation.rhs)),
                None => implicit.push(sides),
            }
        }
        // Where one variable stands among states, the equation gives that one.
        for (lhs, rhs) in implicit {
            let Some(cell) = only_unknown(system, [lhs, rhs], is_state) else {
                continue;
            };
            let leaf = Expr::Var(cell.0, System::cell_index(cell));
            if let Some(value) = solve_for(&mut system.flat.exprs, lhs, rhs, leaf) {
                explicit.entry(cell).or_insert(value);
            }
        }
        Self { explicit, is_state }
    }

    /// Left less right side of a mode's equation in terms of states and of what is known, with the states; `None` if it has
    /// anything else in it.
    pub(crate) fn of(&self, system: &mut System, branch: &Branch) -> Option<(ExprId, Vec<Cell>)> {
        let residual = system.flat.exprs.minus(branch.lhs, branch.rhs);
        let mut states = Vec::new();
        let inlined = self.inlined(system, residual, &mut states, 0)?;
        states.sort_unstable();
        states.dedup();
        Some((inlined, states))
    }

    fn inlined(
        &self,
        system: &mut System,
        id: ExprId,
        states: &mut Vec<Cell>,
        depth: usize,
    ) -> Option<ExprId> {
        if depth > MAX_DEPTH {
            return None;
        }
        let mut memo = Memo::default();
        for below in system.flat.exprs.below(&[id]) {
            let Some((var, index, derivative)) = system.flat.exprs[below].access() else {
                continue;
            };
            if !system.is_continuous(var) {
                continue;
            }
            let cell = System::cell(var, index).filter(|_| !derivative)?;
            if (self.is_state)(cell) {
                states.push(cell);
                continue;
            }
            let value = *self.explicit.get(&cell)?;
            let value = self.inlined(system, value, states, depth + 1)?;
            memo.insert(below, value);
        }
        Some(system.flat.exprs.rewrite(id, &mut memo, |_, _, _| None))
    }
}

/// The one variable of an equation without derivatives that is no state; `None` if there are others.
fn only_unknown(
    system: &System,
    sides: [ExprId; 2],
    is_state: &dyn Fn(Cell) -> bool,
) -> Option<Cell> {
    let mut found = None;
    for id in system.flat.exprs.below(&sides) {
        let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
            continue;
        };
        if !system.is_continuous(var) {
            continue;
        }
        let cell = System::cell(var, index).filter(|_| !derivative)?;
        if !is_state(cell) && found.replace(cell).is_some_and(|before| before != cell) {
            return None;
        }
    }
    found
}
