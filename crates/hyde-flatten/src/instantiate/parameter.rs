//! Parameters with their priors and sources.

use super::collect::Collected;
use super::declarator::{free_name, is_array, length};
use super::modification::{attribute, binding, check_attributes, declared_bounds, modifiers_for};
use super::quantity::{quantities_of, quantity};
use super::variable::is_true;
use crate::instance::{InstanceId, Lowering, Member, ParameterNotes};
use crate::model::Model;
use crate::names::TypeName;
use crate::refusals::instantiate as refused;
use hyde_ir::{Parameter, Role};
use hyde_syntax::ast::{self, Declaration, Element, Prefix};
use hyde_units::{Allowed, NamedUnit};

/// Declares the parameters among the elements of an instance.
pub(super) fn parameters_of<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    collected: &[Collected<'a>],
) {
    for item in collected.iter().filter(|item| item.is_parameter()) {
        if let Element::Declaration(declaration) = item.element {
            declare_parameters(model, id, item, declaration);
        }
    }
}

fn declare_parameters<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    item: &Collected<'a>,
    declaration: &'a Declaration,
) {
    let Some(kind) = model.names.quantity(item.file, &declaration.type_name) else {
        let elsewhere = || {
            model
                .names
                .quantity_elsewhere(item.file, &declaration.type_name)
        };
        let class = model.names.class(item.file, &declaration.type_name);
        let diagnostic = match class.map(|_| elsewhere()) {
            Some(Some(diagnostic)) => diagnostic,
            Some(None) => refused::model_as_parameter(declaration.type_name.span),
            None => model
                .names
                .unknown_quantity(item.file, &declaration.type_name),
        };
        let values = declaration.declarators.iter();
        let mut values = values.filter_map(|declarator| declarator.binding.as_ref());
        let fitting = values.find_map(|value| quantities_of(model, item.file, value));
        model.report(match fitting {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
        let names = declaration.declarators.iter();
        model
            .undeclared
            .extend(names.map(|declarator| declarator.name.text.as_str()));
        return;
    };
    let has = |prefix| declaration.prefixes.contains(&prefix);
    for declarator in &declaration.declarators {
        if !free_name(model, id, declarator) {
            continue;
        }
        let name = declarator.name.text.as_str();
        let modifiers = modifiers_for(
            model,
            (name, is_array(declaration, declarator)),
            &item.modifiers,
        );
        let outermost = modifiers.iter().find(|modifier| modifier.is_of_itself());
        if let (true, Some(modifier)) = (has(Prefix::Final) || has(Prefix::Constant), outermost) {
            model.report(refused::modifies_final(
                modifier.change.target.span,
                &declarator.name,
            ));
        }
        let declared = declarator
            .prior
            .as_ref()
            .or_else(|| outermost.and_then(|m| m.change.prior.as_ref()));
        let written = outermost.and_then(|m| m.change.prior.as_ref()).or(declared);
        let prior = written.and_then(|prior| prior_of(model, prior));
        let source = outermost
            .and_then(|m| m.change.source.clone())
            .or_else(|| declarator.source.clone());
        let fixed = attribute(model, id, declarator, &modifiers, "fixed");
        let found = fixed.is_some_and(|fixed| !is_true(model, &fixed));
        let mut binding = binding(id, declarator, &modifiers);
        if found && binding.is_none() {
            binding = attribute(model, id, declarator, &modifiers, "start");
        }
        let bounds = declared_bounds(model, id, declarator, &modifiers);
        let known = ["min", "max", "fixed", "start"];
        check_attributes(model, declarator, &modifiers, &known);
        let (dim, quantity) = quantity(model, kind, binding.as_ref().map(|binding| binding.expr));
        let len = length(model, id, &declaration.dims, &declarator.dims);
        let span = binding
            .as_ref()
            .map_or(declarator.name.span, |binding| binding.span);
        let path = model.tree.path(id);
        let is_final = has(Prefix::Final)
            || has(Prefix::Constant)
            || outermost.is_some_and(|m| m.change.is_final);
        model.parameters.push(ParameterNotes {
            of: id,
            dim,
            binding,
            state: Lowering::Waiting,
            boolean: matches!(kind, TypeName::Boolean),
            bounds,
            within: declarator.within.as_ref(),
            prior: prior.and(written),
        });
        let role = match (has(Prefix::Size), has(Prefix::Shape)) {
            (true, _) => Role::Size,
            (false, true) => Role::Shape,
            (false, false) => Role::Plain,
        };
        let param = model.flat.parameters.push(Parameter {
            name: path.member(name),
            len,
            value: Vec::new(),
            quantity,
            allowed: Allowed {
                kind: kind.values(),
                ..Allowed::default()
            },
            structural: false,
            is_final: is_final || found,
            found,
            derived: false,
            prior,
            role,
            range: None,
            source,
            origin: model.tree.origin(id, span),
        });
        model.tree.name(id, name, Member::Parameter(param));
    }
}

pub(super) fn prior_of<'a>(
    model: &mut Model<'a, '_>,
    prior: &'a ast::Prior,
) -> Option<hyde_ir::Prior> {
    if prior.percent {
        return Some(hyde_ir::Prior::Relative(prior.value / 100.0));
    }
    let scale = match &prior.unit {
        None => 1.0,
        Some(unit) => match NamedUnit::parse(&unit.text) {
            Ok(unit) => unit.unit().difference_to_si(1.0),
            Err(error) => {
                model.bad_unit(unit, &error);
                return None;
            }
        },
    };
    Some(hyde_ir::Prior::Absolute(prior.value * scale))
}
