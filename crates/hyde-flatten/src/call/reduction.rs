//! A signal over a run as one number: `max`, `min`, `rms`, `mean`, `integral`, `first`, `last`, `settling`, `resonance`.

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::zero::Zero;
use hyde_diag::{Code, Diagnostic, MadeBy, Span};
use hyde_ir::flat::{Reduction, ReductionKind};
use hyde_ir::{BinaryOp, ExprId, UnaryOp, VariableKind};
use hyde_syntax::ast::Expr;
use hyde_units::Dimension;

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
            ("first" | "last" | "mean" | "rms", [a, b]) => Some((*a, Some(*b))),
            _ => self.exactly(name, args, span).map(|[a]| (a, None)),
        };
        let Some((a, second)) = second else {
            return self.poison(span);
        };
        if scope.setting != Setting::Measure {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` of a signal has a meaning over a whole run only"),
                )
                .label(span, "not in a measure or expectation")
                .help("write it in `measure` or `expect`"),
            );
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
        let mut condition_holds = None;
        let (kind, value, dim) = match (name, second) {
            ("mean" | "rms", Some(condition)) => {
                let holds = self.truth(condition, &over_run);
                return self.while_it_holds(name, &inner, holds, (written, scope, span));
            }
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
                let band = self.value(band, &over_run);
                self.agree(&inner, &band, "`settling` compares", scope.instance);
                // How far it is outside the band.
                let arena = &mut self.flat.exprs;
                let size = arena.unary(UnaryOp::Abs, inner.id);
                let outside = arena.binary(BinaryOp::Sub, size, band.id);
                (ReductionKind::Settling, outside, time)
            }
            (_, condition) => {
                let kind = if name == "first" {
                    ReductionKind::First
                } else {
                    ReductionKind::Last
                };
                condition_holds = condition.map(|condition| {
                    let holds = self.truth(condition, &over_run);
                    let arena = &mut self.flat.exprs;
                    let (yes, no) = (arena.constant(1.0), arena.constant(0.0));
                    arena.if_else(holds, yes, no)
                });
                (kind, inner.id, same)
            }
        };
        let id = self.reduced(
            (kind, value, condition_holds),
            dim.clone(),
            (written, scope, span),
        );
        let keeps = matches!(name, "max" | "min" | "rms" | "mean" | "first" | "last");
        Typed {
            zero: if keeps { inner.zero } else { Zero::Open },
            ..self.typed(id, dim, span)
        }
    }

    /// A mean or a root mean square over the time in which a condition holds:
    ///
    /// ```text
    /// mean(e, c)   integral(if c then e else 0)/integral(if c then 1 else 0)
    /// rms(e, c)    sqrt(integral(if c then e^2 else 0)/integral(if c then 1 else 0))
    /// ```
    fn while_it_holds(
        &mut self,
        name: &str,
        signal: &Typed,
        holds: ExprId,
        (written, scope, span): (String, &Scope<'a>, Span),
    ) -> Typed {
        let time = Dim::known(Dimension::TIME);
        let (mut value, mut dim) = (signal.id, signal.dim.clone());
        if name == "rms" {
            value = self.flat.exprs.binary(BinaryOp::Mul, value, value);
            dim = dim.multiply(&dim);
        }
        let arena = &mut self.flat.exprs;
        let (one, zero) = (arena.constant(1.0), arena.constant(0.0));
        let value = arena.if_else(holds, value, zero);
        let duration = arena.if_else(holds, one, zero);
        let place = (written.clone(), scope, span);
        let sum = self.reduced(
            (ReductionKind::Integral, value, None),
            dim.multiply(&time),
            place,
        );
        let place = (format!("duration of {written}"), scope, span);
        let duration = self.reduced((ReductionKind::Integral, duration, None), time, place);
        let arena = &mut self.flat.exprs;
        let mut id = arena.binary(BinaryOp::Div, sum, duration);
        if name == "rms" {
            id = arena.unary(UnaryOp::Sqrt, id);
        }
        Typed {
            zero: signal.zero,
            ..self.typed(id, signal.dim.clone(), span)
        }
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
            var,
        };
        self.flat.experiment.reductions.push(reduction);
        self.flat.exprs.var(var)
    }
}
