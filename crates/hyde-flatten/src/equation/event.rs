//! `when`: what an event sets.
//!
//! ```text
//! when v < 0 then n = pre(n) + 1; reinit(v, -e*v); end when;
//! ```
//! becomes a condition with a list of actions: assignments of discrete variables, new values of states.

use crate::allowed::check_whole;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::zero;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::flat::{Action, When};
use hyde_ir::{Expr as Ir, Index, VariableKind};
use hyde_syntax::ast::{self, EquationKind, Expr, ExprKind};

pub(super) fn when<'a>(
    model: &mut Model<'a, '_>,
    branches: &'a [(Expr, Vec<ast::Equation>)],
    scope: &Scope<'a>,
    span: Span,
) {
    if scope.setting == Setting::Clocked {
        model.report(
            Diagnostic::error(Code::ClockBorder, "`when` inside a clocked part")
                .label(span, "everything here happens at the tick")
                .help("write `x = if … then … else pre(x);`"),
        );
        return;
    }
    let mut list = Vec::new();
    for (condition, equations) in branches {
        let condition = model.truth(condition, &scope.with(Setting::Condition));
        let actions = equations
            .iter()
            .filter_map(|equation| lower_action(model, equation, scope))
            .collect();
        list.push((condition, actions));
    }
    let origin = model.tree.origin(scope.instance, span);
    model.flat.whens.push(When {
        branches: list,
        origin,
    });
}

/// What an event sets: `reinit(x, e)`, or `d = e` of a discrete variable.
pub(crate) fn lower_action<'a>(
    model: &mut Model<'a, '_>,
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
            model.report(
                Diagnostic::error(Code::Misplaced, "an event sets variables one by one")
                    .label(equation.span, "neither `reinit(x, e)` nor `d = e`"),
            );
            return None;
        }
    };
    let Some(Resolved::Variable(var, index)) = model.resolve(target, scope) else {
        model.report(
            Diagnostic::error(Code::WrongType, "no variable to set")
                .label(target.span, "not a variable"),
        );
        return None;
    };
    let index = index.unwrap_or(Index::SCALAR);
    let value = model.lower(value, &at_event);
    let lhs = model.flat.exprs.add(Ir::Var(var, index));
    let declared = Typed {
        truth: model.flat.variables[var].boolean,
        ..model.typed(lhs, model.dim(var), target.span)
    };
    model.same_kind(&declared, &value);
    check_whole(model, &declared, &value);
    zero::show_difference(&mut model.flat, &mut model.variables, (&declared, &value));
    model.agree(
        &declared,
        &value,
        "the variable and its new value are",
        scope.instance,
    );
    let kind = model.flat.variables[var].kind;
    match (reinit, kind) {
        (true, VariableKind::Continuous) => Some(Action::Reinit(var, index, value.id)),
        (false, VariableKind::Discrete) => Some(Action::Assign(var, index, value.id)),
        (true, _) => {
            model.report(
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
            model.report(
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
