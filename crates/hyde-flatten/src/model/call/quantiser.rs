//! `floor`, `ceil`, `integer`, `mod`, `floor_to`, `round_to`: steps, allowed where values are sampled or measured (C5).

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use crate::zero;
use hyde_diag::Span;
use hyde_ir::{BinaryOp, UnaryOp};
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    /// Rounding, allowed where values are sampled or measured (C5).
    pub(super) fn quantiser(
        &mut self,
        name: &str,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        if matches!(scope.setting, Setting::Equation | Setting::Condition) {
            self.report(refused::quantiser_of_continuous(name, span));
        }
        let operands = if matches!(name, "floor" | "ceil" | "integer") {
            let one = self.exactly(name, args, span);
            one.map(|[a]| (self.value(a, scope), self.number_one(span)))
        } else {
            let two = self.exactly(name, args, span);
            two.map(|[a, b]| (self.value(a, scope), self.value(b, scope)))
        };
        let Some((a, b)) = operands else {
            return self.poison(span);
        };
        self.agree(&a, &b, "the step and the value are", scope.instance);
        self.report_any(zero::as_step(&b));
        let arena = &mut self.flat.exprs;
        let id = match name {
            "floor_to" | "round_to" if self.input.additions.shifts_quantisers() => {
                let op = if name == "floor_to" {
                    BinaryOp::FloorTo
                } else {
                    BinaryOp::RoundTo
                };
                let half = arena.constant(0.5);
                let shift = arena.times(half, b.id);
                let shifted = arena.plus(a.id, shift);
                let rounded = arena.binary(op, shifted, b.id);
                arena.minus(rounded, shift)
            }
            "floor" | "integer" => arena.unary(UnaryOp::Floor, a.id),
            "ceil" => arena.unary(UnaryOp::Ceil, a.id),
            "floor_to" => arena.binary(BinaryOp::FloorTo, a.id, b.id),
            "round_to" => arena.binary(BinaryOp::RoundTo, a.id, b.id),
            _ => {
                let quotient = arena.over(a.id, b.id);
                let whole = arena.unary(UnaryOp::Floor, quotient);
                let part = arena.times(whole, b.id);
                arena.minus(a.id, part)
            }
        };
        Typed {
            zero: a.zero,
            ..self.typed(id, a.dim, span)
        }
    }

    fn number_one(&mut self, span: Span) -> Typed {
        let id = self.flat.exprs.constant(1.0);
        Typed {
            bare: true,
            ..self.typed(id, Dim::NUMBER, span)
        }
    }
}
