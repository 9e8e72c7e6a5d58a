//! Variables with their kind, length and attributes.

use super::collect::Collected;
use super::declarator::{is_array, length};
use super::domain::field;
use super::modification::{attribute, binding, check_attributes, declared_bounds, modifiers_for};
use super::quantity::quantity;
use crate::instance::{Binding, InstanceId, Member, Setting, VariableNotes};
use crate::model::Model;
use crate::names::TypeName;
use crate::refusals::instantiate as refused;
use hyde_diag::Diagnostics;
use hyde_ir::{StateChoice, Variable, VariableKind};
use hyde_syntax::ast::{ClassKind, Declaration, Declarator, Expr, ExprKind, Prefix};
use hyde_units::Kind;

pub(super) fn declare_variable<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    item: &Collected<'a>,
    declaration: &'a Declaration,
    declarator: &'a Declarator,
    kind: TypeName<'a>,
    discrete: &[&'a str],
) {
    let name = declarator.name.text.as_str();
    let has = |prefix| declaration.prefixes.contains(&prefix);
    let modifiers = modifiers_for(
        model,
        (name, is_array(declaration, declarator)),
        &item.modifiers,
    );
    let binding = binding(id, declarator, &modifiers);
    let attribute =
        |model: &mut Model<'a, '_>, word: &str| attribute(model, id, declarator, &modifiers, word);
    let start = attribute(model, "start");
    let fixed = attribute(model, "fixed");
    let state = attribute(model, "state");
    let bounds = declared_bounds(model, id, declarator, &modifiers);
    let all = ["start", "fixed", "state", "min", "max"];
    check_attributes(model, declarator, &modifiers, &all);
    // At the top, and in a modification, the author means this model; in a part's own declaration every use of it.
    let given = [&start, &fixed].into_iter().flatten();
    let start_given =
        given.into_iter().any(|attribute| attribute.scope != id) || model.tree[id].parent.is_none();
    let truths = fixed.map(|fixed| truths(model, &fixed));
    let said = truths.as_ref().map(|list| list.iter().all(|&truth| truth));
    let fixed_elements = truths.filter(|_| said == Some(false)).unwrap_or_default();
    let (fixed, freed) = (said == Some(true), said == Some(false));
    let state = state.map_or(StateChoice::Open, |state| {
        state_choice(model.diagnostics, state.expr)
    });
    let (dim, quantity) = quantity(model, kind, binding.as_ref().map(|binding| binding.expr));
    let clock = model.clock_of(id);
    let variable_kind = match clock {
        Some(clock) => VariableKind::Clocked(clock),
        None if discrete.contains(&name) => VariableKind::Discrete,
        None => VariableKind::Continuous,
    };
    let field = if has(Prefix::Field) {
        let field = field(model, id, declarator);
        if field.is_none() {
            model.undeclared.insert(name);
            return;
        }
        field
    } else {
        None
    };
    let (len, first) = match field {
        Some(field) => {
            let cells = model.domains[field.domain].cells;
            (
                Some(if field.flux { cells } else { cells + 1 }),
                i32::from(field.flux),
            )
        }
        None => (length(model, id, &declaration.dims, &declarator.dims), 1),
    };
    let origin = model.tree.origin(id, declarator.name.span);
    let flow = has(Prefix::Flow);
    if flow && model.tree[id].class.kind != ClassKind::Connector {
        model.report(refused::flow_outside_connector(name, declaration.span));
    }
    model.variables.push(VariableNotes {
        instance: id,
        dim,
        binding,
        start,
        bounds,
        integer: kind.values() == Kind::Integer,
        difference: false,
        fixed_elements,
        field,
    });
    let var = model.flat.variables.push(Variable {
        name: model.tree[id].path.member(name),
        len,
        first,
        kind: variable_kind,
        quantity,
        start: Vec::new(),
        fixed,
        start_given,
        freed,
        state,
        flow,
        boolean: matches!(kind, TypeName::Boolean),
        input: has(Prefix::Input),
        trace: None,
        origin,
    });
    model.tree.name(id, name, Member::Variable(var));
}

/// Whether `fixed = …` holds for the whole of a variable.
pub(super) fn is_true<'a>(model: &mut Model<'a, '_>, fixed: &Binding<'a>) -> bool {
    truths(model, fixed).iter().all(|&truth| truth)
}

/// What `fixed = …` says: a truth that is known before the run, or one for each element.
fn truths<'a>(model: &mut Model<'a, '_>, fixed: &Binding<'a>) -> Vec<bool> {
    let (expr, _, scope) = model.picked(fixed, Setting::Parameter);
    if let ExprKind::Boolean(truth) = expr.kind {
        return vec![truth];
    }
    let items = match model.list_length(expr, &scope) {
        Some(len) => (0..len)
            .map(|at| model.list_item(expr, at, &scope).id)
            .collect(),
        None => vec![model.truth(expr, &scope)],
    };
    let truth = |item| model.evaluate(item).is_some_and(|value| value != 0.0);
    items.into_iter().map(truth).collect()
}

/// The word behind `state =`.
fn state_choice(diagnostics: &mut Diagnostics, expr: &Expr) -> StateChoice {
    let word = if let ExprKind::Reference(reference) = &expr.kind {
        reference.as_word()
    } else {
        None
    };
    word.and_then(StateChoice::of).unwrap_or_else(|| {
        diagnostics.push(refused::unknown_choice_of_states(expr.span));
        StateChoice::Open
    })
}
