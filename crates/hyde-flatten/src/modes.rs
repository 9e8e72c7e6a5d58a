//! `modes` blocks: each becomes an automaton whose modes hold their equations and exits.

use crate::dimension::Dim;
use crate::equation::{lower_action, lower_equation};
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::instantiate::type_unit;
use crate::model::Model;
use crate::names::TypeName;
use crate::refusals::equations as refused;
use hyde_diag::{Diagnostics, MadeBy};
use hyde_ir::flat::{Action, Automaton, Mode, Transition};
use hyde_ir::{Index, Range, VarId, VariableKind};
use hyde_syntax::ast::{self, Argument};

/// Lowers a `modes` block of an instance.
pub(crate) fn lower_modes<'a>(model: &mut Model<'a, '_>, modes: &'a ast::Modes, id: InstanceId) {
    if model.clock_of(id).is_some() {
        model.report(refused::clocked_modes(modes.span));
        return;
    }
    let parameters: Vec<Vec<(&'a str, VarId)>> = modes
        .modes
        .iter()
        .map(|mode| mode_parameters(model, mode, modes.name.as_ref(), id))
        .collect();
    let mut list = Vec::new();
    for (from, (mode, own)) in modes.modes.iter().zip(&parameters).enumerate() {
        let scope = Scope {
            locals: own.clone(),
            ..Scope::new(id, Setting::Equation)
        };
        let equations: Vec<_> = mode
            .equations
            .iter()
            .flat_map(|e| lower_equation(model, e, &scope))
            .collect();
        if let Some(array) = equations
            .iter()
            .find(|equation| equation.range != Range::SCALAR)
        {
            let span = array.origin.span;
            model.report(refused::array_in_mode(span));
        }
        let exits = mode
            .exits
            .iter()
            .filter_map(|exit| lower_exit(model, exit, from, modes, &parameters, &scope))
            .collect();
        let origin = model.tree.origin(id, mode.name.span);
        list.push(Mode {
            name: mode.name.text.clone(),
            equations,
            exits,
            origin,
        });
    }
    same_counts(model.diagnostics, modes, &list);
    let scope = Scope::new(id, Setting::Parameter);
    let Some(initial) = mode_named(model.diagnostics, modes, &modes.initial) else {
        return;
    };
    let initial_actions = mode_arguments(
        model,
        &modes.arguments,
        &parameters[initial],
        &modes.initial,
        &scope,
    );
    let origin = model.tree.origin(id, modes.span);
    let name = match &modes.name {
        Some(name) => model.tree[id].path.member(&name.text),
        None => model.tree[id].path.as_str().to_owned(),
    };
    model.flat.automata.push(Automaton {
        name,
        modes: list,
        initial,
        initial_actions,
        origin,
    });
}

/// The parameters of a mode are discrete variables that its entry sets.
fn mode_parameters<'a>(
    model: &mut Model<'a, '_>,
    mode: &'a ast::Mode,
    block: Option<&ast::Name>,
    id: InstanceId,
) -> Vec<(&'a str, VarId)> {
    let file = model.tree[id].file;
    let mut found = Vec::new();
    for (type_name, name) in &mode.parameters {
        let (dim, boolean) = match model.names.quantity(file, type_name) {
            Some(TypeName::Boolean) => (Dim::NUMBER, true),
            Some(TypeName::Integer) => (Dim::NUMBER, false),
            Some(TypeName::Real) => (Dim::unknown(model.dimensions.fresh()), false),
            Some(TypeName::Quantity(file, item)) => {
                let unit = type_unit(model, file, item);
                (
                    unit.map_or(Dim::NUMBER, |unit| Dim::known(unit.unit().dimension)),
                    false,
                )
            }
            None => {
                let diagnostic = model.names.unknown(file, type_name);
                model.report(diagnostic);
                continue;
            }
        };
        let block = block.map_or(String::new(), |block| format!("{}.", block.text));
        let full = model.tree[id]
            .path
            .member(&format!("{block}{}.{}", mode.name.text, name.text));
        let var = model.add_variable(
            id,
            full,
            VariableKind::Discrete,
            dim,
            name.span,
            MadeBy::Source,
        );
        model.flat.variables[var].boolean = boolean;
        found.push((name.text.as_str(), var));
    }
    found
}

/// An exit of the mode of that number. It sets what leaving that mode does, the parameters of the mode entered, what it
/// says itself, and what entering the other mode does, in this order.
fn lower_exit<'a>(
    model: &mut Model<'a, '_>,
    exit: &'a ast::Exit,
    from: usize,
    modes: &'a ast::Modes,
    parameters: &[Vec<(&'a str, VarId)>],
    scope: &Scope<'a>,
) -> Option<Transition> {
    let guard = model.truth(&exit.guard, &scope.with(Setting::Condition));
    let target = mode_named(model.diagnostics, modes, &exit.target)?;
    let at_event = scope.with(Setting::Action);
    let from = &modes.modes[from];
    let mut actions = lower_actions(model, &from.leave, scope);
    actions.extend(mode_arguments(
        model,
        &exit.arguments,
        &parameters[target],
        &exit.target,
        &at_event,
    ));
    actions.extend(lower_actions(model, &exit.actions, scope));
    let inside = Scope {
        locals: parameters[target].clone(),
        ..scope.clone()
    };
    actions.extend(lower_actions(model, &modes.modes[target].enter, &inside));
    let reinits = actions
        .iter()
        .any(|action| matches!(action, Action::Reinit(..)));
    let origin = model.tree.origin(scope.instance, exit.span);
    Some(Transition {
        guard,
        target,
        actions,
        impact: exit.impact || reinits,
        origin,
    })
}

fn lower_actions<'a>(
    model: &mut Model<'a, '_>,
    actions: &'a [ast::Equation],
    scope: &Scope<'a>,
) -> Vec<Action> {
    let lowered = actions
        .iter()
        .filter_map(|action| lower_action(model, action, scope));
    lowered.collect()
}

/// The values an entry gives to a mode's parameters.
fn mode_arguments<'a>(
    model: &mut Model<'a, '_>,
    arguments: &'a [Argument],
    parameters: &[(&'a str, VarId)],
    target: &ast::Name,
    scope: &Scope<'a>,
) -> Vec<Action> {
    if arguments.len() != parameters.len() {
        model.report(refused::values_of_mode(
            target,
            parameters.len(),
            arguments.len(),
        ));
        return Vec::new();
    }
    let mut actions = Vec::new();
    for (argument, (name, var)) in arguments.iter().zip(parameters) {
        let value = model.lower(&argument.value, scope);
        let var = match &argument.name {
            None => *var,
            Some(named) => match parameters.iter().find(|(known, _)| *known == named.text) {
                Some((_, var)) => *var,
                None => {
                    model.report(refused::no_value_of_mode(&target.text, named, name));
                    continue;
                }
            },
        };
        let lhs = model.flat.exprs.var(var);
        let declared = Typed {
            truth: value.truth,
            ..model.typed(lhs, model.dim(var), argument.value.span)
        };
        model.agree(
            &declared,
            &value,
            "the mode's parameter and its value are",
            scope.instance,
        );
        actions.push(Action::Assign(var, Index::SCALAR, value.id));
    }
    actions
}

fn mode_named(
    diagnostics: &mut Diagnostics,
    modes: &ast::Modes,
    name: &ast::Name,
) -> Option<usize> {
    let found = modes
        .modes
        .iter()
        .position(|mode| mode.name.text == name.text);
    if found.is_none() {
        let known: Vec<&str> = modes
            .modes
            .iter()
            .map(|mode| mode.name.text.as_str())
            .collect();
        diagnostics.push(refused::unknown_mode(name, &known));
    }
    found
}

/// Every mode has the same number of equations (M1).
fn same_counts(diagnostics: &mut Diagnostics, modes: &ast::Modes, list: &[Mode]) {
    let Some(first) = list.first() else { return };
    let differing = list
        .iter()
        .zip(&modes.modes)
        .find(|(mode, _)| mode.equations.len() != first.equations.len());
    if let Some((mode, written)) = differing {
        let own = (written.name.span, mode.equations.len());
        let first = (modes.modes[0].name.span, first.equations.len());
        diagnostics.push(refused::modes_differ(own, first));
    }
}
