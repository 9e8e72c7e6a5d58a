//! Collects the elements of a class and its bases, with the modifications on the way.

use super::hook::hook;
use super::modification::{Modifier, modifiers_of};
use crate::instance::InstanceId;
use crate::model::Model;
use crate::names::FileIndex;
use crate::refusals::instantiate as refused;
use hyde_syntax::ast::{Change, Class, ClassBody, Element, Prefix, Reference};

/// Elements of a class and its bases, each with the modifications of the `extends` clauses on the way.
pub(super) struct Collected<'a> {
    pub(super) element: &'a Element,
    pub(super) file: FileIndex,
    pub(super) modifiers: Vec<Modifier<'a>>,
}

impl Collected<'_> {
    /// Whether it declares parameters.
    pub(super) fn is_parameter(&self) -> bool {
        matches!(self.element, Element::Declaration(declaration) if declaration.prefixes.iter().any(|prefix| {
            matches!(prefix, Prefix::Parameter | Prefix::Constant | Prefix::Size | Prefix::Shape)
        }))
    }
}

/// How far a walk over a class and its bases has come: the modifications that the `extends` clauses on the way made.
#[derive(Clone)]
pub(super) struct Walk<'a> {
    pub(super) id: InstanceId,
    pub(super) file: FileIndex,
    pub(super) modifiers: Vec<Modifier<'a>>,
    /// The classes that are extended on the way, the one asked for first.
    pub(super) chain: Vec<&'a Class>,
}

/// Classes that extend each other in a chain at most, and all that a class extends by whatever way.
const MAX_BASES: usize = 200;
const MAX_EXTENDED: usize = 2000;

/// The elements of a class, those of its bases first.
pub(super) fn collect<'a>(
    model: &mut Model<'a, '_>,
    walk: Walk<'a>,
    class: &'a Class,
    out: &mut Vec<Collected<'a>>,
) {
    if let Some(own) = walk
        .chain
        .iter()
        .position(|&known| std::ptr::eq(known, class))
    {
        let names: Vec<String> = walk.chain[own..]
            .iter()
            .chain([&class])
            .map(|class| format!("`{}`", class.name.text))
            .collect();
        model.report(refused::extends_itself(&class.name, &names));
        return;
    }
    model.making.extended += 1;
    if walk.chain.len() > MAX_BASES || model.making.extended > MAX_EXTENDED {
        // Told once: what is beyond it is left out.
        if model.making.extended <= MAX_EXTENDED + 1 {
            model.making.extended = MAX_EXTENDED + 1;
            let name = &model.tree[walk.id].class.name;
            let limits = (MAX_BASES, MAX_EXTENDED);
            let diagnostic = refused::extends_too_much(name, limits);
            model.report(diagnostic);
        }
        return;
    }
    match &class.body {
        ClassBody::Short {
            base,
            changes,
            effects,
            fmu: _,
        } => {
            hook(model, walk.id, walk.file, effects);
            collect_base(model, walk, class, base, changes, out);
        }
        ClassBody::Long { elements, .. } => {
            for element in elements {
                if let Element::Extends(base, changes) = element {
                    collect_base(model, walk.clone(), class, base, changes, out);
                } else {
                    out.push(Collected {
                        element,
                        file: walk.file,
                        modifiers: walk.modifiers.clone(),
                    });
                }
            }
        }
    }
}

fn collect_base<'a>(
    model: &mut Model<'a, '_>,
    mut walk: Walk<'a>,
    around: &'a Class,
    base: &'a Reference,
    changes: &'a [Change],
    out: &mut Vec<Collected<'a>>,
) {
    modifiers_of(model, changes, walk.id, &mut walk.modifiers);
    match model.names.class(walk.file, base) {
        Some((file, class)) => {
            walk.file = file;
            walk.chain.push(around);
            collect(model, walk, class, out);
        }
        None => {
            let diagnostic = model.names.unknown(walk.file, base);
            model.report(diagnostic);
        }
    }
}
