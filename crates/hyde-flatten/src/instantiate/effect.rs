//! Effects on a model: `model A = B with Stribeck(dF = 150 [N]) on guide;` (E1 to E3).
//!
//! ```text
//! add a.tau = e;             the effect is a part with a connector `a` of its own, joined to its host's connection set
//! wrap grip by grip + e;     the equation  grip = g  becomes  grip = g + e
//! replace c by M(k = 1);     the host's replaceable component c becomes an M, its other modifications kept
//! ```
//! An effect is an instance inside its host, `guide.Stribeck`, that sees its host's names after its own. Everything else
//! of the model stays as it is. At exactly neutral sizes the effect is left out: only its parameters remain.

use super::modification::Modifier;
use super::{Collected, Place, Walk};
use crate::connect::Connection;
use crate::instance::{Instance, InstanceId, Member};
use crate::model::Model;
use crate::names::FileIndex;
use crate::names::Names;
use crate::wrap::Wrap;
use hyde_diag::{Code, Diagnostic, InstancePath, MadeBy, Span};
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

impl<'a> Model<'a, '_> {
    /// Notes the effects of a model, to be put on their sites as those are made.
    pub(super) fn hook(&mut self, id: InstanceId, file: FileIndex, effects: &'a [EffectUse]) {
        for used in effects {
            let found = self.names.class(file, &used.effect);
            let Some((file, class)) = found.filter(|(_, class)| class.kind == ClassKind::Effect)
            else {
                let diagnostic = match found {
                    Some((_, class)) => Diagnostic::error(
                        Code::WrongType,
                        format!("`{}` is not an effect", class.name.text),
                    )
                    .label(used.effect.span, "only effects may follow `with`"),
                    None => self.names.unknown(file, &used.effect),
                };
                self.report(diagnostic);
                continue;
            };
            for site in &used.sites {
                self.hooks.push(Hook {
                    host: self.tree.path(id).child(&written(site)),
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
    pub(super) fn hook_additions(&mut self, root: InstanceId) {
        for addition in self.input.additions.list() {
            let Some((file, class)) = self.names.class(0, &addition.effect) else {
                let diagnostic = self.names.unknown(0, &addition.effect);
                self.report(diagnostic);
                continue;
            };
            self.hooks.push(Hook {
                host: InstancePath::root().child(&written(&addition.site)),
                site: &addition.site,
                file,
                class,
                changes: &[],
                scope: root,
                name: &addition.name,
                keep: self.input.additions.keeps_neutral(),
                used: false,
            });
        }
    }

    /// Makes the effects of an instance that was just made, before its own members. Its modifications may name them.
    pub(super) fn effects_of(&mut self, host: InstanceId, modifiers: &[Modifier<'a>]) {
        for number in 0..self.hooks.len() {
            if self.hooks[number].host == self.tree[host].path && !self.hooks[number].used {
                self.hooks[number].used = true;
                self.effect(host, number, modifiers);
            }
        }
    }

    fn effect(&mut self, host: InstanceId, number: usize, of_host: &[Modifier<'a>]) {
        let Hook {
            site,
            file,
            class,
            changes,
            scope,
            name,
            keep,
            ..
        } = self.hooks[number];
        if !fits_on(self.names, &self.tree[host], (file, class)) {
            let names = (&self.tree, self.names);
            let diagnostic = crate::site::does_not_fit(names, host, (file, class), site);
            self.report(diagnostic);
            return;
        }
        let path = self.tree.path(host);
        let id = self.instance_of_effect(host, (file, class), name, site.span);
        if self.tree.name(host, name, Member::Instance(id)).is_some() {
            self.report(
                Diagnostic::error(
                    Code::Duplicate,
                    format!("`{name}` is on `{}` twice", written(site)),
                )
                .label(site.span, "the second time")
                .help("give the second another name: `effect Other on … extends …`"),
            );
        }
        let mut modifiers = self.modifiers_for(name, of_host);
        self.modifiers_of(changes, scope, &mut modifiers);
        self.note_modified(id, &modifiers);
        let mut collected = Vec::new();
        let walk = Walk {
            id,
            file,
            modifiers,
            chain: Vec::new(),
        };
        self.collect(walk, class, &mut collected);
        let (parameters, rest): (Vec<_>, Vec<_>) = collected.into_iter().partition(is_parameter);
        self.members(id, &parameters);
        if !keep && self.is_neutral(id, &parameters) {
            self.tree.set_elements(id, Vec::new());
            self.flat.notes.push(format!(
                "`{}` has size 0 and is omitted",
                self.tree.path(id)
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
        let connector = self.tree[host].class.kind == ClassKind::Connector;
        if let (false, Some(span)) = (connector, added) {
            let diagnostic = crate::site::nothing_to_join(&self.tree[host], class, span);
            self.report(diagnostic);
            self.tree.set_elements(id, Vec::new());
            return;
        }
        if connector {
            let (file, class) = (self.tree[host].file, self.tree[host].class);
            let place = Place {
                path: path.child(name).child("a"),
                parent: Some(id),
                clock: None,
                span: site.span,
            };
            let own = self.instantiate(file, class, Vec::new(), place);
            self.tree.name(id, "a", Member::Instance(own));
            let origin = self
                .tree
                .origin(host, site.span)
                .made_by(MadeBy::Connection);
            self.joined
                .push(Connection::joining(vec![(host, true), (own, true)], origin));
        }
        for item in &rest {
            match item.element {
                Element::Wrap(site, value) => self.wraps.push(Wrap {
                    host,
                    site,
                    value,
                    effect: id,
                    used: false,
                }),
                Element::Replace(component, model, changes) => {
                    match self.names.class(item.file, model) {
                        Some(class) => self.replacements.push(Replacement {
                            host,
                            component,
                            class,
                            changes,
                            effect: id,
                            used: false,
                        }),
                        None => {
                            let diagnostic = self.names.unknown(item.file, model);
                            self.report(diagnostic);
                        }
                    }
                }
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
        self.members(id, &rest);
        let all = parameters.iter().chain(&rest);
        self.tree
            .set_elements(id, all.map(|item| (item.file, item.element)).collect());
    }

    /// An effect inside its host, without members yet.
    pub(super) fn instance_of_effect(
        &mut self,
        host: InstanceId,
        (file, class): (FileIndex, &'a Class),
        name: &str,
        span: Span,
    ) -> InstanceId {
        self.tree.push(Instance {
            path: self.tree.path(host).child(name),
            file,
            class,
            parent: Some(host),
            outer: Some(host),
            clock: self.clock_of(host),
            members: std::collections::BTreeMap::new(),
            elements: Vec::new(),
            span,
        })
    }

    /// Whether every size of an effect is exactly zero. Sizes that are not stay plain parameters.
    fn is_neutral(&mut self, id: InstanceId, parameters: &[Collected<'a>]) -> bool {
        let before: Vec<bool> = self.flat.parameters.iter().map(|p| p.structural).collect();
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
                let Some(Member::Parameter(param)) = self.tree[id].members.get(name) else {
                    continue;
                };
                let leaf = self.flat.exprs.add(Ir::Param(*param, Index::SCALAR));
                sizes += 1;
                neutral &= self.evaluate(leaf) == Some(0.0);
            }
        }
        let neutral = neutral && sizes > 0;
        if !neutral {
            for (parameter, was) in self.flat.parameters.iter_mut().zip(before) {
                parameter.structural = was;
            }
        }
        neutral
    }

    /// What an effect puts in the place of a component, with the modifications it brings.
    pub(super) fn replaced(
        &mut self,
        host: InstanceId,
        declaration: &Declaration,
        declarator: &Declarator,
        modifiers: &mut Vec<Modifier<'a>>,
    ) -> Option<(FileIndex, &'a Class)> {
        let name = declarator.name.text.as_str();
        let number = self.replacements.iter().position(|replacement| {
            replacement.host == host && replacement.component.as_word() == Some(name)
        })?;
        self.replacements[number].used = true;
        let Replacement {
            component,
            class,
            changes,
            effect,
            ..
        } = self.replacements[number];
        if !declaration.prefixes.contains(&Prefix::Replaceable) {
            self.report(
                Diagnostic::error(Code::FinalModified, format!("`{name}` is not replaceable"))
                    .label(component.span, "cannot be replaced")
                    .label(declarator.name.span, "declared here as not replaceable")
                    .help(format!(
                        "declare it `replaceable {} {name}`",
                        declaration.type_name.dotted()
                    )),
            );
            return None;
        }
        let mut own = Vec::new();
        self.modifiers_of(changes, effect, &mut own);
        // The effect's own modifications come before those of the component it replaces.
        modifiers.splice(0..0, own);
        Some(class)
    }
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
