//! Expressions to IR: names to what they stand for in scope, numbers to SI, every operation with its dimension.

mod list;
mod operation;
mod read;
mod resolve;
mod resolved;
mod shape;
mod subscript;

pub(crate) use resolved::Resolved;

use crate::dimension::Dim;
use crate::instance::{Scope, Typed};
use crate::meaning;
use crate::model::Model;
use crate::refusals::{dimensions, values as refused};
use crate::turns::Turns;
use crate::zero::{self, Zero};
use hyde_diag::Span;
use hyde_syntax::ast::{Expr, ExprKind, UnitText};
use hyde_units::{AngleExponent, NamedUnit, UnitError};

impl<'a> Model<'a, '_> {
    /// Lowers an expression. What is wrong with it is reported, and something harmless takes its place.
    pub(crate) fn lower(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Typed {
        let typed = self.lower_kind(expr, scope);
        meaning::note(&mut self.lowered, self.input, expr.span, &typed);
        typed
    }

    fn lower_kind(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Typed {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number(value, unit) => self.number(*value, unit.as_ref(), span),
            ExprKind::Boolean(value) => {
                let id = self.flat.exprs.constant(f64::from(u8::from(*value)));
                Typed {
                    truth: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            ExprKind::String(_) => {
                self.report(refused::text_as_value(span));
                self.poison(span)
            }
            ExprKind::Reference(reference) => self.reference(reference, scope),
            ExprKind::Call(function, arguments) => self.call(function, arguments, scope, span),
            ExprKind::Unary(op, inner) => self.unary(*op, inner, scope, span),
            ExprKind::Binary(op, left, right) => self.binary(*op, left, right, scope, span),
            ExprKind::If(branches, otherwise) => {
                let mut value = self.lower(otherwise, scope);
                for (condition, branch) in branches.iter().rev() {
                    let condition = self.truth(condition, scope);
                    let branch = self.lower(branch, scope);
                    self.same_kind(&branch, &value);
                    self.agree(&branch, &value, "the branches have", scope.instance);
                    self.same_zero(&branch, &value);
                    let id = self.flat.exprs.if_else(condition, branch.id, value.id);
                    let dim = sum_dim(&branch.dim, &value.dim);
                    value = Typed {
                        id,
                        dim,
                        bare: branch.bare && value.bare,
                        turns: Turns::Plain,
                        zero: Zero::of_either(branch.zero, value.zero),
                        difference: None,
                        span,
                        truth: value.truth,
                    };
                }
                value
            }
            ExprKind::Array(..) | ExprKind::Comprehension(_) => self.list(expr, scope),
            // The grammar has slices in subscripts alone.
            ExprKind::Slice(..) => self.poison(span),
        }
    }

    /// Lowers an expression that must be a truth.
    pub(crate) fn truth(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> hyde_ir::ExprId {
        let typed = self.lower(expr, scope);
        if !typed.truth && typed.dim != Dim::Any {
            self.report(refused::number_for_truth(
                expr.span,
                &hyde_syntax::format_expression(expr),
            ));
        }
        typed.id
    }

    /// Lowers an expression that must be a number.
    pub(crate) fn value(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Typed {
        let typed = self.lower(expr, scope);
        if typed.truth {
            self.report(refused::truth_for_number(expr.span));
        }
        typed
    }

    /// The text of a unit that cannot be read, reported.
    pub(crate) fn bad_unit(&mut self, unit: &UnitText, error: &UnitError) {
        let start = unit.span.start as usize + error.at.start;
        let end = unit.span.start as usize + error.at.end.max(error.at.start + 1);
        let span = Span::new(
            unit.span.file,
            start,
            end.min(unit.span.end as usize).max(start),
        );
        self.report(refused::bad_unit(&error.fact(), span, error.help()));
    }

    pub(crate) fn number(&mut self, value: f64, unit: Option<&UnitText>, span: Span) -> Typed {
        let Some(text) = unit else {
            let id = self.flat.exprs.constant(value);
            let dim = if value == 0.0 { Dim::Any } else { Dim::NUMBER };
            return Typed {
                bare: true,
                ..self.typed(id, dim, span)
            };
        };
        match NamedUnit::parse(&text.text) {
            Ok(unit) => {
                let unit = unit.unit();
                let id = self.flat.exprs.constant(unit.to_si(value));
                let own = unit.is_absolute();
                if own && unit.to_si(value) < 0.0 {
                    let least = zero::absolute_zero(unit, text);
                    self.report(dimensions::below_absolute_zero(span, &least));
                }
                Typed {
                    zero: if own { Zero::Own } else { Zero::Open },
                    difference: own.then(|| unit.difference_to_si(value)),
                    ..self.typed(id, Dim::known(unit.dimension), span)
                }
            }
            Err(error) => {
                self.bad_unit(text, &error);
                self.poison(span)
            }
        }
    }

    pub(crate) fn same_kind(&mut self, a: &Typed, b: &Typed) {
        if a.truth != b.truth && a.dim != Dim::Any && b.dim != Dim::Any {
            self.report(refused::kinds_differ((a.span, a.truth), (b.span, b.truth)));
        }
    }

    /// Lowers what is no point of a scale but a width: a noise, a band. `0.5 [degC]` is 0.5 K there.
    pub(crate) fn width(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Typed {
        let typed = self.value(expr, scope);
        if let Some(width) = typed.difference {
            return Typed {
                id: self.flat.exprs.constant(width),
                zero: Zero::Open,
                difference: None,
                ..typed
            };
        }
        self.report_any(zero::as_width(&typed, self.input.sources));
        typed
    }

    /// Reports a difference of temperatures beside one that counts from a zero point.
    pub(crate) fn same_zero(&mut self, a: &Typed, b: &Typed) {
        self.report_any(zero::beside_difference(a, b, self.input.sources));
    }

    pub(crate) fn not_constant(&mut self, what: &str, span: Span) {
        self.report(refused::not_constant(what, span));
    }
}

/// The dimension of a sum: that of the side which has one; its angle is open if that of a side is.
pub(crate) fn sum_dim(a: &Dim, b: &Dim) -> Dim {
    match (a, b) {
        (Dim::Any, other) | (other, Dim::Any) => other.clone(),
        (Dim::Of(..), Dim::Of(..)) => {
            let open = b
                .as_known()
                .is_some_and(|dimension| !matches!(dimension.angle(), AngleExponent::Known(_)));
            if open || a.as_known().is_none() {
                b.clone()
            } else {
                a.clone()
            }
        }
    }
}
