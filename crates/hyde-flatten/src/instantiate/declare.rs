//! A declaration: whether it means variables or components, its names and its length.

use super::collect::Collected;
use super::component::declare_component;
use super::declarator::free_name;
use super::variable::declare_variable;
use crate::instance::InstanceId;
use crate::model::Model;
use hyde_syntax::ast::{
    self, Declaration, Declarator, Element, EquationKind, Expr, ExprKind, Prefix, Reference,
};

/// Declares variables or components.
pub(super) fn declare<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    item: &Collected<'a>,
    declaration: &'a Declaration,
    discrete: &[&'a str],
    collected: &[Collected<'a>],
) {
    let class = model.names.class(item.file, &declaration.type_name);
    let quantity = model.names.quantity(item.file, &declaration.type_name);
    for declarator in &declaration.declarators {
        if !free_name(model, id, declarator) {
            continue;
        }
        let as_component = match (&class, &quantity) {
            (Some(_), None) => true,
            (None, Some(_)) => false,
            (Some(_), Some(_)) => means_component(declaration, declarator, collected),
            (None, None) => {
                let diagnostic = model.names.unknown(item.file, &declaration.type_name);
                model.report(diagnostic);
                let names = declaration.declarators.iter();
                model
                    .undeclared
                    .extend(names.map(|declarator| declarator.name.text.as_str()));
                return;
            }
        };
        if class.is_none()
            && declarator.is_modified()
            && let Some(diagnostic) = model
                .names
                .component_elsewhere(item.file, &declaration.type_name)
        {
            model.report(diagnostic);
            model.undeclared.insert(declarator.name.text.as_str());
            continue;
        }
        let has_value = declarator.binding.is_some()
            || declaration.prefixes.contains(&Prefix::Input)
            || declaration.prefixes.contains(&Prefix::Output);
        if quantity.is_none()
            && has_value
            && let Some(diagnostic) = model
                .names
                .quantity_elsewhere(item.file, &declaration.type_name)
        {
            model.report(diagnostic);
            model.undeclared.insert(declarator.name.text.as_str());
            continue;
        }
        match (as_component, class, quantity) {
            (true, Some((file, class)), _) => {
                declare_component(model, id, item, declaration, declarator, file, class)
            }
            (_, _, Some(quantity)) => {
                declare_variable(model, id, item, declaration, declarator, quantity, discrete)
            }
            _ => {}
        }
    }
}

/// Whether a name declared with a word that is both a type and a model means a component: it is used with a dot or
/// modified as one.
fn means_component(
    declaration: &Declaration,
    declarator: &Declarator,
    collected: &[Collected<'_>],
) -> bool {
    let quantity = [
        Prefix::Input,
        Prefix::Output,
        Prefix::Flow,
        Prefix::Site,
        Prefix::Field,
    ];
    if declarator.binding.is_some()
        || declaration
            .prefixes
            .iter()
            .any(|prefix| quantity.contains(prefix))
    {
        return false;
    }
    if !declarator.changes.is_empty() {
        return declarator.is_modified();
    }
    collected
        .iter()
        .any(|item| element_uses_member(item.element, &declarator.name.text))
}

fn element_uses_member(element: &Element, name: &str) -> bool {
    let expr = |e: &Expr| uses_member(e, name);
    match element {
        Element::Equation(equation) | Element::InitialEquation(equation) => {
            equation_uses_member(equation, name)
        }
        Element::Declaration(declaration) => declaration.declarators.iter().any(|declarator| {
            declarator.binding.as_ref().is_some_and(expr)
                || declarator
                    .changes
                    .iter()
                    .any(|change| change.value.as_ref().is_some_and(expr))
        }),
        Element::Clocked(clocked) => clocked
            .elements
            .iter()
            .any(|inner| element_uses_member(inner, name)),
        Element::Modes(modes) => modes.modes.iter().any(|mode| {
            mode.equations
                .iter()
                .any(|equation| equation_uses_member(equation, name))
                || mode.exits.iter().any(|exit| expr(&exit.guard))
        }),
        Element::Extends(..)
        | Element::Domain(_)
        | Element::Discretize(_)
        | Element::Wrap(..)
        | Element::Add(_)
        | Element::Replace(..)
        | Element::Signature(_)
        | Element::Confounds(_)
        | Element::Measure(_)
        | Element::Account(..) => false,
    }
}

fn equation_uses_member(equation: &ast::Equation, name: &str) -> bool {
    let inside =
        |list: &[ast::Equation]| list.iter().any(|inner| equation_uses_member(inner, name));
    match &equation.kind {
        EquationKind::Connect(sides) => sides.iter().any(|side| starts_with_member(side, name)),
        EquationKind::Equality { lhs, rhs, .. } => uses_member(lhs, name) || uses_member(rhs, name),
        EquationKind::For { equations, .. } => inside(equations),
        EquationKind::If {
            branches,
            otherwise,
        } => branches.iter().any(|(_, list)| inside(list)) || inside(otherwise),
        EquationKind::When(branches) => branches.iter().any(|(_, list)| inside(list)),
        EquationKind::Assert(condition, _) => uses_member(condition, name),
        EquationKind::Reinit(state, value) => {
            starts_with_member(state, name) || uses_member(value, name)
        }
    }
}

fn uses_member(expr: &Expr, name: &str) -> bool {
    expr.any(&|expr| {
        matches!(&expr.kind, ExprKind::Reference(path) | ExprKind::Call(path, _) if starts_with_member(path, name))
    })
}

fn starts_with_member(reference: &Reference, name: &str) -> bool {
    reference.parts.len() > 1 && reference.parts[0].name.text == name
}
