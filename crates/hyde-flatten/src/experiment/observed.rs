//! What a measured channel is to an observer: the quantity before its quantiser, read at the instant of the row.
//!
//! A rounding to steps of q is the quantity itself with an error that is uniform within a step: round_to has the mean
//! error 0, floor_to -q/2, and either the variance q^2/12. The mean is taken into the value, the width of the error is
//! kept beside it. A clocked variable that is an assignment of samples alone is what it assigns. What wraps is no quantiser:
//! see [`super::wrapped`].

use super::wrapped::unwrapped;
use crate::model::call::clocks_of;
use hyde_ir::{
    BinaryOp, Expr as Ir, ExprArena, ExprId, FlatModel, Index, Memo, UnaryOp, VariableKind,
};

/// How deep clocked variables may be defined by each other.
const MAX_DEPTH: usize = 40;

/// The value without clocks and quantisers, and the width of the error that these make, if there are any; of one that
/// wraps, what it is before that.
pub(super) fn observed(flat: &mut FlatModel, value: ExprId) -> (ExprId, Option<ExprId>) {
    let sampled = without_clocks(flat, value, 0);
    let sampled = match unwrapped(&mut flat.exprs, sampled) {
        Some((unwrapped, _)) => unwrapped,
        None => sampled,
    };
    match width(&mut flat.exprs, sampled) {
        Some(width) => (without_quantisers(&mut flat.exprs, sampled), Some(width)),
        None => (sampled, None),
    }
}

/// The period with which a value begins again.
pub(super) fn period(flat: &mut FlatModel, value: ExprId) -> Option<ExprId> {
    let sampled = without_clocks(flat, value, 0);
    unwrapped(&mut flat.exprs, sampled).map(|(_, period)| period)
}

/// Clocked variables replaced by what is assigned to them, as far as that has no memory.
fn without_clocks(flat: &mut FlatModel, id: ExprId, depth: usize) -> ExprId {
    let mut memo = Memo::default();
    for below in flat.exprs.below(&[id]) {
        let Ir::Var(var, Index::SCALAR) = flat.exprs[below] else {
            continue;
        };
        if !matches!(flat.variables[var].kind, VariableKind::Clocked(_)) || depth > MAX_DEPTH {
            continue;
        }
        let mut assigned = flat.clocked_equations.iter();
        let Some(found) = assigned.find(|e| e.equation.lhs == below) else {
            continue;
        };
        let value = without_clocks(flat, found.equation.rhs, depth + 1);
        let remembers = flat.exprs.any(value, |expr| matches!(expr, Ir::Pre(..)));
        if !remembers && clocks_of(flat, value).is_empty() {
            memo.insert(below, value);
        }
    }
    flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
}

/// The width of the uniform error that a quantiser makes in an expression that is linear in it: its step, times
/// parameters. `None` without a quantiser, and where it stands in anything else.
fn width(exprs: &mut ExprArena, id: ExprId) -> Option<ExprId> {
    match exprs[id] {
        Ir::Binary(BinaryOp::FloorTo | BinaryOp::RoundTo, _, step) => Some(step),
        Ir::Unary(UnaryOp::Floor | UnaryOp::Ceil, _) => Some(exprs.constant(1.0)),
        Ir::Unary(UnaryOp::Neg, a) => width(exprs, a),
        Ir::Binary(BinaryOp::Add | BinaryOp::Sub, a, b) => match (width(exprs, a), width(exprs, b))
        {
            (Some(width), None) | (None, Some(width)) => Some(width),
            (Some(_), Some(_)) | (None, None) => None,
        },
        Ir::Binary(op @ (BinaryOp::Mul | BinaryOp::Div), a, b) if exprs.is_parametric(b) => {
            let width = width(exprs, a)?;
            Some(exprs.binary(op, width, b))
        }
        Ir::Binary(BinaryOp::Mul, a, b) if exprs.is_parametric(a) => {
            let width = width(exprs, b)?;
            Some(exprs.times(a, width))
        }
        Ir::Const(_)
        | Ir::Time
        | Ir::Counter
        | Ir::Param(..)
        | Ir::Var(..)
        | Ir::Der(..)
        | Ir::Pre(..)
        | Ir::Relation(_)
        | Ir::InMode(..)
        | Ir::Unary(..)
        | Ir::Binary(..)
        | Ir::If(..)
        | Ir::NoEvent(_) => None,
    }
}

/// Each quantiser replaced by its mean over the error.
fn without_quantisers(exprs: &mut ExprArena, id: ExprId) -> ExprId {
    let mut memo = Memo::default();
    for below in exprs.below(&[id]) {
        let one = exprs.constant(1.0);
        let (value, step, part) = if let Ir::Binary(op, a, step) = exprs[below]
            && matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo)
        {
            (a, step, if op == BinaryOp::FloorTo { -0.5 } else { 0.0 })
        } else if let Ir::Unary(op, a) = exprs[below]
            && matches!(op, UnaryOp::Floor | UnaryOp::Ceil)
        {
            (a, one, if op == UnaryOp::Floor { -0.5 } else { 0.5 })
        } else {
            continue;
        };
        let inner = exprs.rewrite(value, &mut memo, |_, _, _| None);
        let part = exprs.constant(part);
        let shift = exprs.times(part, step);
        let mean = exprs.plus(inner, shift);
        memo.insert(below, mean);
    }
    exprs.rewrite(id, &mut memo, |_, _, _| None)
}
