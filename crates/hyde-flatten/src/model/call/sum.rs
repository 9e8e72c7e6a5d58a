//! `sum` of an array: `sum(x)` becomes `x[1] + x[2] + …`.

use crate::dimension::Dim;
use crate::instance::{Elementwise, Position, Scope, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use hyde_diag::Span;
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    pub(super) fn sum(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("sum", args, span) else {
            return self.poison(span);
        };
        let Some(len) = self.array_length(a, scope) else {
            self.report(refused::sum_of_one(a.span));
            return self.poison(span);
        };
        if len > 64 {
            self.report(refused::long_sum(len, a.span));
            return self.poison(span);
        }
        let mut total = self.flat.exprs.constant(0.0);
        let mut sum: Option<Typed> = None;
        for at in 0..len {
            let one = Elementwise::One(Position { at, of: len });
            let term = self.value(a, &scope.elements(one));
            total = self.flat.exprs.plus(total, term.id);
            sum = Some(self.agreeing(sum, term, "`sum` adds", scope.instance));
        }
        self.typed(total, sum.map_or(Dim::Any, |sum| sum.dim), span)
    }
}
