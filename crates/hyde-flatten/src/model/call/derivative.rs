//! `der` and `partial`: derivatives by the time and by a variable, taken by the chain rule as the call is read.
//!
//! ```text
//! der(x*y)                         der(x)*y + x*der(y)
//! partial(e, x)  with Real e = x*x      x + x
//! ```

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::calls as refused;
use crate::wrap::wrapped;
use hyde_diag::Span;
use hyde_ir::{Expr as Ir, ExprId, Id as _, Index, Memo, VarId, VariableKind};
use hyde_syntax::ast::{Expr, ExprKind};
use hyde_units::Dimension;

impl<'a> Model<'a, '_> {
    /// `der(e)`: of a variable its derivative, of an expression the derivative by the chain rule.
    pub(super) fn der(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("der", args, span) else {
            return self.poison(span);
        };
        if scope.setting == Setting::Parameter {
            self.report(refused::derivative_of_parameter(span));
            return self.poison(span);
        }
        if scope.setting == Setting::Clocked {
            return self.difference(a, scope, span);
        }
        let inner = self.value(a, scope);
        let dim = inner.dim.divide(&Dim::known(Dimension::TIME));
        let id = self.time_derivative(inner.id, span);
        self.typed(id, dim, span)
    }

    /// In a clocked part, `der(x)` is the difference to the last tick over the time since then: backward Euler.
    fn difference(&mut self, a: &'a Expr, scope: &Scope<'a>, span: Span) -> Typed {
        let inner = self.value(a, scope);
        let clock = self.clock_of(scope.instance);
        if let (Some(clock), Ir::Var(var, index)) = (clock, self.flat.exprs[inner.id])
            && self.flat.variables[var].kind == VariableKind::Clocked(clock)
        {
            let exprs = &mut self.flat.exprs;
            let before = exprs.add(Ir::Pre(var, index));
            let change = exprs.minus(inner.id, before);
            let id = exprs.over(change, self.flat.clocks[clock].period);
            return self.typed(id, inner.dim.divide(&Dim::known(Dimension::TIME)), span);
        }
        let written = hyde_syntax::format_expression(a);
        self.report(refused::derivative_in_clocked(&written, span));
        self.poison(span)
    }

    pub(crate) fn time_derivative(&mut self, id: ExprId, span: Span) -> ExprId {
        let (mut second, mut delayed) = (false, false);
        let variables = &self.flat.variables;
        let arena = &mut self.flat.exprs;
        let result = arena.tangent(id, |arena, leaf| match leaf {
            Ir::Var(var, index) => match variables[var].kind {
                VariableKind::Continuous | VariableKind::Column(..) => {
                    Some(arena.add(Ir::Der(var, index)))
                }
                VariableKind::Delayed(_) => {
                    delayed = true;
                    None
                }
                VariableKind::Discrete
                | VariableKind::Clocked(_)
                | VariableKind::Held(..)
                | VariableKind::Reduction(_) => None,
            },
            Ir::Time => Some(arena.constant(1.0)),
            Ir::Der(..) => {
                second = true;
                None
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
            | Ir::NoEvent(_) => None,
        });
        if second {
            self.report(refused::second_derivative(span));
        }
        if delayed {
            self.report(refused::derivative_of_delayed(span));
        }
        result
    }

    /// `partial(e, v)`: the derivative of e by the variable v; variables with a declared value count as that value.
    pub(super) fn partial(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([e, by]) = self.exactly("partial", args, span) else {
            return self.poison(span);
        };
        let ExprKind::Reference(name) = &by.kind else {
            self.report(refused::partial_by_no_variable(by.span, "an expression"));
            return self.poison(span);
        };
        let Some(Resolved::Variable(var, index)) = self.resolve(name, scope) else {
            self.report(refused::partial_by_no_variable(by.span, "no variable"));
            return self.poison(span);
        };
        let index = index.unwrap_or_default();
        let value = self.value(e, scope);
        let expanded = self.expand_bindings(value.id, var, 0);
        let by_place = self.slopes_of_weights(expanded, |model, place| {
            let place = model.expand_bindings(place, var, 0);
            let one = model.flat.exprs.constant(1.0);
            model.flat.exprs.tangent(place, |_, leaf| {
                (leaf == Ir::Var(var, index)).then_some(one)
            })
        });
        let id = self.flat.exprs.tangent(expanded, |arena, leaf| {
            if leaf == Ir::Var(var, index) {
                return Some(arena.constant(1.0));
            }
            let Ir::Var(of, element) = leaf else {
                return None;
            };
            let &(slopes, of_place) = by_place.get(&of)?;
            let slope = arena.add(Ir::Var(slopes, element));
            Some(arena.times(slope, of_place))
        });
        let dim = value.dim.divide(&self.dim(var));
        self.typed(id, dim, span)
    }

    /// Variables with a declared value replaced by it, down to `keep`.
    fn expand_bindings(&mut self, id: ExprId, keep: VarId, depth: usize) -> ExprId {
        let mut memo = Memo::default();
        for inner in self.flat.exprs.below(&[id]) {
            let Ir::Var(var, Index::SCALAR) = self.flat.exprs[inner] else {
                continue;
            };
            let notes = &self.variables[var.index()];
            let Some(binding) = notes.binding.clone() else {
                continue;
            };
            if var == keep || depth > 40 || self.flat.variables[var].len.is_some() {
                continue;
            }
            let value = self.bound_value(&binding, Setting::Equation);
            let value = wrapped(self, var, value, Setting::Equation);
            let value = self.expand_bindings(value.id, keep, depth + 1);
            memo.insert(inner, value);
        }
        self.flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
    }
}
