//! Instantiates a model: a tree of instances, each with its parameters, variables and parts.
//!
//! `M m(R = 2)` with `model M extends B(R = 1); parameter Resistance R = 3; end M;` makes the instance `m` with the
//! parameter `m.R`, whose binding is the outermost of: the modification in the enclosing model (evaluated there), the
//! modification of the `extends` clause, the declaration. Nothing is evaluated here but what decides the structure:
//! dimensions of arrays and numbers of cells ([`crate::model::structural`]).

mod assigned;
mod clocked;
mod collect;
mod component;
mod declarator;
mod declare;
mod domain;
mod effect;
mod hook;
mod host;
mod making;
mod modification;
mod offer;
mod parameter;
mod quantity;
mod tree;
mod variable;

pub(crate) use domain::domain_named;
pub(crate) use host::{host_of, written};
pub(crate) use making::{Making, Offer, Wrap};
pub(crate) use quantity::{literal_unit, quantity, type_unit};
pub(crate) use tree::InstanceTree;

use crate::foreign;
use crate::instance::{Instance, InstanceId};
use crate::model::Model;
use crate::names::FileIndex;
use crate::refusals::instantiate as refused;
use clocked::declare_clocked;
use collect::{Collected, Walk, collect};
use declare::declare;
use domain::declare_domain;
use effect::effects_of;
use hook::hook_additions;
use hyde_diag::{InstancePath, Span};
use hyde_ir::ClockId;
use hyde_syntax::ast::{Class, Element};
use modification::{Modifier, modifiers_of, note_modified, report_unused_modifications};
use parameter::parameters_of;
use std::collections::BTreeMap;

/// Where an instance stands.
struct Place {
    path: InstancePath,
    parent: Option<InstanceId>,
    clock: Option<ClockId>,
    span: Span,
}

/// A replaceable part may be redeclared as what holds it, a few times over; more has no end.
const MAX_NESTED: usize = 6;
/// Parts inside parts at most: nobody builds machines so, and recursion needs stack.
const MAX_PARTS: usize = 200;

/// Instantiates the model asked for; `None` if there is none of that name.
pub(crate) fn instantiate_root(model: &mut Model<'_, '_>) -> Option<InstanceId> {
    let name = model.input.model;
    let Some(class) = model.names.own_class(name) else {
        let file = model.input.files.first()?.0;
        let models: Vec<&str> = model.names.own_models().collect();
        let written = model
            .input
            .experiment
            .and_then(|experiment| model.names.own_experiment(experiment))
            .filter(|experiment| experiment.model.dotted() == name);
        let place = match written {
            Some(experiment) => (experiment.model.span, "not in this file"),
            None => (Span::new(file, 0, 0), "searched in this file"),
        };
        model.report(refused::no_model(name, place, &models));
        return None;
    };
    model.flat.name = class.name.text.clone();
    let mut modifiers = Vec::new();
    if let Some(experiment) = model
        .input
        .experiment
        .and_then(|name| model.names.own_experiment(name))
    {
        model.flat.experiment.records = experiment
            .records
            .iter()
            .map(|record| record.name.text.clone())
            .collect();
        modifiers_of(model, &experiment.changes, 0, &mut modifiers);
        modifiers
            .iter_mut()
            .for_each(|modifier| modifier.records = true);
    }
    let place = Place {
        path: InstancePath::root(),
        parent: None,
        clock: None,
        span: class.name.span,
    };
    let root = instantiate(model, 0, class, modifiers, place);
    report_unused_modifications(model);
    Some(root)
}

fn instantiate<'a>(
    model: &mut Model<'a, '_>,
    file: FileIndex,
    class: &'a Class,
    modifiers: Vec<Modifier<'a>>,
    place: Place,
) -> InstanceId {
    let Place {
        path,
        parent,
        clock,
        span,
    } = place;
    let id = model.tree.push(Instance {
        path,
        file,
        class,
        parent,
        outer: None,
        clock,
        members: BTreeMap::new(),
        elements: Vec::new(),
        span,
    });
    if model
        .making
        .endless
        .iter()
        .any(|&known| std::ptr::eq(known, class))
    {
        return id;
    }
    if nested(&model.tree, id) > MAX_NESTED {
        model.making.endless.push(class);
        model.report(refused::contains_itself(&class.name));
        return id;
    }
    if depth(&model.tree, id) > MAX_PARTS {
        model.making.endless.push(class);
        model.report(refused::nested_too_deep(class.name.span, MAX_PARTS));
        return id;
    }
    note_modified(model, id, &modifiers);
    if parent.is_none() {
        hook_additions(model, id);
    }
    effects_of(model, id, &modifiers);
    let mut collected = Vec::new();
    let walk = Walk {
        id,
        file,
        modifiers,
        chain: Vec::new(),
    };
    let extended = std::mem::replace(&mut model.making.extended, 0);
    collect(model, walk, class, &mut collected);
    model.making.extended = extended;
    members(model, id, &collected);
    offer::offer(model, id);
    id
}

/// Makes the members of an instance from its collected elements: parameters first, for dimensions may use them.
fn members<'a>(model: &mut Model<'a, '_>, id: InstanceId, collected: &[Collected<'a>]) {
    let discrete: Vec<&'a str> = collected
        .iter()
        .flat_map(|item| assigned::at_events(item.element))
        .collect();
    parameters_of(model, id, collected);
    let elements: Vec<&'a Element> = collected.iter().map(|item| item.element).collect();
    for item in collected {
        if let Element::Domain(domain) = item.element {
            let method = collected.iter().find_map(|other| {
                if let Element::Discretize(method) = other.element
                    && method.domain.text == domain.name.text
                {
                    Some(method)
                } else {
                    None
                }
            });
            declare_domain(model, id, domain, method, &elements);
        }
    }
    for item in collected.iter().filter(|item| !item.is_parameter()) {
        match item.element {
            Element::Declaration(declaration) => {
                declare(model, id, item, declaration, &discrete, collected)
            }
            Element::Clocked(clocked) => {
                if let Some((part, inside)) = declare_clocked(model, id, item, clocked) {
                    members(model, part, &inside);
                    let parts = (id, part);
                    foreign::note_part(&mut model.flat, model.input, &model.tree, parts, item.file);
                }
            }
            Element::Discretize(method) => {
                domain_named(model, id, &method.domain);
            }
            Element::Extends(..)
            | Element::Domain(_)
            | Element::Modes(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Replace(..)
            | Element::Signature(_)
            | Element::Confounds(_)
            | Element::Measure(_)
            | Element::Account(..) => {}
        }
    }
    let elements = collected
        .iter()
        .map(|item| (item.file, item.element))
        .collect();
    model.tree.set_elements(id, elements);
}

/// How many instances are around an instance, itself counted.
fn depth(tree: &InstanceTree<'_>, id: InstanceId) -> usize {
    tree.around(id).count()
}

/// How often the class of an instance is that of the instances around it, itself counted.
fn nested(tree: &InstanceTree<'_>, id: InstanceId) -> usize {
    let class = tree[id].class;
    let around = tree.around(id);
    around
        .filter(|&id| std::ptr::eq(tree[id].class, class))
        .count()
}
