//! `chirp`: a sine whose frequency rises linearly, by its closed form, so that it has derivatives.

use crate::dimension::Dim;
use crate::instance::{Scope, Typed};
use crate::model::Model;
use hyde_diag::Span;
use hyde_ir::UnaryOp;
use hyde_syntax::ast::Expr;
use hyde_units::Dimension;

impl<'a> Model<'a, '_> {
    /// `chirp(t, f0, f1, T)`: a sine whose frequency rises from f0 to f1 within T, `sin(2 pi (f0 t + (f1 - f0)/(2 T) t^2))`.
    pub(super) fn chirp(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([t, from, to, over]) = self.exactly("chirp", args, span) else {
            return self.poison(span);
        };
        let (t, from) = (self.value(t, scope), self.value(from, scope));
        let (to, over) = (self.value(to, scope), self.value(over, scope));
        let time = Typed {
            dim: Dim::known(Dimension::TIME),
            ..t.clone()
        };
        self.agree(&time, &t, "a chirp runs over time, found", scope.instance);
        self.agree(
            &Typed {
                span: over.span,
                ..time.clone()
            },
            &over,
            "a chirp lasts a time, found",
            scope.instance,
        );
        self.agree(&from, &to, "the two frequencies are", scope.instance);
        let rate = Typed {
            dim: Dim::NUMBER.divide(&time.dim),
            ..from.clone()
        };
        self.agree(
            &rate,
            &from,
            "a chirp starts at a frequency, found",
            scope.instance,
        );
        let arena = &mut self.flat.exprs;
        let rise = arena.minus(to.id, from.id);
        let twice = arena.plus(over.id, over.id);
        let slope = arena.over(rise, twice);
        let square = arena.times(t.id, t.id);
        let (linear, bent) = (arena.times(from.id, t.id), arena.times(slope, square));
        let turns = arena.plus(linear, bent);
        let tau = arena.constant(std::f64::consts::TAU);
        let angle = arena.times(tau, turns);
        let id = arena.unary(UnaryOp::Sin, angle);
        self.typed(id, Dim::NUMBER, span)
    }
}
