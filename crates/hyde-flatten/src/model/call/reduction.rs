//! A signal over a run as one number: `max`, `min`, `rms`, `mean`, `integral`, `first`, `last`, `settling`, `resonance`;
//! all but the last two where a condition holds, if one is given.

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use crate::zero::Zero;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::{Reduction, ReductionKind};
use hyde_ir::{BinaryOp, ExprId, UnaryOp, VariableKind};
use hyde_syntax::ast::{Binary, Expr, ExprKind, Unary};
use hyde_units::Dimension;

/// The functions that make one number of a whole run, whatever their arguments are.
const ALWAYS: [&str; 6] = ["rms", "mean", "first", "last", "settling", "resonance"];

/// A reduction within an expression, where it stands: `last(T)` in `T - last(T)`.
fn nested(expr: &Expr) -> Option<(&str, Span)> {
    if let ExprKind::Call(function, arguments) = &expr.kind
        && let Some(name) = function.as_word()
        && (ALWAYS.contains(&name) || matches!(name, "max" | "min") && arguments.len() == 1)
    {
        return Some((name, expr.span));
    }
    expr.children().into_iter().find_map(nested)
}

impl<'a> Model<'a, '_> {
    /// A reduction of a signal over the run, in a measure or expectation.
    pub(super) fn reduction(
        &mut self,
        name: &str,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        // The second argument of `settling` is a band, any other a condition.
        let second = match (name, args) {
            ("settling", _) => self.exactly(name, args, span).map(|[a, b]| (a, Some(b))),
            ("resonance", _) => self.exactly(name, args, span).map(|[a]| (a, None)),
            (_, [a, b]) => Some((*a, Some(*b))),
            _ => self.exactly(name, args, span).map(|[a]| (a, None)),
        };
        let Some((a, second)) = second else {
            return self.poison(span);
        };
        if scope.setting != Setting::Measure {
            self.report(refused::reduction_outside_measure(name, span));
            return self.poison(span);
        }
        if let Some((inner, here)) = nested(a) {
            self.report(refused::reduction_of_reduction(name, inner, here));
            return self.poison(span);
        }
        let over_run = scope.with(Setting::Report);
        let inner = self.value(a, &over_run);
        let time = Dim::known(Dimension::TIME);
        let same = inner.dim.clone();
        let written: Vec<String> = std::iter::once(a)
            .chain(second)
            .map(hyde_syntax::format_expression)
            .collect();
        let written = format!("{name}({})", written.join(", "));
        let condition = second.filter(|_| name != "settling").map(|condition| {
            let holds = self.truth(condition, &over_run);
            let arena = &mut self.flat.exprs;
            let (yes, no) = (arena.constant(1.0), arena.constant(0.0));
            arena.if_else(holds, yes, no)
        });
        let (kind, value, dim) = match (name, second) {
            ("max", _) => (ReductionKind::Max, inner.id, same),
            ("min", _) => (ReductionKind::Min, inner.id, same),
            ("rms", _) => (ReductionKind::Rms, inner.id, same),
            ("mean", _) => (ReductionKind::Mean, inner.id, same),
            ("integral", _) => (ReductionKind::Integral, inner.id, same.multiply(&time)),
            ("resonance", _) => (
                ReductionKind::Resonance,
                inner.id,
                Dim::NUMBER.divide(&time),
            ),
            ("settling", Some(band)) => {
                let band = self.width(band, &over_run);
                self.agree(&inner, &band, "`settling` compares", scope.instance);
                // How far it is outside the band.
                let arena = &mut self.flat.exprs;
                let size = arena.unary(UnaryOp::Abs, inner.id);
                let outside = arena.binary(BinaryOp::Sub, size, band.id);
                (ReductionKind::Settling, outside, time)
            }
            ("first", _) => (ReductionKind::First, inner.id, same),
            (_, _) => (ReductionKind::Last, inner.id, same),
        };
        let id = self.reduced(
            (kind, value, condition),
            dim.clone(),
            (written, scope, span),
        );
        let keeps = matches!(name, "max" | "min" | "rms" | "mean" | "first" | "last");
        Typed {
            zero: if keeps { inner.zero } else { Zero::Open },
            ..self.typed(id, dim, span)
        }
    }

    /// Whether the second argument of a reduction is a condition: `max(e, time > 0.5 [s])` is the largest value behind 0.5 s,
    /// `max(a, b)` the larger of two numbers.
    pub(super) fn is_condition(&mut self, second: &'a Expr, scope: &Scope<'a>) -> bool {
        let is_written_so = || {
            use Binary::{And, Eq, Ge, Gt, Le, Lt, Ne, Or};
            matches!(
                &second.kind,
                ExprKind::Boolean(_)
                    | ExprKind::Unary(Unary::Not, _)
                    | ExprKind::Binary(Lt | Le | Gt | Ge | Eq | Ne | And | Or, ..)
            )
        };
        let is_name = matches!(second.kind, ExprKind::Reference(_));
        scope.setting == Setting::Measure
            && (is_written_so()
                || is_name && self.lower(second, &scope.with(Setting::Report)).truth)
    }

    /// A reduction of an expression that the run computes, as a variable with this name.
    fn reduced(
        &mut self,
        (kind, value, condition): (ReductionKind, ExprId, Option<ExprId>),
        dim: Dim,
        (name, scope, span): (String, &Scope<'a>, Span),
    ) -> ExprId {
        let number = self.flat.experiment.reductions.len();
        let var = self.add_variable(
            scope.instance,
            name,
            VariableKind::Reduction(number),
            dim,
            span,
            MadeBy::Experiment,
        );
        let reduction = Reduction {
            kind,
            value,
            condition,
            margins: Vec::new(),
            var,
        };
        self.flat.experiment.reductions.push(reduction);
        self.flat.exprs.var(var)
    }
}
