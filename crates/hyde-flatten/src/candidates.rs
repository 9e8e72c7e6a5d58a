//! [`Candidate`]: every effect at every site of a model where it fits, for those who ask which of them is missing.
//!
//! Connectors that a model holds at one place for good (by `connect`, or by an equation such as `b.phi = a.phi`) are one
//! site: a force at any of them is a force at all. Its path is that of the connector whose component has the state, as
//! `motor.shaft`; the others are its aliases (E4).

use crate::instance::{InstanceId, Member};
use crate::instantiate::{Offer, host_of};
use crate::model::Model;
use hyde_ir::{Expr as Ir, ExprId, Id as _, Index, Quantity, Range, Role, VarId};
use hyde_syntax::ast::{ClassKind, Element, Reference};
use std::collections::{BTreeMap, BTreeSet};

/// An effect at a site of a model where it fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// What is written after `with`: `Effects.Stribeck`; effects of the user's file by their name alone.
    pub effect: String,
    /// The package it is in.
    pub package: String,
    /// The type that it is for, as it is written there.
    pub host: String,
    /// The package of that type.
    pub host_package: String,
    /// What it is.
    pub doc: String,
    /// Path of the instance that it is put on.
    pub site: String,
    /// Other connectors that are the same site.
    pub aliases: Vec<String>,
    /// What its instance is called at the site: `Stribeck`, or `Stribeck2` where the model has one there already.
    pub instance: String,
    /// Where all of them are 0 it vanishes.
    pub sizes: Vec<Knob>,
    /// What says how it looks.
    pub shapes: Vec<Knob>,
    /// The marks it leaves, with the name of the shape that goes with each: `angle` of `N`.
    pub signature: Vec<(String, Option<String>)>,
    /// The names of effects it is easily taken for.
    pub confounds: Vec<String>,
    /// Components of its host that it exchanges: two effects cannot exchange the same one.
    pub replaces: Vec<String>,
}

/// A size or a shape of a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// Its name in the effect.
    pub name: String,
    /// Its value as declared, SI.
    pub value: f64,
    /// The values it may have, SI.
    pub range: Option<(f64, f64)>,
    /// Its dimension and the unit it is declared in.
    pub quantity: Quantity,
    /// Whether it counts something.
    pub integer: bool,
    /// What it is.
    pub doc: String,
}

impl Candidate {
    /// The effect's own name, without the package: its id in reports.
    #[must_use]
    pub fn name(&self) -> &str {
        self.effect.rsplit('.').next().unwrap_or(&self.effect)
    }
}

impl Model<'_, '_> {
    /// The list of what was offered, each site once.
    pub(crate) fn candidates(&mut self) -> Vec<Candidate> {
        let mut offers = std::mem::take(&mut self.offers);
        if offers.is_empty() {
            return Vec::new();
        }
        let sites = self.sites();
        // Hosts in the order in which they are made: a component before its parts.
        offers.sort_by_key(|offer| offer.host);
        let mut found = Vec::new();
        for offer in &offers {
            let aliases = match sites.get(&offer.host) {
                None => Vec::new(),
                Some(site) if site.first() == Some(&offer.host) => site[1..]
                    .iter()
                    .map(|&id| self.path(id).as_str().to_owned())
                    .collect(),
                Some(_) => continue,
            };
            found.push(self.candidate(offer, aliases));
        }
        // In the order in which the effects are written.
        let order: Vec<String> = self
            .names
            .effects()
            .into_iter()
            .map(|(_, package, class)| full_name(package.as_deref(), &class.name.text))
            .collect();
        found.sort_by_key(|candidate| order.iter().position(|name| *name == candidate.effect));
        found
    }

    fn candidate(&mut self, offer: &Offer<'_>, aliases: Vec<String>) -> Candidate {
        let instance = &self.instances[offer.effect];
        let (class, file) = (instance.class, instance.file);
        let (mut signature, mut confounds, mut replaces) = (Vec::new(), Vec::new(), Vec::new());
        for element in &offer.elements {
            match element {
                Element::Signature(marks) => {
                    signature.extend(marks.iter().map(|(mark, arguments)| {
                        let argument = arguments.first();
                        let argument = argument.map(|a| hyde_syntax::format_expression(&a.value));
                        (mark.text.clone(), argument)
                    }));
                }
                Element::Confounds(names) => {
                    let last = |name: &Reference| name.parts.last().map(|p| p.name.text.clone());
                    confounds.extend(names.iter().filter_map(last));
                }
                Element::Replace(component, ..) => replaces.push(component.dotted()),
                Element::Extends(..)
                | Element::Declaration(_)
                | Element::Domain(_)
                | Element::Discretize(_)
                | Element::Modes(_)
                | Element::Clocked(_)
                | Element::Equation(_)
                | Element::InitialEquation(_)
                | Element::Wrap(..)
                | Element::Add(_)
                | Element::Measure(_)
                | Element::Account(..) => {}
            }
        }
        let package_of = |file: usize| {
            let (_, tree) = self.input.files.get(file)?;
            let (path, _) = tree.package.as_ref()?;
            Some(path.dotted())
        };
        let host = host_of(class);
        let host_file = host.and_then(|host| self.names.class(file, host));
        let host_package = host_file.and_then(|(file, _)| package_of(file));
        let package = package_of(file);
        Candidate {
            effect: full_name(offer.package.as_deref(), &class.name.text),
            package: package.unwrap_or_default(),
            host: host.map_or_else(String::new, Reference::dotted),
            host_package: host_package.unwrap_or_default(),
            doc: class.doc.clone().unwrap_or_default(),
            site: self.path(offer.host).as_str().to_owned(),
            aliases,
            instance: offer.name.clone(),
            sizes: self.knobs(offer, Role::Size),
            shapes: self.knobs(offer, Role::Shape),
            signature,
            confounds,
            replaces,
        }
    }

    /// The sizes or the shapes of an effect, in the order written.
    fn knobs(&mut self, offer: &Offer<'_>, role: Role) -> Vec<Knob> {
        let mut found = Vec::new();
        for element in &offer.elements {
            let Element::Declaration(declaration) = element else {
                continue;
            };
            for declarator in &declaration.declarators {
                let name = declarator.name.text.as_str();
                let Some(Member::Parameter(param)) =
                    self.instances[offer.effect].members.get(name).cloned()
                else {
                    continue;
                };
                if self.flat.parameters[param].role != role {
                    continue;
                }
                let leaf = self.flat.exprs.add(Ir::Param(param, Index::SCALAR));
                let value = self.evaluate(leaf).unwrap_or(0.0);
                let parameter = &self.flat.parameters[param];
                found.push(Knob {
                    name: name.to_owned(),
                    value,
                    range: parameter.range,
                    quantity: parameter.quantity.clone(),
                    integer: declaration.type_name.as_word() == Some("Integer"),
                    doc: declarator.doc.clone().unwrap_or_default(),
                });
            }
        }
        found
    }

    /// Every connector with all that are one site with it, the one that names the site first.
    pub(crate) fn sites(&self) -> BTreeMap<InstanceId, Vec<InstanceId>> {
        let equal = self.equal_variables();
        let states = self.states();
        let mut together: BTreeMap<Vec<Place>, Vec<InstanceId>> = BTreeMap::new();
        for id in 0..self.instances.len() {
            if self.instances[id].class.kind == ClassKind::Connector && !self.is_of_effect(id) {
                let key = self.potentials(id).map(|var| equal.of((var, 0)));
                together.entry(key.collect()).or_default().push(id);
            }
        }
        let mut found = BTreeMap::new();
        for (key, mut site) in together {
            if key.is_empty() {
                continue;
            }
            let has_state = |id: InstanceId, array: bool| {
                states.iter().any(|&state| {
                    self.instances[id].parent == Some(self.notes(state.0).instance)
                        && self.flat.variables[state.0].len.is_some() == array
                        && key.contains(&equal.of(state))
                })
            };
            // A body before the end of a field, and either before what only hangs on it.
            site.sort_by_key(|&id| (!has_state(id, false), !has_state(id, true), id));
            for &id in &site {
                found.insert(id, site.clone());
            }
        }
        found
    }

    /// The variables of a connector that do not flow.
    fn potentials(&self, connector: InstanceId) -> impl Iterator<Item = VarId> + '_ {
        let members = self.instances[connector].members.values();
        let own = members.filter_map(|member| match member {
            Member::Variable(var) => Some(*var),
            Member::Parameter(_)
            | Member::Instance(_)
            | Member::Instances(_)
            | Member::Domain(_) => None,
        });
        own.filter(|&var| !self.flat.variables[var].flow)
    }

    /// The variables that some equation has the derivative of.
    fn states(&self) -> BTreeSet<Place> {
        let ids = (0..self.flat.exprs.len()).map(ExprId::from_index);
        let exprs = ids.map(|id| self.flat.exprs[id]);
        let mut found = BTreeSet::new();
        for expr in exprs {
            if let Ir::Der(var, index) = expr {
                let size = self.flat.variables[var].size();
                let all = 0..i32::try_from(size).unwrap_or(1);
                match index.stride {
                    0 => found.extend([(var, index.offset)]),
                    _ => found.extend(all.map(|offset| (var, offset))),
                }
            }
        }
        found
    }

    /// What equations of the form `x = y` make one.
    fn equal_variables(&self) -> Equal {
        let mut equal = Equal::default();
        for equation in &self.flat.equations {
            if let (Ir::Var(a, i), Ir::Var(b, j)) =
                (self.flat.exprs[equation.lhs], self.flat.exprs[equation.rhs])
                && equation.range == Range::SCALAR
                && i.stride == 0
                && j.stride == 0
            {
                equal.join((a, i.offset), (b, j.offset));
            }
        }
        equal
    }
}

/// An element of a variable, from 0.
type Place = (VarId, i32);

/// Sets of equal variables: each points towards the first of its set.
#[derive(Default)]
struct Equal(BTreeMap<Place, Place>);

impl Equal {
    fn of(&self, mut place: Place) -> Place {
        while let Some(&next) = self.0.get(&place) {
            place = next;
        }
        place
    }

    fn join(&mut self, a: Place, b: Place) {
        let (a, b) = (self.of(a), self.of(b));
        if a != b {
            self.0.insert(a.max(b), a.min(b));
        }
    }
}

fn full_name(package: Option<&str>, name: &str) -> String {
    package.map_or_else(|| name.to_owned(), |package| format!("{package}.{name}"))
}
