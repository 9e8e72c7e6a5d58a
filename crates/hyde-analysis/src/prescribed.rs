//! Friction on a motion that is prescribed: no mode can hold it.
//!
//! ```text
//! w = w_ref(time);  mode stuck { w = 0; exit tau > hold -> forward; … }  mode forward { tau = grip; exit w < 0 -> stuck; }
//! ```
//! While w passes zero the mode has nothing to say of the force, and nothing would ever bring the run out of it. So the mode
//! takes the equation of another one for its force, and its exits are open as soon as the motion is not what the mode
//! fixes, each for as long as the mode it leads to would not be left at once. That is told as a warning.

use crate::alias::signed_cell;
use crate::pins::Values;
use crate::refusals::states as refused;
use crate::regularity::noun;
use crate::segments;
use crate::system::{Branch, Cell, System};
use hyde_diag::{Diagnostic, Diagnostics};
use hyde_ir::flat::{Action, Transition};
use hyde_ir::{BinaryOp, Expr, ExprId, Memo, UnaryOp};

/// Lets modes go on that fix what is prescribed.
pub(crate) fn let_move(system: &mut System, diagnostics: &mut Diagnostics) {
    if system.slots.is_empty() {
        return;
    }
    let states = segments::state_cells(system);
    let is_state = |cell: Cell| states.contains(&cell);
    let values = Values::new(system, &is_state);
    for slot in 0..system.slots.len() {
        let branches = system.slots[slot].branches.clone();
        let said: Vec<Option<ExprId>> = branches
            .iter()
            .map(|branch| prescribed(system, &values, branch))
            .collect();
        let other = branches
            .iter()
            .zip(&said)
            .find(|(_, known)| known.is_none());
        let Some((other, _)) = other else { continue };
        for (mode, said) in said.iter().enumerate() {
            let Some(motion) = *said else { continue };
            open_exits(system, slot, mode, motion);
            diagnostics.push(told(system, slot, mode));
            let branch = &mut system.slots[slot].branches[mode];
            (branch.lhs, branch.rhs) = (other.lhs, other.rhs);
        }
    }
}

/// Left less right side of an equation that fixes a speed, of known values that vary.
fn prescribed(system: &mut System, values: &Values<'_>, branch: &Branch) -> Option<ExprId> {
    let speed = |&side: &ExprId| {
        let variable = signed_cell(system, side).map(|((var, _), _)| &system.flat.variables[var]);
        variable.is_some_and(|variable| noun(variable.quantity.dimension) == "speed")
    };
    if ![branch.lhs, branch.rhs].iter().any(speed) {
        return None;
    }
    let (residual, states) = values.of(system, branch)?;
    (states.is_empty() && !system.is_parametric(residual)).then_some(residual)
}

/// Opens the exits of a mode while `motion` is not zero.
fn open_exits(system: &mut System, slot: usize, mode: usize, motion: ExprId) {
    let automaton = system.slots[slot].automaton;
    let exits = system.flat.automata[automaton].modes[mode].exits.clone();
    let exprs = &mut system.flat.exprs;
    let zero = exprs.constant(0.0);
    let above = exprs.binary(BinaryOp::Gt, motion, zero);
    let below = exprs.binary(BinaryOp::Lt, motion, zero);
    let moves = exprs.binary(BinaryOp::Or, above, below);
    for (number, exit) in exits.iter().enumerate() {
        let next = system.flat.automata[automaton].modes[exit.target]
            .exits
            .clone();
        let exprs = &mut system.flat.exprs;
        let mut open = moves;
        for left in next {
            let guard = with_parameters(exprs, left.guard, exit);
            let stays = exprs.unary(UnaryOp::Not, guard);
            open = exprs.binary(BinaryOp::And, open, stays);
        }
        let guard = exprs.binary(BinaryOp::Or, exit.guard, open);
        system.flat.automata[automaton].modes[mode].exits[number].guard = guard;
    }
}

/// A guard of the mode entered, with the parameters that the exit gives it.
fn with_parameters(exprs: &mut hyde_ir::ExprArena, guard: ExprId, exit: &Transition) -> ExprId {
    exprs.rewrite(guard, &mut Memo::default(), |_, _, expr| {
        let Expr::Var(var, index) = expr else {
            return None;
        };
        exit.actions.iter().find_map(|action| match action {
            Action::Assign(set, at, value) => (*set == var && *at == index).then_some(*value),
            Action::Reinit(..) => None,
        })
    })
}

fn told(system: &System, slot: usize, mode: usize) -> Diagnostic {
    let slot = &system.slots[slot];
    let automaton = &system.flat.automata[slot.automaton];
    let mode = &automaton.modes[mode].name;
    let branch = &slot.branches[0];
    let automaton = (automaton.name.as_str(), automaton.origin.span);
    refused::prescribed(automaton, mode, system.component(&branch.origin))
}
