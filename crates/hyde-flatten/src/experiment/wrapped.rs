//! What a measured channel shows of a quantity that begins again: an angle within its turn, a counter within its range.
//!
//! `mod(x, m)`, `x - floor_to(x, m)` and the like are x but for whole multiples of m, and `atan2(y, x)` is an angle but for
//! whole turns. A quantiser looks alike and is not: its step is an error, a wrap's step is none. So what wraps is taken as x
//! with the period m, and a comparison with a record is modulo that.

use hyde_ir::{BinaryOp, Expr as Ir, ExprArena, ExprId, UnaryOp};

/// What an expression shows modulo a period, and the period; `None` of one that does not wrap.
pub(super) fn unwrapped(exprs: &mut ExprArena, id: ExprId) -> Option<(ExprId, ExprId)> {
    match exprs[id] {
        Ir::Binary(BinaryOp::Atan2, ..) => {
            let turn = exprs.constant(std::f64::consts::TAU);
            Some((id, turn))
        }
        Ir::Unary(UnaryOp::Neg, a) => {
            let (value, period) = unwrapped(exprs, a)?;
            Some((exprs.unary(UnaryOp::Neg, value), period))
        }
        Ir::Unary(op @ (UnaryOp::Floor | UnaryOp::Ceil), a) => {
            let (value, period) = unwrapped(exprs, a)?;
            Some((exprs.unary(op, value), period))
        }
        Ir::Binary(op @ (BinaryOp::FloorTo | BinaryOp::RoundTo), a, step) => {
            let (value, period) = unwrapped(exprs, a)?;
            Some((exprs.binary(op, value, step), period))
        }
        Ir::Binary(op @ (BinaryOp::Add | BinaryOp::Sub), a, b) => {
            if op == BinaryOp::Sub
                && let Some(period) = whole_steps_of(exprs, b, a)
            {
                return Some((a, period));
            }
            let (a, b, period) = match unwrapped(exprs, a) {
                Some((a, period)) => (a, b, period),
                None => {
                    let (b, period) = unwrapped(exprs, b)?;
                    (a, b, period)
                }
            };
            Some((exprs.binary(op, a, b), period))
        }
        Ir::Binary(op @ (BinaryOp::Mul | BinaryOp::Div), a, b) if exprs.is_parametric(b) => {
            let (value, period) = unwrapped(exprs, a)?;
            Some((exprs.binary(op, value, b), exprs.binary(op, period, b)))
        }
        Ir::Binary(BinaryOp::Mul, a, b) if exprs.is_parametric(a) => {
            let (value, period) = unwrapped(exprs, b)?;
            Some((exprs.times(a, value), exprs.times(a, period)))
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

/// The step of an expression that follows another one in whole steps.
fn whole_steps_of(exprs: &mut ExprArena, steps: ExprId, followed: ExprId) -> Option<ExprId> {
    let (argument, step) = if let Ir::Binary(op, a, step) = exprs[steps]
        && matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo)
    {
        (a, step)
    } else if let Some(a) = whole_of(exprs, steps) {
        (a, exprs.constant(1.0))
    } else if let Ir::Binary(BinaryOp::Mul, a, b) = exprs[steps] {
        let (whole, step) = match whole_of(exprs, a) {
            Some(whole) => (whole, b),
            None => (whole_of(exprs, b)?, a),
        };
        (times_step(exprs, whole, step)?, step)
    } else {
        return None;
    };
    let same = moving_part(exprs, argument) == moving_part(exprs, followed);
    (same && exprs.is_parametric(step)).then_some(step)
}

/// What an expression is the whole part of.
fn whole_of(exprs: &ExprArena, id: ExprId) -> Option<ExprId> {
    if let Ir::Unary(op, a) = exprs[id]
        && matches!(op, UnaryOp::Floor | UnaryOp::Ceil)
    {
        Some(a)
    } else {
        None
    }
}

/// What `whole` is the part by `step` of: of `x/step`, and of `x/step + 0.5`, it is x.
fn times_step(exprs: &ExprArena, whole: ExprId, step: ExprId) -> Option<ExprId> {
    if let Ir::Binary(BinaryOp::Div, x, by) = exprs[moving_part(exprs, whole)] {
        (by == step).then_some(x)
    } else {
        None
    }
}

/// An expression without what is added to it of parameters and numbers alone.
fn moving_part(exprs: &ExprArena, id: ExprId) -> ExprId {
    if let Ir::Binary(op, a, b) = exprs[id]
        && matches!(op, BinaryOp::Add | BinaryOp::Sub)
    {
        if exprs.is_parametric(b) {
            return moving_part(exprs, a);
        }
        if op == BinaryOp::Add && exprs.is_parametric(a) {
            return moving_part(exprs, b);
        }
    }
    id
}
