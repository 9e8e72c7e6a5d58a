//! `sum` of an array: `sum(x)` becomes `x[1] + x[2] + …`.

use crate::instance::{Scope, Typed};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::ExprId;
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    pub(super) fn sum(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("sum", args, span) else {
            return self.poison(span);
        };
        let Some(len) = self.array_length(a, scope) else {
            self.report(
                Diagnostic::error(Code::BadShape, "`sum` takes an array")
                    .label(a.span, "one value"),
            );
            return self.poison(span);
        };
        if len > 64 {
            self.report(
                Diagnostic::error(
                    Code::NotYet,
                    "`sum` over more than 64 elements in this version",
                )
                .label(a.span, format!("has {len} elements")),
            );
            return self.poison(span);
        }
        let inner = self.value(
            a,
            &Scope {
                elementwise: Some(len),
                ..scope.clone()
            },
        );
        let mut total = self.flat.exprs.constant(0.0);
        for element in 0..len {
            let term = self.element_of(inner.id, element);
            total = self.flat.exprs.plus(total, term);
        }
        self.typed(total, inner.dim, span)
    }

    /// An array expression at one value of its counter.
    pub(crate) fn element_of(&mut self, id: ExprId, element: usize) -> ExprId {
        let at = i32::try_from(element).unwrap_or(i32::MAX);
        self.flat.exprs.at_counter(id, at)
    }
}
