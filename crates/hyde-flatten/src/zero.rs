//! Temperatures with a zero point of their own: the difference of two of them is in K.
//!
//! Inside there are kelvins alone, and `20 [degC]` is 293.15 K. So a difference that is declared in degC would be shown
//! 273.15 too low, and `T + 5 [degC]` adds 278.15 K.

use crate::instance::{Typed, VariableNotes};
use crate::refusals::dimensions as refused;
use crate::shown::quantity_of;
use hyde_diag::{Diagnostic, Sources};
use hyde_ir::{BinaryOp, Expr, ExprId, FlatModel, Id as _, Quantity};

/// What is known of the zero point of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Zero {
    /// Nothing.
    Open,
    /// It counts from a zero point of its own: 20 degC.
    Own,
    /// It is the difference of two such values.
    Difference,
}

impl Zero {
    /// The zero point of a sum or a difference.
    pub(crate) fn of_sum(op: BinaryOp, a: Self, b: Self) -> Self {
        let own = a == Self::Own || b == Self::Own;
        match (a, b) {
            (Self::Own, Self::Difference) if op == BinaryOp::Sub => Self::Own,
            _ if own && op == BinaryOp::Sub => Self::Difference,
            _ if own => Self::Own,
            _ => Self::Open,
        }
    }

    /// The zero point of what is read: that of its declared unit.
    pub(crate) fn of_name(flat: &FlatModel, notes: &[VariableNotes<'_>], id: ExprId) -> Self {
        if let Expr::Var(var, _) = flat.exprs[id]
            && notes[var.index()].difference
        {
            return Self::Difference;
        }
        match quantity_of(flat, id) {
            Some(quantity) if quantity.unit.unit().is_absolute() => Self::Own,
            Some(_) | None => Self::Open,
        }
    }
}

/// What to say of a literal in degC that is added: its zero point is added as well.
pub(crate) fn added_as_difference(
    op: BinaryOp,
    (a, b): (&Typed, &Typed),
    sources: &Sources,
    flat: &FlatModel,
) -> Option<Diagnostic> {
    if op == BinaryOp::Sub {
        return None;
    }
    let (literal, _) = [(b, a), (a, b)].into_iter().find(|(literal, other)| {
        let is_literal = flat.exprs.as_constant(literal.id).is_some();
        literal.zero == Zero::Own && is_literal && other.zero != Zero::Difference
    })?;
    let text = sources.text(literal.span);
    let number = text.split('[').next().unwrap_or("").trim();
    let unit = literal
        .dim
        .as_known()
        .map_or_else(String::new, |dim| dim.usual_unit());
    Some(refused::zero_point_added(literal.span, number, &unit))
}

/// What is set to a difference is shown as one: in K where its type says degC.
pub(crate) fn show_difference(
    flat: &mut FlatModel,
    notes: &mut [VariableNotes<'_>],
    (target, value): (&Typed, &Typed),
) {
    if value.zero != Zero::Difference {
        return;
    }
    let Expr::Var(var, _) = flat.exprs[target.id] else {
        return;
    };
    let quantity = &mut flat.variables[var].quantity;
    if quantity.unit.unit().is_absolute() {
        *quantity = Quantity::usual(quantity.dimension);
    }
    notes[var.index()].difference = true;
}
