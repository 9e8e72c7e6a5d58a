//! [`LawSite`]s: the sites of a model that declare of which variables a law of theirs is a function.
//!
//! ```text
//! flow Force f over (place = s, speed = der(s));                     a force on whatever moves
//! site Force grip = F over (place = a.s, slip = v, hold = hold);     a friction, with what holds it at rest
//! site Force F = c*e + d*v over (stretch = e, rate = v);             what is elastic
//! site Current i = i_ref over (demand = i_ref, rate = der(i));       what an amplifier is asked for
//! site Voltage V = K*w over (place = phi, speed = w, signal = i);    what goes with a current beside it as well
//! ```
//! Whoever asks what a model lacks puts laws there: `add a.f = -(law)` on the connector, `wrap grip by grip + law` on the
//! component. What is declared wrongly is reported for every class that the model has.

mod site;

pub use site::{LawSite, LawVariable};

use crate::candidates::sites;
use crate::input::Input;
use crate::instance::{InstanceId, Member};
use crate::instantiate::InstanceTree;
use crate::law_roles::{Refusal, Roles, roles, wrong};
use crate::model::Model;
use crate::names::{FileIndex, Names};
use crate::refusals::laws as refused;
use crate::site::declared_with;
use hyde_diag::Span;
use hyde_ir::{FlatModel, VarId};
use hyde_syntax::LawTarget;
use hyde_syntax::ast::{
    Class, ClassBody, ClassKind, Declaration, Declarator, Element, Expr, ExprKind, Prefix,
    Reference,
};
use hyde_units::{Agreement, Dimension};
use std::collections::BTreeSet;

/// What an effect may wrap.
const WRAPPED: [Prefix; 3] = [Prefix::Site, Prefix::Input, Prefix::Output];

/// A declaration of an instance.
type Declared<'a> = (FileIndex, &'a Declaration, &'a Declarator);

/// Finds the sites that a law may act on, and reports those that are declared wrongly, each declaration once.
pub(crate) fn find_law_sites(model: &mut Model<'_, '_>) {
    let mut wrong: BTreeSet<Span> = BTreeSet::new();
    for id in model.tree.ids() {
        for declared in with_over(&model.tree, id) {
            let (.., declarator) = declared;
            match law_site(model, id, declared) {
                Ok(site) => model.law_sites.push((id, site)),
                Err(Some(diagnostic)) if wrong.insert(declarator.name.span) => {
                    model.report(*diagnostic);
                }
                Err(_) => {}
            }
        }
    }
}

/// The sites of the model where a law may act, connectors that are one site once.
pub(crate) fn named_law_sites(model: &mut Model<'_, '_>) -> Vec<LawSite> {
    let found = std::mem::take(&mut model.law_sites);
    let sites = sites(&model.tree, &model.flat, &model.variables);
    let named = found.into_iter().filter_map(|(id, site)| {
        if model.tree.is_of_effect(id) || model.clock_of(id).is_some() {
            return None;
        }
        let aliases = match sites.get(&id).map(Vec::as_slice) {
            None => Vec::new(),
            Some([first, others @ ..]) if *first == id => {
                let path = |&other: &InstanceId| model.tree.path(other).as_str().to_owned();
                others.iter().map(path).collect()
            }
            Some(_) => return None,
        };
        Some(LawSite { aliases, ..site })
    });
    named.collect()
}

fn with_over<'a>(tree: &InstanceTree<'a>, id: InstanceId) -> Vec<Declared<'a>> {
    let elements = tree[id].elements.iter();
    let of = |&(file, element): &(FileIndex, &'a Element)| {
        let Element::Declaration(declaration) = element else {
            return Vec::new();
        };
        let own = declaration.declarators.iter();
        let own = own.filter(|declarator| !declarator.over.is_empty());
        own.map(|declarator| (file, declaration, declarator))
            .collect()
    };
    elements.flat_map(of).collect()
}

/// A site as declared.
fn law_site<'a>(
    model: &Model<'a, '_>,
    id: InstanceId,
    (file, declaration, declarator): Declared<'a>,
) -> Result<LawSite, Refusal> {
    let name = declarator.name.text.as_str();
    let instance = &model.tree[id];
    let connector = instance.class.kind == ClassKind::Connector;
    if !may_have_laws(declaration, connector) {
        return Err(wrong(match connector {
            true => refused::no_flow(&declarator.name),
            false => refused::no_site(&declarator.name, &declaration.type_name),
        }));
    }
    if instance.outer.is_some() && instance.class.kind != ClassKind::Effect {
        return Err(wrong(refused::clocked_site(&declarator.name)));
    }
    let Some(Member::Variable(var)) = instance.members.get(name) else {
        return Err(None);
    };
    if !is_one_number(&model.flat, *var) {
        return Err(wrong(refused::several_numbers(&declarator.name)));
    }
    let Roles {
        form,
        pair: [first, second],
        hold,
        signal,
    } = roles(declarator)?;
    let over = [
        law_variable(model, id, first)?,
        law_variable(model, id, second)?,
    ];
    rate_agrees(&over, second)?;
    let signal = signal.map(|value| law_variable(model, id, value));
    let signal = signal.transpose()?;
    let dimension = model.flat.variables[*var].quantity.dimension;
    let hold = match hold {
        Some(hold) => Some(held_site(
            &model.tree,
            &model.flat,
            id,
            name,
            hold,
            dimension,
        )?),
        None => None,
    };
    let target = match connector {
        true => LawTarget::Flow(name.to_owned()),
        false => LawTarget::Value {
            name: name.to_owned(),
            hold,
            output: declaration.prefixes.contains(&Prefix::Output),
        },
    };
    let class = declaring_class(model.names, (instance.file, instance.class), declaration);
    Ok(LawSite {
        path: model.tree.path(id).as_str().to_owned(),
        aliases: Vec::new(),
        host: full_name(model.input, file, class.ok_or(None)?),
        target,
        dimension,
        form,
        over,
        signal,
    })
}

fn is_one_number(flat: &FlatModel, var: VarId) -> bool {
    let variable = &flat.variables[var];
    variable.len.is_none() && !variable.boolean
}

/// A variable of the host, or the derivative of one.
fn law_variable(
    model: &Model<'_, '_>,
    id: InstanceId,
    value: &Expr,
) -> Result<LawVariable, Refusal> {
    let inside = if let ExprKind::Call(function, arguments) = &value.kind
        && let (Some("der"), [only]) = (function.as_word(), &arguments[..])
    {
        Some(&only.value)
    } else {
        None
    };
    let ExprKind::Reference(name) = &inside.unwrap_or(value).kind else {
        return Err(not_a_variable(value.span));
    };
    let var = variable_below(model, id, name)?;
    Ok(LawVariable {
        name: name.dotted(),
        derivative: inside.is_some(),
        quantity: model.flat.variables[var].quantity.clone(),
    })
}

/// The variable that a name means within an instance.
fn variable_below(
    model: &Model<'_, '_>,
    id: InstanceId,
    name: &Reference,
) -> Result<VarId, Refusal> {
    let mut at = id;
    for (number, part) in name.parts.iter().enumerate() {
        let word = part.name.text.as_str();
        if !part.subscripts.is_empty() {
            return Err(not_a_variable(name.span));
        }
        match model.tree[at].members.get(word) {
            Some(Member::Instance(inner)) => at = *inner,
            Some(Member::Variable(var))
                if number + 1 == name.parts.len() && is_one_number(&model.flat, *var) =>
            {
                return Ok(*var);
            }
            Some(_) => break,
            None if model.undeclared.contains(word) => return Err(None),
            None => {
                let members = model.tree[at].members.keys();
                let known: Vec<&str> = members.copied().collect();
                let class = &model.tree[at].class.name.text;
                return Err(wrong(refused::unknown_variable(&part.name, class, &known)));
            }
        }
    }
    Err(not_a_variable(name.span))
}

/// The second variable has the dimension of a rate of the first.
fn rate_agrees(over: &[LawVariable; 2], second: &Expr) -> Result<(), Refusal> {
    let [first_dimension, own] = over.each_ref().map(LawVariable::dimension);
    let wanted = first_dimension.divide(Dimension::TIME);
    if own.agreement(wanted) != Agreement::Different {
        return Ok(());
    }
    let [first, _] = over;
    let derivative = (!first.derivative).then_some(first.name.as_str());
    Err(wrong(refused::not_a_rate(
        &first.text(),
        (second.span, &own.usual_unit()),
        &wanted.usual_unit(),
        derivative,
    )))
}

/// The site that holds a friction at rest.
fn held_site(
    tree: &InstanceTree<'_>,
    flat: &FlatModel,
    id: InstanceId,
    site: &str,
    value: &Expr,
    dimension: Dimension,
) -> Result<String, Refusal> {
    let mut names = declared_with(tree, id, &WRAPPED);
    names.retain(|name| *name != site);
    let word = if let ExprKind::Reference(name) = &value.kind {
        name.as_word()
    } else {
        None
    };
    let Some(word) = word.filter(|word| names.contains(word)) else {
        return Err(wrong(refused::holds_no_site(value.span, &names)));
    };
    if let Some(Member::Variable(var)) = tree[id].members.get(word) {
        let own = flat.variables[*var].quantity.dimension;
        if own.agreement(dimension) == Agreement::Different {
            let (unit, wanted) = (own.usual_unit(), dimension.usual_unit());
            let hold = (value.span, unit.as_str());
            let refused = refused::holds_another_dimension(word, hold, &wanted);
            return Err(wrong(refused));
        }
    }
    Ok(word.to_owned())
}

/// The class, the given one or a base of it, in which a declaration stands.
fn declaring_class<'a>(
    names: Names<'a>,
    own: (FileIndex, &'a Class),
    declaration: &Declaration,
) -> Option<&'a Class> {
    let (mut waiting, mut seen) = (vec![own], Vec::<&'a Class>::new());
    while let Some((file, class)) = waiting.pop() {
        if seen.iter().any(|&known| std::ptr::eq(known, class)) {
            continue;
        }
        seen.push(class);
        if let ClassBody::Long { elements, .. } = &class.body
            && elements.iter().any(|element| {
                matches!(element, Element::Declaration(known) if std::ptr::eq(known, declaration))
            })
        {
            return Some(class);
        }
        waiting.extend(names.bases(file, class));
    }
    None
}

/// What the user's file may call a class of a file.
pub(crate) fn full_name(input: &Input<'_>, file: FileIndex, class: &Class) -> String {
    let tree = input.files.get(file).filter(|_| file > 0);
    let package = tree.and_then(|(_, tree)| tree.package.as_ref());
    match package {
        Some((package, _)) => format!("{}.{}", package.dotted(), class.name.text),
        None => class.name.text.clone(),
    }
}

/// Whether a law may be added to what is declared: what an effect may wrap, or what flows at a connector.
fn may_have_laws(declaration: &Declaration, connector: bool) -> bool {
    declaration.prefixes.iter().any(|prefix| match connector {
        true => *prefix == Prefix::Flow,
        false => WRAPPED.contains(prefix),
    })
}

fn not_a_variable(span: Span) -> Refusal {
    wrong(refused::not_a_variable(span))
}
