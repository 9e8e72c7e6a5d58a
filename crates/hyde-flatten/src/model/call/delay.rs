//! `delay(u, T)`: a continuous quantity as it was a time T ago.
//!
//! ```text
//! back = delay(v, 20 [ms])       back(t) = v(t - 20 ms), before that time v as it was at the start
//! ```
//! What is delayed is a variable; an expression gets one. T is structural: where it is 0, `delay(u, T)` is u itself, and
//! the equations are others. In the observed form it is a plain parameter, so that it can be looked for.

use crate::dimension::Dim;
use crate::input::Form;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::{Delay, Equation};
use hyde_ir::{DelayId, Expr as Ir, ExprId, Id as _, Index, Range, VarId, VariableKind};
use hyde_syntax::ast::Expr;
use hyde_units::Dimension;

/// How late a quantity is.
#[derive(Clone, Copy)]
struct DelayTime {
    id: ExprId,
    value_s: f64,
    /// Parameters decide it that may change from run to run: else `id` is a number.
    plain: bool,
}

impl<'a> Model<'a, '_> {
    pub(super) fn delay(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([u, by]) = self.exactly("delay", args, span) else {
            return self.poison(span);
        };
        if matches!(
            scope.setting,
            Setting::Clocked | Setting::Parameter | Setting::Measure
        ) {
            self.report(match scope.setting == Setting::Clocked {
                true => refused::delay_in_clocked(span),
                false => refused::delay_without_time(span),
            });
            return self.poison(span);
        }
        let Some(time) = self.delay_time(by, scope) else {
            return self.poison(span);
        };
        let u = self.lower(u, &scope.with(Setting::Equation));
        let fixed = self.flat.exprs.is_parametric(u.id);
        let none = time.value_s == 0.0 && !time.plain;
        let id = if none || fixed {
            u.id
        } else {
            self.delayed(&u, time, scope, span)
        };
        Typed {
            truth: u.truth,
            zero: u.zero,
            ..self.typed(id, u.dim, span)
        }
    }

    /// The time in s, known before the run and not negative.
    fn delay_time(&mut self, by: &'a Expr, scope: &Scope<'a>) -> Option<DelayTime> {
        let in_seconds = Typed {
            dim: Dim::known(Dimension::TIME),
            ..self.poison(by.span)
        };
        let errors = self.diagnostics.error_count();
        let given = self.lower(by, &scope.with(Setting::Parameter));
        self.agree(
            &in_seconds,
            &given,
            "a delay is a time, found",
            scope.instance,
        );
        if self.differs_along(given.id) {
            return None;
        }
        let observed = self.input.form == Form::Observed;
        let value = match observed {
            true => self.current_value(given.id),
            false => self.evaluate(given.id),
        };
        if self.diagnostics.error_count() > errors {
            return None;
        }
        let Some(value) = value else {
            self.not_constant("the time of a delay", by.span);
            return None;
        };
        if !(value >= 0.0 && value.is_finite()) {
            self.report(refused::negative_delay(value, by.span));
            return None;
        }
        let exprs = &mut self.flat.exprs;
        let plain = observed && exprs.any(given.id, |expr| matches!(expr, Ir::Param(..)));
        Some(DelayTime {
            id: if plain {
                given.id
            } else {
                exprs.constant(value)
            },
            value_s: value,
            plain,
        })
    }

    /// The variable that is `u` a time ago; of an element that moves with a counter, that of the whole array.
    fn delayed(&mut self, u: &Typed, time: DelayTime, scope: &Scope<'a>, span: Span) -> ExprId {
        let (var, index) = match self.flat.exprs[u.id].access() {
            Some((var, index, false)) => (var, index),
            Some(_) | None if self.flat.exprs.any(u.id, moves_with_counter) => {
                self.report(refused::delay_of_arrays(u.span));
                return u.id;
            }
            Some(_) | None => (self.named(u, scope), Index::SCALAR),
        };
        let whole = Index::COUNTER;
        let (of, read) = match index.stride {
            0 => (index, Index::SCALAR),
            _ => (whole, index),
        };
        let key = (self.flat.exprs.add(Ir::Var(var, of)), time.id);
        let delayed = match self.delayed.get(&key) {
            Some(&known) => known,
            None => {
                let made = self.delayed_variable((var, of), u, time, scope, span);
                self.delayed.insert(key, made);
                made
            }
        };
        self.flat.exprs.add(Ir::Var(delayed, read))
    }

    /// A variable for an expression that is delayed: its relations are events, and its derivatives are known.
    pub(crate) fn named(&mut self, u: &Typed, scope: &Scope<'_>) -> VarId {
        let text = self.input.sources.text(u.span).to_owned();
        let name = self.tree[scope.instance].path.member(&format!("({text})"));
        let var = self.add_variable(
            scope.instance,
            name,
            VariableKind::Continuous,
            u.dim.clone(),
            u.span,
            MadeBy::Expression,
        );
        self.flat.variables[var].boolean = u.truth;
        let lhs = self.flat.exprs.var(var);
        let origin = self
            .tree
            .origin(scope.instance, u.span)
            .made_by(MadeBy::Expression);
        self.flat.equations.push(Equation {
            range: Range::SCALAR,
            lhs,
            rhs: u.id,
            origin,
        });
        var
    }

    fn delayed_variable(
        &mut self,
        (source, of): (VarId, Index),
        u: &Typed,
        time: DelayTime,
        scope: &Scope<'a>,
        span: Span,
    ) -> VarId {
        let variable = &self.flat.variables[source];
        let len = variable.len.filter(|_| of.stride != 0);
        let name = match len {
            Some(_) => variable.name.clone(),
            None => variable.element_name(usize::try_from(of.offset).unwrap_or(0)),
        };
        let kind = VariableKind::Delayed(DelayId::from_index(self.flat.delays.len()));
        let name = match time.plain {
            true => format!("delay({name})"),
            false => format!("delay({name}, {} s)", time.value_s),
        };
        let var = self.add_variable(
            scope.instance,
            name,
            kind,
            u.dim.clone(),
            span,
            MadeBy::Source,
        );
        self.flat.variables[var].len = len;
        self.flat.variables[var].boolean = u.truth;
        let last = i32::try_from(len.unwrap_or(1)).unwrap_or(i32::MAX) - 1;
        let value = self.flat.exprs.add(Ir::Var(source, of));
        let origin = self.tree.origin(scope.instance, span);
        self.flat.delays.push(Delay {
            range: Range { first: 0, last },
            value,
            time: time.id,
            time_s: time.value_s,
            var,
            origin,
        });
        var
    }
}

/// A leaf that is another one at every value of a counter.
pub(crate) fn moves_with_counter(expr: Ir) -> bool {
    match expr {
        Ir::Counter => true,
        Ir::Param(_, index) | Ir::Var(_, index) | Ir::Der(_, index) | Ir::Pre(_, index) => {
            index.stride != 0
        }
        Ir::Const(_)
        | Ir::Time
        | Ir::Relation(_)
        | Ir::InMode(..)
        | Ir::Unary(..)
        | Ir::Binary(..)
        | Ir::If(..)
        | Ir::NoEvent(_) => false,
    }
}
