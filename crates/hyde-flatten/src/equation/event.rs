//! `when`: what an event sets.
//!
//! ```text
//! when v < 0 then n = pre(n) + 1; reinit(v, -e*v); end when;
//! ```
//! becomes a condition with a list of actions: assignments of discrete variables, new values of states.

use crate::instance::{Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::Model;
use crate::zero;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::flat::{Action, When};
use hyde_ir::{Expr as Ir, Index, VariableKind};
use hyde_syntax::ast::{self, EquationKind, Expr, ExprKind};

impl<'a> Model<'a, '_> {
    pub(super) fn when(
        &mut self,
        branches: &'a [(Expr, Vec<ast::Equation>)],
        scope: &Scope<'a>,
        span: Span,
    ) {
        if scope.setting == Setting::Clocked {
            self.report(
                Diagnostic::error(Code::ClockBorder, "`when` inside a clocked part")
                    .label(span, "everything here happens at the tick")
                    .help("write `x = if … then … else pre(x);`"),
            );
            return;
        }
        let mut list = Vec::new();
        for (condition, equations) in branches {
            let condition = self.truth(condition, &scope.with(Setting::Condition));
            let actions = equations
                .iter()
                .filter_map(|equation| self.action(equation, scope))
                .collect();
            list.push((condition, actions));
        }
        let origin = self.tree.origin(scope.instance, span);
        self.flat.whens.push(When {
            branches: list,
            origin,
        });
    }

    /// What an event sets: `reinit(x, e)`, or `d = e` of a discrete variable.
    pub(crate) fn action(
        &mut self,
        equation: &'a ast::Equation,
        scope: &Scope<'a>,
    ) -> Option<Action> {
        let at_event = scope.with(Setting::Action);
        let (target, value, reinit) = match &equation.kind {
            EquationKind::Reinit(state, value) => (state, value, true),
            EquationKind::Equality {
                lhs:
                    Expr {
                        kind: ExprKind::Reference(name),
                        ..
                    },
                rhs,
                place: None,
            } => (name, rhs, false),
            EquationKind::Equality { .. }
            | EquationKind::Connect(_)
            | EquationKind::For { .. }
            | EquationKind::If { .. }
            | EquationKind::When(_)
            | EquationKind::Assert(..) => {
                self.report(
                    Diagnostic::error(Code::Misplaced, "an event sets variables one by one")
                        .label(equation.span, "neither `reinit(x, e)` nor `d = e`"),
                );
                return None;
            }
        };
        let Some(Resolved::Variable(var, index)) = self.resolve(target, scope) else {
            self.report(
                Diagnostic::error(Code::WrongType, "no variable to set")
                    .label(target.span, "not a variable"),
            );
            return None;
        };
        let index = index.unwrap_or(Index::SCALAR);
        let value = self.lower(value, &at_event);
        let lhs = self.flat.exprs.add(Ir::Var(var, index));
        let declared = Typed {
            truth: self.flat.variables[var].boolean,
            ..self.typed(lhs, self.dim(var), target.span)
        };
        self.same_kind(&declared, &value);
        self.check_whole(&declared, &value);
        zero::show_difference(&mut self.flat, &mut self.variables, (&declared, &value));
        self.agree(
            &declared,
            &value,
            "the variable and its new value are",
            scope.instance,
        );
        let kind = self.flat.variables[var].kind;
        match (reinit, kind) {
            (true, VariableKind::Continuous) => Some(Action::Reinit(var, index, value.id)),
            (false, VariableKind::Discrete) => Some(Action::Assign(var, index, value.id)),
            (true, _) => {
                self.report(
                    Diagnostic::error(
                        Code::WrongType,
                        format!("`{}` is not a state", target.dotted()),
                    )
                    .label(target.span, "only a state can be reinitialised")
                    .help("set a discrete variable with `=`"),
                );
                None
            }
            (false, _) => {
                self.report(
                    Diagnostic::error(
                        Code::WrongType,
                        format!("`{}` is continuous", target.dotted()),
                    )
                    .label(target.span, "an event cannot equate it")
                    .help("let a state jump with `reinit(x, e)`"),
                );
                None
            }
        }
    }
}
