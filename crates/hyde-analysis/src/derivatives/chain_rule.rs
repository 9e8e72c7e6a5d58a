//! The time derivative of an expression by the chain rule.

use crate::system::{Cell, System};
use hyde_ir::{Expr, ExprId};
use std::collections::BTreeMap;

/// The time derivative of an expression; variables without a rate do not change.
pub(crate) fn by_rates(system: &mut System, id: ExprId, rates: &BTreeMap<Cell, ExprId>) -> ExprId {
    system.note_differentiated(id);
    attempt_by_rates(system, id, rates)
}

/// The same without a note of the inputs in it: what it is for may fail yet.
pub(super) fn attempt_by_rates(
    system: &mut System,
    id: ExprId,
    rates: &BTreeMap<Cell, ExprId>,
) -> ExprId {
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
