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
use crate::refusals::equations as refused;
use crate::zero;
use hyde_diag::Span;
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
        model.report(refused::clocked_when(span));
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
            model.report(refused::not_an_action(equation.span));
            return None;
        }
    };
    let Some(Resolved::Variable(var, index)) = model.resolve(target, scope) else {
        model.report(refused::sets_no_variable(target.span));
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
            model.report(refused::reinit_of_no_state(target));
            None
        }
        (false, _) => {
            model.report(refused::sets_continuous(target));
            None
        }
    }
}
