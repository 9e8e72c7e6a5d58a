//! Marks the branches of slots that fix a state: `w = 0`, or the same said of what is explicit in w.

use super::inlined::Values;
use crate::alias::signed_cell;
use crate::cells::Cells;
use crate::segments::Segment;
use crate::solve::solve_for;
use crate::system::{Branch, Cell, System};
use hyde_ir::{Expr, ExprId, VariableKind};

/// Marks the branches of slots that fix a state.
pub(crate) fn mark(system: &mut System, unknowns: &[Segment]) {
    let mut states = Cells::default();
    for unknown in unknowns.iter().filter(|unknown| unknown.state) {
        states.insert(unknown.var, unknown.first, unknown.last);
    }
    let is_state = |cell: Cell| states.contains(&cell);
    let values = Values::new(system, &is_state);
    for slot in 0..system.slots.len() {
        for number in 0..system.slots[slot].branches.len() {
            let branch = system.slots[slot].branches[number].clone();
            let branch = match said_of_a_state(system, &branch, &is_state) {
                Some(pin) => Branch {
                    pin: Some(pin),
                    ..branch
                },
                None => said_of_states(system, branch, &values),
            };
            system.slots[slot].branches[number] = branch;
        }
    }
}

/// The state and its value of `w = 0`.
fn said_of_a_state(
    system: &mut System,
    branch: &Branch,
    is_state: &dyn Fn(Cell) -> bool,
) -> Option<(Cell, ExprId)> {
    let sides = [(branch.lhs, branch.rhs), (branch.rhs, branch.lhs)];
    let (cell, value, negated) = sides.into_iter().find_map(|(side, value)| {
        let (cell, negated) = signed_cell(system, side)?;
        (is_state(cell) && constant_between_events(system, value)).then_some((cell, value, negated))
    })?;
    let value = match negated {
        true => system.exprs().negative(value),
        false => value,
    };
    Some((cell, value))
}

/// The same where explicit values stand between: of one state it is a pin, of several an equation between states.
fn said_of_states(system: &mut System, branch: Branch, values: &Values<'_>) -> Branch {
    let Some((residual, states)) = values.of(system, &branch) else {
        return branch;
    };
    let zero = system.exprs().constant(0.0);
    if let [cell] = *states.as_slice() {
        let leaf = Expr::Var(cell.0, System::cell_index(cell));
        let value = solve_for(&mut system.flat.exprs, residual, zero, leaf);
        if let Some(value) = value.filter(|&value| constant_between_events(system, value)) {
            return Branch {
                pin: Some((cell, value)),
                ..branch
            };
        }
    }
    if states.is_empty() {
        return branch;
    }
    Branch {
        lhs: residual,
        rhs: zero,
        ..branch
    }
}

/// A value that changes at events only.
fn constant_between_events(system: &System, id: ExprId) -> bool {
    !system.flat.exprs.any(id, |expr| {
        expr == Expr::Time
            || expr.access().is_some_and(|(var, _, derivative)| {
                let kind = system.flat.variables[var].kind;
                derivative || !matches!(kind, VariableKind::Discrete | VariableKind::Held(..))
            })
    })
}
