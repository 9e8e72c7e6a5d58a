//! `min` and `max` of two values, and `clamp`: in a continuous equation the change from one to the other is an event.

use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::model::lower::sum_dim;
use crate::zero::Zero;
use hyde_diag::Span;
use hyde_ir::{BinaryOp, ExprId};
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    pub(super) fn extremum(
        &mut self,
        least: bool,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let Some([a, b]) = self.exactly(if least { "min" } else { "max" }, args, span) else {
            return self.poison(span);
        };
        let (a, b) = (self.value(a, scope), self.value(b, scope));
        self.agree(
            &a,
            &b,
            if least {
                "`min` compares"
            } else {
                "`max` compares"
            },
            scope.instance,
        );
        self.same_zero(&a, &b);
        let id = self.choose(least, a.id, b.id, scope.setting);
        Typed {
            zero: Zero::of_either(a.zero, b.zero),
            ..self.typed(id, sum_dim(&a.dim, &b.dim), span)
        }
    }

    /// The lesser or greater of two; in a continuous equation the change from one to the other is an event.
    fn choose(&mut self, least: bool, a: ExprId, b: ExprId, setting: Setting) -> ExprId {
        let arena = &mut self.flat.exprs;
        if setting == Setting::Equation {
            let second = arena.binary(if least { BinaryOp::Lt } else { BinaryOp::Gt }, b, a);
            return arena.if_else(second, b, a);
        }
        arena.binary(if least { BinaryOp::Min } else { BinaryOp::Max }, a, b)
    }

    pub(super) fn clamp(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([x, low, high]) = self.exactly("clamp", args, span) else {
            return self.poison(span);
        };
        let (x, low, high) = (
            self.value(x, scope),
            self.value(low, scope),
            self.value(high, scope),
        );
        self.agree(&x, &low, "`clamp` compares", scope.instance);
        self.agree(&x, &high, "`clamp` compares", scope.instance);
        self.same_zero(&x, &low);
        self.same_zero(&x, &high);
        let below = self.choose(false, x.id, low.id, scope.setting);
        let id = self.choose(true, below, high.id, scope.setting);
        Typed {
            zero: x.zero,
            ..self.typed(id, sum_dim(&x.dim, &low.dim), span)
        }
    }
}
