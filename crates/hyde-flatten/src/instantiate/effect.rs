//! Effects on a model: `model A = B with Stribeck(dF = 150 [N]) on guide;` (E1 to E3).
//!
//! ```text
//! add a.tau = e;             the effect is a part with a connector `a` of its own, joined to its host's connection set
//! wrap grip by grip + e;     the equation  grip = g  becomes  grip = g + e
//! replace c by M(k = 1);     the host's replaceable component c becomes an M, its other modifications kept
//! ```
//! An effect is an instance inside its host, `guide.Stribeck`, that sees its host's names after its own. Everything else
//! of the model stays as it is. At exactly neutral sizes the effect is left out: only its parameters remain.

use super::modification::{Modifier, modifiers_for, modifiers_of, note_modified};
use super::{Collected, Place, Walk, collect, instantiate, members};
use crate::connect::Connection;
use crate::instance::{Instance, InstanceId, Member};
use crate::model::Model;
use crate::names::{FileIndex, Names};
use crate::refusals::effects as refused;
use crate::wrap::Wrap;
use hyde_diag::{InstancePath, MadeBy, Span};
use hyde_ir::{Expr as Ir, Index};
use hyde_syntax::ast::{
    Change, Class, ClassBody, ClassKind, Declaration, Declarator, EffectUse, Element, Prefix,
    Reference,
};

/// An effect to be put on an instance once that is made.
pub(crate) struct Hook<'a> {
    host: InstancePath,
    pub(crate) site: &'a Reference,
    file: FileIndex,
    class: &'a Class,
    changes: &'a [Change],
    /// The model that uses the effect: its changes stand in its scope.
    pub(crate) scope: InstanceId,
    /// What its instance is called below its host.
    name: &'a str,
    /// Neutral sizes do not leave it out.
    keep: bool,
    pub(crate) used: bool,
}

/// `replace c by M(…);`
pub(crate) struct Replacement<'a> {
    pub(crate) host: InstanceId,
    pub(crate) component: &'a Reference,
    class: (FileIndex, &'a Class),
    changes: &'a [Change],
    effect: InstanceId,
    pub(crate) used: bool,
}

/// Notes the effects of a model, to be put on their sites as those are made.
pub(super) fn hook<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    file: FileIndex,
    effects: &'a [EffectUse],
) {
    for used in effects {
        let found = model.names.class(file, &used.effect);
        let Some((file, class)) = found.filter(|(_, class)| class.kind == ClassKind::Effect) else {
            let diagnostic = match found {
                Some((_, class)) => refused::with_no_effect(&class.name.text, used.effect.span),
                None => model.names.unknown(file, &used.effect),
            };
            model.report(diagnostic);
            continue;
        };
        for site in &used.sites {
            model.making.hooks.push(Hook {
                host: model.tree.path(id).child(&written(site)),
                site,
                file,
                class,
                changes: &used.changes,
                scope: id,
                name: &class.name.text,
                keep: false,
                used: false,
            });
        }
    }
}

/// Notes the effects that are put on the model from outside its text.
pub(super) fn hook_additions(model: &mut Model<'_, '_>, root: InstanceId) {
    for addition in model.input.additions.list() {
        let Some((file, class)) = model.names.class(0, &addition.effect) else {
            let diagnostic = model.names.unknown(0, &addition.effect);
            model.report(diagnostic);
            continue;
        };
        model.making.hooks.push(Hook {
            host: InstancePath::root().child(&written(&addition.site)),
            site: &addition.site,
            file,
            class,
            changes: &[],
            scope: root,
            name: &addition.name,
            keep: model.input.additions.keeps_neutral(),
            used: false,
        });
    }
}

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
    let mut modifiers = modifiers_for(model, name, of_host);
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
    let (parameters, rest): (Vec<_>, Vec<_>) = collected.into_iter().partition(is_parameter);
    members(model, id, &parameters);
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

/// An effect inside its host, without members yet.
pub(super) fn instance_of_effect<'a>(
    model: &mut Model<'a, '_>,
    host: InstanceId,
    (file, class): (FileIndex, &'a Class),
    name: &str,
    span: Span,
) -> InstanceId {
    model.tree.push(Instance {
        path: model.tree.path(host).child(name),
        file,
        class,
        parent: Some(host),
        outer: Some(host),
        clock: model.clock_of(host),
        members: std::collections::BTreeMap::new(),
        elements: Vec::new(),
        span,
    })
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

/// The type an effect is for.
pub(crate) fn host_of(class: &Class) -> Option<&Reference> {
    match &class.body {
        ClassBody::Long { host, .. } => host.as_ref(),
        ClassBody::Short { .. } => None,
    }
}

pub(super) fn is_parameter(item: &Collected<'_>) -> bool {
    matches!(item.element, Element::Declaration(declaration) if declaration.prefixes.iter().any(|prefix| {
        matches!(prefix, Prefix::Parameter | Prefix::Constant | Prefix::Size | Prefix::Shape)
    }))
}

/// A site as written, subscripts included: `joint[2].flange`.
pub(crate) fn written(site: &Reference) -> String {
    hyde_syntax::format_reference(site)
}

/// Whether an instance is of the type that an effect is for, or of one that extends it.
pub(super) fn fits_on<'a>(
    names: Names<'a>,
    host: &Instance<'a>,
    (file, effect): (FileIndex, &'a Class),
) -> bool {
    let wanted = host_of(effect).and_then(|host| names.class(file, host));
    wanted.is_some_and(|(_, wanted)| names.is_a((host.file, host.class), wanted))
}
