//! `pre`, `sample`, `hold`, `held` and `interval`: values across the borders of clocked parts.

use crate::dimension::Dim;
use crate::instance::{Counter, Elementwise, Scope, Setting, Typed};
use crate::model::Model;
use crate::model::call::delay::moves_with_counter;
use crate::refusals::calls as refused;
use crate::turns::Turns;
use crate::zero::Zero;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::{ClockedEquation, Equation};
use hyde_ir::{ClockId, Expr as Ir, ExprId, FlatModel, Id as _, Index, Range, VarId, VariableKind};
use hyde_syntax::ast::{Expr, ExprKind, Reference};
use hyde_units::Dimension;

impl<'a> Model<'a, '_> {
    /// `pre(x)`: in a clocked part the value at the last tick, in an event the value before it.
    pub(super) fn pre(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("pre", args, span) else {
            return self.poison(span);
        };
        let ExprKind::Reference(reference) = &a.kind else {
            self.report(refused::pre_of_expression(a.span));
            return self.poison(span);
        };
        let inner = self.lower(a, &scope.with(Setting::Report));
        let Ir::Var(var, index) = self.flat.exprs[inner.id] else {
            return self.poison(span);
        };
        let allowed = match (self.flat.variables[var].kind, scope.setting) {
            (VariableKind::Clocked(clock), Setting::Clocked) => {
                Some(clock) == self.clock_of(scope.instance)
            }
            (VariableKind::Discrete, Setting::Action | Setting::Condition | Setting::Equation) => {
                true
            }
            (VariableKind::Continuous, Setting::Action) => true,
            _ => false,
        };
        if !allowed && !self.misplaced.contains(&var) {
            self.report(refused::pre_without_meaning(reference, span));
        }
        let id = self.flat.exprs.add(Ir::Pre(var, index));
        Typed {
            truth: inner.truth,
            ..self.typed(id, inner.dim, span)
        }
    }

    /// `sample(e)`: a continuous expression read at the tick.
    pub(super) fn sample(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("sample", args, span) else {
            return self.poison(span);
        };
        if scope.setting != Setting::Clocked {
            self.report(refused::sample_outside_clocked(span));
            return self.poison(span);
        }
        let inner = self.lower(a, &scope.with(Setting::Report));
        if let Some(clock) = clocks_of(&self.flat, inner.id).first().copied() {
            let name = self.flat.clocks[clock].name.clone();
            self.report(refused::sample_of_clocked(&name, a.span));
        }
        Typed {
            span,
            bare: false,
            turns: Turns::Plain,
            ..inner
        }
    }

    /// `hold(e)`: a clocked value between its ticks.
    pub(super) fn hold(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("hold", args, span) else {
            return self.poison(span);
        };
        if matches!(scope.setting, Setting::Clocked | Setting::Parameter) {
            self.report(refused::hold_in_clocked(span));
            return self.poison(span);
        }
        if matches!(scope.elementwise, Some(Elementwise::Range(_))) {
            // Each element is held apart.
            self.unroll();
            return self.poison(span);
        }
        if let Some((name, var)) = self.continuous(a, scope) {
            if !self.misplaced.contains(&var) {
                self.report(refused::hold_of_continuous(name));
            }
            return self.poison(span);
        }
        let inner = self.lower(a, &scope.with(Setting::Clocked));
        let clocks = clocks_of(&self.flat, inner.id);
        let [clock] = clocks.as_slice() else {
            self.report(refused::hold_of_several(clocks.len(), a.span));
            return self.poison(span);
        };
        let clock = *clock;
        if self.flat.exprs.any(inner.id, moves_with_counter) {
            // Each turn of the loop holds another value.
            self.unroll();
            return self.poison(span);
        }
        let source = if let Ir::Var(var, Index::SCALAR) = self.flat.exprs[inner.id]
            && self.flat.variables[var].len.is_none()
        {
            var
        } else {
            self.clocked_part_of(clock, a, &inner, scope, span)
        };
        let held = match self.held.get(&(clock, source)) {
            Some(&held) => held,
            None => {
                let name = format!("hold({})", self.flat.variables[source].name);
                let kind = VariableKind::Held(clock, source);
                let held = self.add_variable(
                    scope.instance,
                    name,
                    kind,
                    inner.dim.clone(),
                    span,
                    MadeBy::Source,
                );
                self.flat.variables[held].boolean = inner.truth;
                self.variables[held.index()].difference = inner.zero == Zero::Difference;
                self.held.insert((clock, source), held);
                held
            }
        };
        let id = self.flat.exprs.var(held);
        Typed {
            truth: inner.truth,
            zero: inner.zero,
            ..self.typed(id, inner.dim, span)
        }
    }

    /// A continuous variable, and its name, if an expression is nothing but that.
    fn continuous(&mut self, a: &'a Expr, scope: &Scope<'a>) -> Option<(&'a Reference, VarId)> {
        let ExprKind::Reference(name) = &a.kind else {
            return None;
        };
        let inner = self.lower(a, &scope.with(Setting::Report));
        let Ir::Var(var, _) = self.flat.exprs[inner.id] else {
            return None;
        };
        (self.flat.variables[var].kind == VariableKind::Continuous).then_some((name, var))
    }

    /// A clocked variable for an expression that is held.
    fn clocked_part_of(
        &mut self,
        clock: ClockId,
        written: &Expr,
        value: &Typed,
        scope: &Scope<'a>,
        span: Span,
    ) -> VarId {
        let mut element = match scope.elementwise {
            Some(Elementwise::One(position)) => format!("[{}]", position.at + 1),
            Some(Elementwise::Range(_)) | None => String::new(),
        };
        for (_, counter) in &scope.counters {
            if let Counter::Fixed(turn) = counter {
                element.push_str(&format!("[{turn}]"));
            }
        }
        let name = format!(
            "{}.({}){element}",
            self.flat.clocks[clock].name,
            hyde_syntax::format_expression(written)
        );
        let kind = VariableKind::Clocked(clock);
        let var = self.add_variable(
            scope.instance,
            name,
            kind,
            value.dim.clone(),
            span,
            MadeBy::Source,
        );
        self.flat.variables[var].boolean = value.truth;
        let lhs = self.flat.exprs.var(var);
        let origin = self.tree.origin(scope.instance, span);
        let equation = Equation {
            range: Range::SCALAR,
            lhs,
            rhs: value.id,
            origin,
        };
        self.flat
            .clocked_equations
            .push(ClockedEquation { clock, equation });
        var
    }

    /// `held(file.r)`: a record's column held between rows, where it would be read linearly.
    pub(super) fn held_column(
        &mut self,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let Some([a]) = self.exactly("held", args, span) else {
            return self.poison(span);
        };
        let inner = self.value(a, scope);
        if let Ir::Var(var, _) = self.flat.exprs[inner.id]
            && let VariableKind::Column(column, _) = self.flat.variables[var].kind
            && let Some((_, held)) = self.column_variables.get(&column)
        {
            let id = self.flat.exprs.var(*held);
            return self.typed(id, inner.dim, span);
        }
        self.report(refused::held_of_no_column(a.span));
        self.poison(span)
    }

    /// `interval()`: the period of the clocked part, also in an `assert` beside its equations.
    pub(super) fn interval(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([]) = self.exactly("interval", args, span) else {
            return self.poison(span);
        };
        match self.clock_of(scope.instance) {
            Some(clock) if matches!(scope.setting, Setting::Clocked | Setting::Condition) => {
                let id = self.flat.clocks[clock].period;
                self.typed(id, Dim::known(Dimension::TIME), span)
            }
            _ => {
                self.report(refused::interval_outside_clocked(span));
                self.poison(span)
            }
        }
    }
}

/// The clocks of the variables in an expression, each once.
pub(crate) fn clocks_of(flat: &FlatModel, id: ExprId) -> Vec<ClockId> {
    let mut clocks = Vec::new();
    for id in flat.exprs.below(&[id]) {
        if let Ir::Var(var, _) | Ir::Pre(var, _) = flat.exprs[id]
            && let VariableKind::Clocked(clock) = flat.variables[var].kind
            && !clocks.contains(&clock)
        {
            clocks.push(clock);
        }
    }
    clocks
}
