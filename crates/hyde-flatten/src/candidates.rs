//! [`Candidate`]s: every effect at every site of a model where it fits, for those who ask which of them is missing.
//!
//! Connectors that a model holds at one place for good (by `connect`, or by an equation such as `b.phi = a.phi`) are one
//! site: a force at any of them is a force at all. Its path is that of the connector whose component has the state, as
//! `motor.shaft`; the others are its aliases (E4).

mod candidate;

pub use candidate::{Candidate, Knob};

use crate::instance::{InstanceId, Member, VariableNotes};
use crate::instantiate::{InstanceTree, Offer, host_of};
use crate::model::Model;
use hyde_ir::{Expr as Ir, ExprId, FlatModel, Id as _, Index, Range, Role, VarId};
use hyde_syntax::ast::{ClassKind, Element, Reference};
use std::collections::{BTreeMap, BTreeSet};

/// The list of what was offered, each site once.
pub(crate) fn candidates(model: &mut Model<'_, '_>) -> Vec<Candidate> {
    let mut offers = std::mem::take(&mut model.making.offers);
    if offers.is_empty() {
        return Vec::new();
    }
    let sites = sites(&model.tree, &model.flat, &model.variables);
    // Hosts in the order in which they are made: a component before its parts.
    offers.sort_by_key(|offer| offer.host);
    let mut found = Vec::new();
    for offer in &offers {
        let aliases = match sites.get(&offer.host) {
            None => Vec::new(),
            Some(site) if site.first() == Some(&offer.host) => site[1..]
                .iter()
                .map(|&id| model.tree.path(id).as_str().to_owned())
                .collect(),
            Some(_) => continue,
        };
        found.push(candidate(model, offer, aliases));
    }
    // In the order in which the effects are written.
    let order: Vec<String> = model
        .names
        .effects()
        .into_iter()
        .map(|(_, package, class)| full_name(package.as_deref(), &class.name.text))
        .collect();
    found.sort_by_key(|candidate| order.iter().position(|name| *name == candidate.effect));
    found
}

fn candidate(model: &mut Model<'_, '_>, offer: &Offer<'_>, aliases: Vec<String>) -> Candidate {
    let instance = &model.tree[offer.effect];
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
        let (_, tree) = model.input.files.get(file)?;
        let (path, _) = tree.package.as_ref()?;
        Some(path.dotted())
    };
    let host = host_of(class);
    let host_file = host.and_then(|host| model.names.class(file, host));
    let host_package = host_file.and_then(|(file, _)| package_of(file));
    let package = package_of(file);
    Candidate {
        effect: full_name(offer.package.as_deref(), &class.name.text),
        package: package.unwrap_or_default(),
        host: host.map_or_else(String::new, Reference::dotted),
        host_package: host_package.unwrap_or_default(),
        doc: class.doc.clone().unwrap_or_default(),
        site: model.tree.path(offer.host).as_str().to_owned(),
        aliases,
        instance: offer.name.clone(),
        sizes: knobs(model, offer, Role::Size),
        shapes: knobs(model, offer, Role::Shape),
        signature,
        confounds,
        replaces,
    }
}

/// The sizes or the shapes of an effect, in the order written.
fn knobs(model: &mut Model<'_, '_>, offer: &Offer<'_>, role: Role) -> Vec<Knob> {
    let mut found = Vec::new();
    for element in &offer.elements {
        let Element::Declaration(declaration) = element else {
            continue;
        };
        for declarator in &declaration.declarators {
            let name = declarator.name.text.as_str();
            let Some(Member::Parameter(param)) =
                model.tree[offer.effect].members.get(name).cloned()
            else {
                continue;
            };
            if model.flat.parameters[param].role != role {
                continue;
            }
            let leaf = model.flat.exprs.add(Ir::Param(param, Index::SCALAR));
            let value = model.evaluate(leaf).unwrap_or(0.0);
            let parameter = &model.flat.parameters[param];
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
pub(crate) fn sites(
    tree: &InstanceTree<'_>,
    flat: &FlatModel,
    notes: &[VariableNotes<'_>],
) -> BTreeMap<InstanceId, Vec<InstanceId>> {
    let equal = equal_variables(flat);
    let states = states(flat);
    let mut together: BTreeMap<Vec<Place>, Vec<InstanceId>> = BTreeMap::new();
    for id in tree.ids() {
        if tree[id].class.kind == ClassKind::Connector && !tree.is_of_effect(id) {
            let key = potentials(tree, flat, id).map(|var| equal.of((var, 0)));
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
                tree[id].parent == Some(notes[state.0.index()].instance)
                    && flat.variables[state.0].len.is_some() == array
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
fn potentials<'t>(
    tree: &'t InstanceTree<'_>,
    flat: &'t FlatModel,
    connector: InstanceId,
) -> impl Iterator<Item = VarId> + 't {
    let members = tree[connector].members.values();
    let own = members.filter_map(|member| match member {
        Member::Variable(var) => Some(*var),
        Member::Parameter(_) | Member::Instance(_) | Member::Instances(_) | Member::Domain(_) => {
            None
        }
    });
    own.filter(|&var| !flat.variables[var].flow)
}

/// The variables that some equation has the derivative of.
fn states(flat: &FlatModel) -> BTreeSet<Place> {
    let ids = (0..flat.exprs.len()).map(ExprId::from_index);
    let exprs = ids.map(|id| flat.exprs[id]);
    let mut found = BTreeSet::new();
    for expr in exprs {
        if let Ir::Der(var, index) = expr {
            let size = flat.variables[var].size();
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
fn equal_variables(flat: &FlatModel) -> Equal {
    let mut equal = Equal::default();
    for equation in &flat.equations {
        if let (Ir::Var(a, i), Ir::Var(b, j)) = (flat.exprs[equation.lhs], flat.exprs[equation.rhs])
            && equation.range == Range::SCALAR
            && i.stride == 0
            && j.stride == 0
        {
            equal.join((a, i.offset), (b, j.offset));
        }
    }
    equal
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
