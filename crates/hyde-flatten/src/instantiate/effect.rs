//! Effects on a model: `model A = B with Stribeck(dF = 150 [N]) on guide;` (E1 to E3).
//!
//! ```text
//! add a.tau = e;             the effect is a part with a connector `a` of its own, joined to its host's connection set
//! wrap grip by grip + e;     the equation  grip = g  becomes  grip = g + e
//! replace c by M(k = 1);     the host's replaceable component c becomes an M, its other modifications kept
//! ```
//! An effect is an instance inside its host, `guide.Stribeck`, that sees its host's names after its own. Everything else
//! of the model stays as it is. At exactly neutral sizes the effect is left out: only its parameters remain.

use super::collect::{Collected, Walk, collect};
use super::host::{fits_on, instance_of_effect, written};
use super::making::{Hook, Replacement, Wrap};
use super::modification::{Modifier, modifiers_for, modifiers_of, note_modified};
use super::parameter::parameters_of;
use super::{Place, instantiate, members};
use crate::connect::Connection;
use crate::instance::{InstanceId, Member};
use crate::model::Model;
use crate::names::FileIndex;
use crate::refusals::effects as refused;
use hyde_diag::MadeBy;
use hyde_ir::{Expr as Ir, Index};
use hyde_syntax::ast::{Class, ClassKind, Declaration, Declarator, Element, Prefix};

/// Makes the effects of an instance that was just made, before its own members. Its modifications may name them.
pub(super) fn effects_of<'a>(
    model: &mut Model<'a, '_>,
    host: InstanceId,
    modifiers: &[Modifier<'a>],
) {
    for number in 0..model.making.hooks.len() {
        if model.making.hooks[number].host == model.tree[host].path
            && !model.making.hooks[number].used
        {
            model.making.hooks[number].used = true;
            effect(model, host, number, modifiers);
        }
    }
}

fn effect<'a>(
    model: &mut Model<'a, '_>,
    host: InstanceId,
    number: usize,
    of_host: &[Modifier<'a>],
) {
    let Hook {
        site,
        file,
        class,
        changes,
        scope,
        name,
        keep,
        ..
    } = model.making.hooks[number];
    if !fits_on(model.names, &model.tree[host], (file, class)) {
        let names = (&model.tree, model.names);
        let diagnostic = crate::site::does_not_fit(names, host, (file, class), site);
        model.report(diagnostic);
        return;
    }
    let path = model.tree.path(host);
    let id = instance_of_effect(model, host, (file, class), name, site.span);
    if model.tree.name(host, name, Member::Instance(id)).is_some() {
        model.report(refused::twice_on_a_site(name, &written(site), site.span));
    }
    let mut modifiers = modifiers_for(model, (name, false), of_host);
    modifiers_of(model, changes, scope, &mut modifiers);
    note_modified(model, id, &modifiers);
    let mut collected = Vec::new();
    let walk = Walk {
        id,
        file,
        modifiers,
        chain: Vec::new(),
    };
    collect(model, walk, class, &mut collected);
    let (parameters, rest): (Vec<_>, Vec<_>) =
        collected.into_iter().partition(Collected::is_parameter);
    parameters_of(model, id, &parameters);
    if !keep && is_neutral(model, id, &parameters) {
        model.tree.set_elements(id, Vec::new());
        model.flat.notes.push(format!(
            "`{}` has size 0 and is omitted",
            model.tree.path(id)
        ));
        return;
    }
    let added = rest.iter().find_map(|item| {
        if let Element::Add(equation) = item.element {
            Some(equation.span)
        } else {
            None
        }
    });
    let connector = model.tree[host].class.kind == ClassKind::Connector;
    if let (false, Some(span)) = (connector, added) {
        let diagnostic = crate::site::nothing_to_join(&model.tree[host], class, span);
        model.report(diagnostic);
        model.tree.set_elements(id, Vec::new());
        return;
    }
    if connector {
        let (file, class) = (model.tree[host].file, model.tree[host].class);
        let place = Place {
            path: path.child(name).child("a"),
            parent: Some(id),
            clock: None,
            span: site.span,
        };
        let own = instantiate(model, file, class, Vec::new(), place);
        model.tree.name(id, "a", Member::Instance(own));
        let origin = model
            .tree
            .origin(host, site.span)
            .made_by(MadeBy::Connection);
        model
            .joined
            .push(Connection::joining(vec![(host, true), (own, true)], origin));
    }
    for item in &rest {
        match item.element {
            Element::Wrap(site, value) => model.wraps.push(Wrap {
                host,
                site,
                value,
                effect: id,
                used: false,
            }),
            Element::Replace(component, by, changes) => match model.names.class(item.file, by) {
                Some(class) => model.making.replacements.push(Replacement {
                    host,
                    component,
                    class,
                    changes,
                    effect: id,
                    used: false,
                }),
                None => {
                    let diagnostic = model.names.unknown(item.file, by);
                    model.report(diagnostic);
                }
            },
            Element::Extends(..)
            | Element::Declaration(_)
            | Element::Domain(_)
            | Element::Discretize(_)
            | Element::Modes(_)
            | Element::Clocked(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Add(_)
            | Element::Signature(_)
            | Element::Confounds(_)
            | Element::Measure(_)
            | Element::Account(..) => {}
        }
    }
    members(model, id, &rest);
    let all = parameters.iter().chain(&rest);
    model
        .tree
        .set_elements(id, all.map(|item| (item.file, item.element)).collect());
}

/// Whether every size of an effect is exactly zero. Sizes that are not stay plain parameters.
fn is_neutral<'a>(model: &mut Model<'a, '_>, id: InstanceId, parameters: &[Collected<'a>]) -> bool {
    let before: Vec<bool> = model.flat.parameters.iter().map(|p| p.structural).collect();
    let mut sizes = 0;
    let mut neutral = true;
    for item in parameters {
        let Element::Declaration(declaration) = item.element else {
            continue;
        };
        if !declaration.prefixes.contains(&Prefix::Size) {
            continue;
        }
        for declarator in &declaration.declarators {
            let name = declarator.name.text.as_str();
            let Some(Member::Parameter(param)) = model.tree[id].members.get(name) else {
                continue;
            };
            let leaf = model.flat.exprs.add(Ir::Param(*param, Index::SCALAR));
            sizes += 1;
            neutral &= model.evaluate(leaf) == Some(0.0);
        }
    }
    let neutral = neutral && sizes > 0;
    if !neutral {
        for (parameter, was) in model.flat.parameters.iter_mut().zip(before) {
            parameter.structural = was;
        }
    }
    neutral
}

/// What an effect puts in the place of a component, with the modifications it brings.
pub(super) fn replaced<'a>(
    model: &mut Model<'a, '_>,
    host: InstanceId,
    declaration: &Declaration,
    declarator: &Declarator,
    modifiers: &mut Vec<Modifier<'a>>,
) -> Option<(FileIndex, &'a Class)> {
    let name = declarator.name.text.as_str();
    let number = model.making.replacements.iter().position(|replacement| {
        replacement.host == host && replacement.component.as_word() == Some(name)
    })?;
    model.making.replacements[number].used = true;
    let Replacement {
        component,
        class,
        changes,
        effect,
        ..
    } = model.making.replacements[number];
    if !declaration.prefixes.contains(&Prefix::Replaceable) {
        model.report(refused::not_replaceable(
            component.span,
            &declarator.name,
            &declaration.type_name.dotted(),
        ));
        return None;
    }
    let mut own = Vec::new();
    modifiers_of(model, changes, effect, &mut own);
    // The effect's own modifications come before those of the component it replaces.
    modifiers.splice(0..0, own);
    Some(class)
}
