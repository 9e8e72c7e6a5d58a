//! What a measured channel is to an observer: the quantity before its quantiser, read at the instant of the row.
//!
//! A rounding to steps of q is the quantity itself with an error that is uniform within a step: round_to has the mean
//! error 0, floor_to -q/2, and either the variance q^2/12. The mean is taken into the value, the width of the error is
//! kept beside it. A clocked variable that is an assignment of samples alone is what it assigns. What wraps is no quantiser:
//! see [`super::wrapped`].

use crate::model::Model;
use hyde_ir::{BinaryOp, Expr as Ir, ExprId, Index, Memo, UnaryOp, VariableKind};

/// How deep clocked variables may be defined by each other.
const MAX_DEPTH: usize = 40;

impl Model<'_, '_> {
    /// The value without clocks and quantisers, and the width of the error that these make, if there are any; of one that
    /// wraps, what it is before that.
    pub(super) fn observed(&mut self, value: ExprId) -> (ExprId, Option<ExprId>) {
        let sampled = self.without_clocks(value, 0);
        let sampled = match self.unwrapped(sampled) {
            Some((unwrapped, _)) => unwrapped,
            None => sampled,
        };
        match self.width(sampled) {
            Some(width) => (self.without_quantisers(sampled), Some(width)),
            None => (sampled, None),
        }
    }

    /// The period with which a value begins again.
    pub(super) fn period(&mut self, value: ExprId) -> Option<ExprId> {
        let sampled = self.without_clocks(value, 0);
        self.unwrapped(sampled).map(|(_, period)| period)
    }

    /// Clocked variables replaced by what is assigned to them, as far as that has no memory.
    fn without_clocks(&mut self, id: ExprId, depth: usize) -> ExprId {
        let mut memo = Memo::default();
        for below in self.flat.exprs.below(&[id]) {
            let Ir::Var(var, Index::SCALAR) = self.flat.exprs[below] else {
                continue;
            };
            if !matches!(self.flat.variables[var].kind, VariableKind::Clocked(_))
                || depth > MAX_DEPTH
            {
                continue;
            }
            let mut assigned = self.flat.clocked_equations.iter();
            let Some(found) = assigned.find(|e| e.equation.lhs == below) else {
                continue;
            };
            let value = self.without_clocks(found.equation.rhs, depth + 1);
            let remembers = self
                .flat
                .exprs
                .any(value, |expr| matches!(expr, Ir::Pre(..)));
            if !remembers && self.clocks_of(value).is_empty() {
                memo.insert(below, value);
            }
        }
        self.flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
    }

    /// The width of the uniform error that a quantiser makes in an expression that is linear in it: its step, times
    /// parameters. `None` without a quantiser, and where it stands in anything else.
    fn width(&mut self, id: ExprId) -> Option<ExprId> {
        let exprs = &mut self.flat.exprs;
        match exprs[id] {
            Ir::Binary(BinaryOp::FloorTo | BinaryOp::RoundTo, _, step) => Some(step),
            Ir::Unary(UnaryOp::Floor | UnaryOp::Ceil, _) => Some(exprs.constant(1.0)),
            Ir::Unary(UnaryOp::Neg, a) => self.width(a),
            Ir::Binary(BinaryOp::Add | BinaryOp::Sub, a, b) => match (self.width(a), self.width(b))
            {
                (Some(width), None) | (None, Some(width)) => Some(width),
                (Some(_), Some(_)) | (None, None) => None,
            },
            Ir::Binary(op @ (BinaryOp::Mul | BinaryOp::Div), a, b) if exprs.is_parametric(b) => {
                let width = self.width(a)?;
                Some(self.flat.exprs.binary(op, width, b))
            }
            Ir::Binary(BinaryOp::Mul, a, b) if exprs.is_parametric(a) => {
                let width = self.width(b)?;
                Some(self.flat.exprs.times(a, width))
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
    fn without_quantisers(&mut self, id: ExprId) -> ExprId {
        let mut memo = Memo::default();
        for below in self.flat.exprs.below(&[id]) {
            let exprs = &mut self.flat.exprs;
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
        self.flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
    }
}
