//! What a measured channel shows of a quantity that begins again: an angle within its turn, a counter within its range.
//!
//! `mod(x, m)`, `x - floor_to(x, m)` and the like are x but for whole multiples of m, and `atan2(y, x)` is an angle but for
//! whole turns. A quantiser looks alike and is not: its step is an error, a wrap's step is none. So what wraps is taken as x
//! with the period m, and a comparison with a record is modulo that.

use crate::model::Model;
use hyde_ir::{BinaryOp, Expr as Ir, ExprId, UnaryOp};

impl Model<'_, '_> {
    /// What an expression shows modulo a period, and the period; `None` of one that does not wrap.
    pub(super) fn unwrapped(&mut self, id: ExprId) -> Option<(ExprId, ExprId)> {
        let exprs = &mut self.flat.exprs;
        match exprs[id] {
            Ir::Binary(BinaryOp::Atan2, ..) => {
                let turn = exprs.constant(std::f64::consts::TAU);
                Some((id, turn))
            }
            Ir::Unary(UnaryOp::Neg, a) => {
                let (value, period) = self.unwrapped(a)?;
                Some((self.flat.exprs.unary(UnaryOp::Neg, value), period))
            }
            Ir::Unary(op @ (UnaryOp::Floor | UnaryOp::Ceil), a) => {
                let (value, period) = self.unwrapped(a)?;
                Some((self.flat.exprs.unary(op, value), period))
            }
            Ir::Binary(op @ (BinaryOp::FloorTo | BinaryOp::RoundTo), a, step) => {
                let (value, period) = self.unwrapped(a)?;
                Some((self.flat.exprs.binary(op, value, step), period))
            }
            Ir::Binary(op @ (BinaryOp::Add | BinaryOp::Sub), a, b) => {
                if op == BinaryOp::Sub
                    && let Some(period) = self.whole_steps_of(b, a)
                {
                    return Some((a, period));
                }
                let (a, b, period) = match self.unwrapped(a) {
                    Some((a, period)) => (a, b, period),
                    None => {
                        let (b, period) = self.unwrapped(b)?;
                        (a, b, period)
                    }
                };
                Some((self.flat.exprs.binary(op, a, b), period))
            }
            Ir::Binary(op @ (BinaryOp::Mul | BinaryOp::Div), a, b) if exprs.is_parametric(b) => {
                let (value, period) = self.unwrapped(a)?;
                let exprs = &mut self.flat.exprs;
                Some((exprs.binary(op, value, b), exprs.binary(op, period, b)))
            }
            Ir::Binary(BinaryOp::Mul, a, b) if exprs.is_parametric(a) => {
                let (value, period) = self.unwrapped(b)?;
                let exprs = &mut self.flat.exprs;
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
    fn whole_steps_of(&mut self, steps: ExprId, followed: ExprId) -> Option<ExprId> {
        let exprs = &self.flat.exprs;
        let (argument, step) = if let Ir::Binary(op, a, step) = exprs[steps]
            && matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo)
        {
            (a, step)
        } else if let Some(a) = self.whole_of(steps) {
            (a, self.flat.exprs.constant(1.0))
        } else if let Ir::Binary(BinaryOp::Mul, a, b) = exprs[steps] {
            let (whole, step) = match self.whole_of(a) {
                Some(whole) => (whole, b),
                None => (self.whole_of(b)?, a),
            };
            (self.times_step(whole, step)?, step)
        } else {
            return None;
        };
        let same = self.moving_part(argument) == self.moving_part(followed);
        (same && self.flat.exprs.is_parametric(step)).then_some(step)
    }

    /// What an expression is the whole part of.
    fn whole_of(&self, id: ExprId) -> Option<ExprId> {
        if let Ir::Unary(op, a) = self.flat.exprs[id]
            && matches!(op, UnaryOp::Floor | UnaryOp::Ceil)
        {
            Some(a)
        } else {
            None
        }
    }

    /// What `whole` is the part by `step` of: of `x/step`, and of `x/step + 0.5`, it is x.
    fn times_step(&self, whole: ExprId, step: ExprId) -> Option<ExprId> {
        if let Ir::Binary(BinaryOp::Div, x, by) = self.flat.exprs[self.moving_part(whole)] {
            (by == step).then_some(x)
        } else {
            None
        }
    }

    /// An expression without what is added to it of parameters and numbers alone.
    fn moving_part(&self, id: ExprId) -> ExprId {
        let exprs = &self.flat.exprs;
        if let Ir::Binary(op, a, b) = exprs[id]
            && matches!(op, BinaryOp::Add | BinaryOp::Sub)
        {
            if exprs.is_parametric(b) {
                return self.moving_part(a);
            }
            if op == BinaryOp::Add && exprs.is_parametric(a) {
                return self.moving_part(b);
            }
        }
        id
    }
}
