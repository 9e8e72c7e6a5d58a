//! Effects on a model: `model A = B with Stribeck(dF = 150 [N]) on guide;` (E1 to E3).
//!
//! ```text
//! add a.tau = e;             the effect is a part with a connector `a` of its own, joined to its host's connection set
//! wrap grip by grip + e;     the equation  grip = g  becomes  grip = g + e
//! replace c by M(k = 1);     the host's replaceable component c becomes an M, its other modifications kept
//! ```
//! An effect is an instance inside its host, `guide.Stribeck`, that sees its host's names after its own. Everything else
//! of the model stays as it is. At exactly neutral sizes the effect is left out: only its parameters remain.

use crate::connect::Connection;
use crate::instance::{Instance, InstanceId, Member, Scope, Setting, Typed};
use crate::instantiate::{Collected, Modifier};
use crate::model::{Model, listed};
use crate::names::FileIndex;
use hyde_diag::{Code, Diagnostic, InstancePath, MadeBy};
use hyde_ir::{Expr as Ir, Id as _, Index, VarId};
use hyde_syntax::ast::{
    Change, Class, ClassBody, ClassKind, Element, EffectUse, Expr, Prefix, Reference,
};
use std::collections::HashMap;

/// An effect to be put on an instance once that is made.
pub(crate) struct Hook<'a> {
    host: InstancePath,
    site: &'a Reference,
    file: FileIndex,
    class: &'a Class,
    changes: &'a [Change],
    /// The model that uses the effect: its changes stand in its scope.
    scope: InstanceId,
    used: bool,
}

/// `wrap x by e;`
pub(crate) struct Wrap<'a> {
    host: InstanceId,
    site: &'a Reference,
    value: &'a Expr,
    effect: InstanceId,
    used: bool,
}

/// `replace c by M(…);`
pub(crate) struct Replacement<'a> {
    host: InstanceId,
    component: &'a Reference,
    class: (FileIndex, &'a Class),
    changes: &'a [Change],
    effect: InstanceId,
    used: bool,
}

impl<'a> Model<'a, '_> {
    /// Notes the effects of a model, to be put on their sites as those are made.
    pub(crate) fn hook(&mut self, id: InstanceId, file: FileIndex, effects: &'a [EffectUse]) {
        for used in effects {
            let found = self.names.class(file, &used.effect);
            let Some((file, class)) = found.filter(|(_, class)| class.kind == ClassKind::Effect)
            else {
                let diagnostic = match found {
                    Some((_, class)) => Diagnostic::error(
                        Code::WrongType,
                        format!("`{}` is no effect", class.name.text),
                    )
                    .label(used.effect.span, "only effects stand after `with`"),
                    None => self.names.unknown(file, &used.effect),
                };
                self.report(diagnostic);
                continue;
            };
            for site in &used.sites {
                self.hooks.push(Hook {
                    host: self.path(id).child(&written(site)),
                    site,
                    file,
                    class,
                    changes: &used.changes,
                    scope: id,
                    used: false,
                });
            }
        }
    }

    /// Makes the effects of an instance that was just made, before its own members.
    pub(crate) fn effects_of(&mut self, host: InstanceId) {
        for number in 0..self.hooks.len() {
            if self.hooks[number].host == self.instances[host].path && !self.hooks[number].used {
                self.hooks[number].used = true;
                self.effect(host, number);
            }
        }
    }

    fn effect(&mut self, host: InstanceId, number: usize) {
        let Hook {
            site,
            file,
            class,
            changes,
            scope,
            ..
        } = self.hooks[number];
        if !self.fits(host, file, class) {
            let own = self.instances[host].class;
            let wanted = host_of(class).map_or_else(String::new, Reference::dotted);
            self.report(
                Diagnostic::error(
                    Code::WrongType,
                    format!("`{}` does not fit on `{}`", class.name.text, written(site)),
                )
                .label(site.span, format!("this is a `{}`", own.name.text))
                .help(format!("`{}` is for a `{wanted}`", class.name.text)),
            );
            return;
        }
        let path = self.path(host);
        let id = self.instances.len();
        let name = class.name.text.as_str();
        self.instances.push(Instance {
            path: path.child(name),
            file,
            class,
            parent: Some(host),
            outer: Some(host),
            clock: self.instances[host].clock,
            members: std::collections::BTreeMap::new(),
            elements: Vec::new(),
            span: site.span,
        });
        if self.instances[host].members.insert(name, Member::Instance(id)).is_some() {
            self.report(
                Diagnostic::error(Code::Duplicate, format!("`{name}` is on `{}` twice", written(site)))
                    .label(site.span, "the second time")
                    .help("give the second another name: `effect Other on … extends …`"),
            );
        }
        let mut modifiers = Vec::new();
        self.modifiers_of(changes, scope, &mut modifiers);
        let mut collected = Vec::new();
        self.collect(id, file, class, modifiers, &mut collected, 0);
        let (parameters, rest): (Vec<_>, Vec<_>) = collected.into_iter().partition(is_parameter);
        self.members(id, &parameters);
        if self.is_neutral(id, &parameters) {
            self.instances[id].elements = Vec::new();
            self.flat.notes.push(format!("`{}` is neutral and left out", self.path(id)));
            return;
        }
        let connector = self.instances[host].class.kind == ClassKind::Connector;
        if connector {
            let (file, class) = (self.instances[host].file, self.instances[host].class);
            let own = self.instantiate(
                file,
                class,
                path.child(name).child("a"),
                Vec::new(),
                Some(id),
                None,
                site.span,
            );
            self.instances[id].members.insert("a", Member::Instance(own));
            let origin = self.origin(host, site.span).made_by(MadeBy::Connection);
            self.connections
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
                _ => {}
            }
        }
        let all: Vec<Collected<'a>> = parameters.into_iter().chain(rest).collect();
        let rest: Vec<Collected<'a>> = all.iter().filter(|item| !is_parameter(item)).cloned().collect();
        self.members(id, &rest);
        self.instances[id].elements = all.iter().map(|item| (item.file, item.element)).collect();
    }

    /// Whether an instance is of the type that an effect is for, or of one that extends it.
    fn fits(&self, host: InstanceId, file: FileIndex, effect: &'a Class) -> bool {
        let Some(wanted) = host_of(effect).and_then(|host| self.names.class(file, host)) else {
            return false;
        };
        let instance = &self.instances[host];
        self.is_a((instance.file, instance.class), wanted.1, 0)
    }

    /// Whether a class is another one or extends it.
    pub(crate) fn is_a(&self, own: (FileIndex, &'a Class), other: &'a Class, depth: usize) -> bool {
        let (file, class) = own;
        if std::ptr::eq(class, other) {
            return true;
        }
        let bases: Vec<&Reference> = match &class.body {
            ClassBody::Short { base, .. } => vec![base],
            ClassBody::Long { elements, .. } => elements
                .iter()
                .filter_map(|element| match element {
                    Element::Extends(base, _) => Some(base),
                    _ => None,
                })
                .collect(),
        };
        depth < 40
            && bases
                .into_iter()
                .filter_map(|base| self.names.class(file, base))
                .any(|base| self.is_a(base, other, depth + 1))
    }

    /// Whether every size of an effect is exactly zero. Sizes that are not stay plain parameters.
    fn is_neutral(&mut self, id: InstanceId, parameters: &[Collected<'a>]) -> bool {
        let before: Vec<bool> = self.flat.parameters.iter().map(|p| p.structural).collect();
        let mut sizes = 0;
        let mut neutral = true;
        for item in parameters {
            let Element::Declaration(declaration) = item.element else { continue };
            if !declaration.prefixes.contains(&Prefix::Size) {
                continue;
            }
            for declarator in &declaration.declarators {
                let name = declarator.name.text.as_str();
                let Some(Member::Parameter(param)) = self.instances[id].members.get(name) else {
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
    pub(crate) fn replaced(
        &mut self,
        host: InstanceId,
        component: &str,
        modifiers: &mut Vec<Modifier<'a>>,
    ) -> Option<(FileIndex, &'a Class)> {
        let number = self.replacements.iter().position(|replacement| {
            replacement.host == host && replacement.component.as_word() == Some(component)
        })?;
        self.replacements[number].used = true;
        let Replacement { class, changes, effect, .. } = self.replacements[number];
        let mut own = Vec::new();
        self.modifiers_of(changes, effect, &mut own);
        // The effect's own modifications come before those of the component it replaces.
        for (position, mut modifier) in own.into_iter().enumerate() {
            modifier.records = false;
            modifiers.insert(position, modifier);
        }
        Some(class)
    }

    /// A value with the effects that wrap its variable, in the order written.
    pub(crate) fn wrapped(&mut self, var: VarId, value: Typed, setting: Setting) -> Typed {
        let mut value = value;
        for number in self.wraps_of(var) {
            self.wraps[number].used = true;
            let Wrap { value: by, effect, .. } = self.wraps[number];
            let new = self.value(by, &Scope::new(effect, setting));
            let declared = self.typed(value.id, self.dim(var), value.span);
            self.agree(&declared, &new, "the site and what wraps it are", effect);
            let leaf = self.flat.exprs.var(var);
            let mut memo = HashMap::from([(leaf, value.id)]);
            value.id = self.flat.exprs.rewrite(new.id, &mut memo, |_, _, _| None);
        }
        value
    }

    fn wraps_of(&self, var: VarId) -> Vec<usize> {
        let instance = self.notes(var).instance;
        let name = crate::bind::short(&self.flat.variables[var].name);
        (0..self.wraps.len())
            .filter(|&number| {
                let wrap = &self.wraps[number];
                wrap.host == instance && wrap.site.as_word() == Some(name)
            })
            .collect()
    }

    /// Wraps the sites that an equation determines, and reports what no site was found for.
    pub(crate) fn finish_effects(&mut self) {
        for number in 0..self.wraps.len() {
            self.check_site(number);
            if !self.wraps[number].used {
                self.wrap_equation(number);
            }
        }
        let unused: Vec<(hyde_diag::Span, String)> = self
            .hooks
            .iter()
            .filter(|hook| !hook.used)
            .map(|hook| (hook.site.span, written(hook.site)))
            .collect();
        for (span, site) in unused {
            let known: Vec<&str> = self.instances[0].members.keys().copied().collect();
            let help = format!("components here: {}", listed(&known));
            self.report(
                Diagnostic::error(Code::UnknownName, format!("there is no `{site}` to put the effect on"))
                    .label(span, "no such component or connector")
                    .help(help),
            );
        }
        for number in 0..self.replacements.len() {
            let Replacement { host, component, used, .. } = self.replacements[number];
            if !used {
                let class = self.instances[host].class.name.text.clone();
                self.report(
                    Diagnostic::error(
                        Code::UnknownName,
                        format!("`{class}` has no component `{}` to replace", component.dotted()),
                    )
                    .label(component.span, "not found in the host"),
                );
            }
        }
    }

    /// Only what is declared a site, an input or an output may be wrapped (E1).
    fn check_site(&mut self, number: usize) {
        let Wrap { host, site, .. } = self.wraps[number];
        let declared = self.instances[host].elements.iter().find_map(|(_, element)| match element {
            Element::Declaration(declaration) => declaration
                .declarators
                .iter()
                .any(|declarator| site.as_word() == Some(declarator.name.text.as_str()))
                .then_some(declaration),
            _ => None,
        });
        let is_site = |prefix: &Prefix| {
            matches!(prefix, Prefix::Site | Prefix::Input | Prefix::Output)
        };
        if declared.is_some_and(|declaration| declaration.prefixes.iter().any(is_site)) {
            return;
        }
        let class = self.instances[host].class.name.text.clone();
        self.wraps[number].used = true;
        let diagnostic = Diagnostic::error(
            Code::UnknownName,
            format!("`{class}` has no site `{}`", site.dotted()),
        )
        .label(site.span, "only sites, inputs and outputs can be wrapped");
        self.report(match declared {
            Some(declaration) => diagnostic
                .label(declaration.span, "declared here, not as a site")
                .help("declare it `site`"),
            None => diagnostic,
        });
    }

    /// `x = e`, written as an equation of the host, becomes `x = e2` with e for x.
    fn wrap_equation(&mut self, number: usize) {
        let Wrap { host, site, .. } = self.wraps[number];
        let Some(Member::Variable(var)) = site
            .as_word()
            .and_then(|name| self.instances[host].members.get(name))
        else {
            return;
        };
        let var = *var;
        let leaf = self.flat.exprs.var(var);
        let plain = self.flat.equations.iter().position(|e| e.lhs == leaf);
        let clocked = self.flat.clocked_equations.iter().position(|e| e.equation.lhs == leaf);
        let (rhs, setting) = match (plain, clocked) {
            (Some(at), _) => (self.flat.equations[at].rhs, Setting::Equation),
            (None, Some(at)) => (self.flat.clocked_equations[at].equation.rhs, Setting::Clocked),
            (None, None) => {
                self.report(
                    Diagnostic::error(
                        Code::NotYet,
                        format!("no single equation `{} = …` defines this site", site.dotted()),
                    )
                    .label(site.span, "cannot be wrapped")
                    .help("give the site its value in one equation, its name on the left"),
                );
                return;
            }
        };
        let value = self.typed(rhs, self.dim(var), site.span);
        let new = self.wrapped(var, value, setting).id;
        match (plain, clocked) {
            (Some(at), _) => self.flat.equations[at].rhs = new,
            (None, Some(at)) => self.flat.clocked_equations[at].equation.rhs = new,
            (None, None) => {}
        }
    }
}

/// The type an effect is for.
pub(crate) fn host_of(class: &Class) -> Option<&Reference> {
    match &class.body {
        ClassBody::Long { host, .. } => host.as_ref(),
        ClassBody::Short { .. } => None,
    }
}

fn is_parameter(item: &Collected<'_>) -> bool {
    matches!(item.element, Element::Declaration(declaration) if declaration.prefixes.iter().any(|prefix| {
        matches!(prefix, Prefix::Parameter | Prefix::Constant | Prefix::Size | Prefix::Shape)
    }))
}

/// A site as written, subscripts included: `joint[2].flange`.
fn written(site: &Reference) -> String {
    hyde_syntax::format_reference(site)
}
