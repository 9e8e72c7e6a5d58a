//! Operators, each with what it demands of the dimensions of its operands.

use super::sum_dim;
use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::values as refused;
use crate::turns::{Sides, Turns};
use crate::zero::{self, Zero};
use hyde_diag::Span;
use hyde_ir::{BinaryOp, Expr as Ir, UnaryOp, VariableKind};
use hyde_syntax::ast::{Binary, Expr, ExprKind, Unary};
use hyde_syntax::format_expression;
use hyde_units::Exponent;

impl<'a> Model<'a, '_> {
    pub(super) fn unary(
        &mut self,
        op: Unary,
        inner: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        match op {
            Unary::Not => {
                let condition = self.truth(inner, scope);
                let id = self.flat.exprs.unary(UnaryOp::Not, condition);
                Typed {
                    truth: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            Unary::Positive => Typed {
                span,
                ..self.value(inner, scope)
            },
            Unary::Negative => {
                // `-5 [degC]` is a temperature below the zero point of its unit, not 5 degC with its sign changed.
                if let ExprKind::Number(value, unit) = &inner.kind {
                    return self.number(-value, unit.as_ref(), span);
                }
                let value = self.value(inner, scope);
                let id = self.flat.exprs.negative(value.id);
                Typed {
                    id,
                    span,
                    turns: if value.turns == Turns::TwoPi {
                        Turns::Plain
                    } else {
                        value.turns
                    },
                    difference: value.difference.map(|difference| -difference),
                    zero: value.zero.of_opposite(),
                    ..value
                }
            }
        }
    }

    pub(super) fn binary(
        &mut self,
        op: Binary,
        left: &'a Expr,
        right: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        match op {
            Binary::And | Binary::Or => {
                let (a, b) = (self.truth(left, scope), self.truth(right, scope));
                let op = if op == Binary::And {
                    BinaryOp::And
                } else {
                    BinaryOp::Or
                };
                let id = self.flat.exprs.binary(op, a, b);
                Typed {
                    truth: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            Binary::Lt => self.comparison(BinaryOp::Lt, left, right, scope, span),
            Binary::Le => self.comparison(BinaryOp::Le, left, right, scope, span),
            Binary::Gt => self.comparison(BinaryOp::Gt, left, right, scope, span),
            Binary::Ge => self.comparison(BinaryOp::Ge, left, right, scope, span),
            Binary::Eq => self.comparison(BinaryOp::Eq, left, right, scope, span),
            Binary::Ne => self.comparison(BinaryOp::Ne, left, right, scope, span),
            Binary::Add | Binary::Sub => {
                let (a, b) = (self.value(left, scope), self.value(right, scope));
                let (ir, what) = if op == Binary::Add {
                    (BinaryOp::Add, "`+` adds")
                } else {
                    (BinaryOp::Sub, "`-` subtracts")
                };
                let agree = self.agree(&a, &b, what, scope.instance);
                let doubt = zero::added_as_difference(ir, (&a, &b));
                self.report_any(doubt);
                // A temperature less a difference is one, a difference less a temperature is nothing.
                if ir == BinaryOp::Sub && a.zero == Zero::Difference {
                    self.same_zero(&a, &b);
                }
                let id = self.flat.exprs.binary(ir, a.id, b.id);
                // A sum that is wrong already is not held against what it is compared with.
                let dim = match agree {
                    true => sum_dim(&a.dim, &b.dim),
                    false => Dim::Any,
                };
                let turns = match (a.turns, b.turns) {
                    (Turns::Lost, _) | (_, Turns::Lost) => Turns::Lost,
                    (Turns::Counted, _) | (_, Turns::Counted) => Turns::Counted,
                    _ => Turns::Plain,
                };
                let one_signal = match ir == BinaryOp::Sub {
                    true => Zero::of_one_signal(&self.flat, (a.id, b.id)),
                    false => None,
                };
                let zero = one_signal.unwrap_or_else(|| Zero::of_sum(ir, a.zero, b.zero));
                Typed {
                    bare: a.bare && b.bare,
                    turns,
                    zero,
                    ..self.typed(id, dim, span)
                }
            }
            Binary::Mul | Binary::Div => {
                let (a, b) = (self.value(left, scope), self.value(right, scope));
                let divides = op == Binary::Div;
                let sides = Sides::new(self.input.sources, &self.flat);
                let (dim, turns) = sides.product((&a, &b), divides, self.diagnostics);
                let ir = if divides {
                    BinaryOp::Div
                } else {
                    BinaryOp::Mul
                };
                let doubt = zero::scaled(ir, (&a, &b));
                self.report_any(doubt);
                let id = self.flat.exprs.binary(ir, a.id, b.id);
                Typed {
                    bare: a.bare && b.bare,
                    turns,
                    zero: Zero::of_multiple(&a, &b),
                    ..self.typed(id, dim, span)
                }
            }
            Binary::Pow => self.power(left, right, scope, span),
        }
    }

    fn comparison(
        &mut self,
        op: BinaryOp,
        left: &'a Expr,
        right: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let (a, b) = (self.lower(left, scope), self.lower(right, scope));
        match between(op, left, right).filter(|_| !b.truth) {
            Some(both) => self.report(refused::compared_twice(span, &both)),
            None => {
                self.same_kind(&a, &b);
                self.agree(&a, &b, "a comparison of", scope.instance);
                self.same_zero(&a, &b);
            }
        }
        let continuous = matches!(scope.setting, Setting::Equation | Setting::Condition);
        if continuous
            && matches!(op, BinaryOp::Eq | BinaryOp::Ne)
            && (self.varies(a.id) || self.varies(b.id))
        {
            let sign = if op == BinaryOp::Eq { "==" } else { "<>" };
            self.report(refused::compared_for_equality(sign, span));
        }
        let id = self.flat.exprs.binary(op, a.id, b.id);
        Typed {
            truth: true,
            ..self.typed(id, Dim::NUMBER, span)
        }
    }

    /// Whether an expression changes between events.
    fn varies(&self, id: hyde_ir::ExprId) -> bool {
        self.flat.exprs.any(id, |expr| match expr {
            Ir::Time | Ir::Der(..) => true,
            Ir::Var(var, _) => {
                let variable = &self.flat.variables[var];
                !variable.boolean
                    && matches!(
                        variable.kind,
                        VariableKind::Continuous | VariableKind::Column(..)
                    )
            }
            Ir::Const(_)
            | Ir::Counter
            | Ir::Param(..)
            | Ir::Pre(..)
            | Ir::Relation(_)
            | Ir::InMode(..)
            | Ir::Unary(..)
            | Ir::Binary(..)
            | Ir::If(..)
            | Ir::NoEvent(_) => false,
        })
    }

    fn power(&mut self, left: &'a Expr, right: &'a Expr, scope: &Scope<'a>, span: Span) -> Typed {
        let (a, b) = (self.value(left, scope), self.value(right, scope));
        let number = Typed {
            dim: Dim::NUMBER,
            ..b.clone()
        };
        self.agree(
            &number,
            &b,
            "an exponent is a pure number, found",
            scope.instance,
        );
        let id = self.flat.exprs.binary(BinaryOp::Pow, a.id, b.id);
        let exponent = self
            .flat
            .exprs
            .as_constant(b.id)
            .and_then(Exponent::from_f64);
        let dim = match exponent {
            // A dimension that is not known yet, to a power that not every dimension has.
            Some(exponent) if a.dim.as_known().is_some() || a.dim.power(exponent).is_some() => {
                a.dim.power(exponent)
            }
            Some(_) | None => {
                let number = Typed {
                    dim: Dim::NUMBER,
                    ..a.clone()
                };
                self.agree(
                    &number,
                    &a,
                    "only a pure number can be raised to this power, found",
                    scope.instance,
                );
                Some(Dim::NUMBER)
            }
        };
        let dim = dim.unwrap_or_else(|| {
            self.report(refused::inexact_power(span));
            Dim::Any
        });
        Typed {
            bare: a.bare && b.bare,
            ..self.typed(id, dim.composed(), span)
        }
    }
}

/// The two comparisons that `0 < x < 1` means: `0 < x and x < 1`.
fn between(op: BinaryOp, left: &Expr, right: &Expr) -> Option<String> {
    let ExprKind::Binary(Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge, _, middle) = &left.kind
    else {
        return None;
    };
    let signs = [
        (BinaryOp::Lt, "<"),
        (BinaryOp::Le, "<="),
        (BinaryOp::Gt, ">"),
        (BinaryOp::Ge, ">="),
    ];
    let (_, sign) = signs.into_iter().find(|(known, _)| *known == op)?;
    let [first, middle, last] = [left, middle, right].map(format_expression);
    Some(format!("{first} and {middle} {sign} {last}"))
}
