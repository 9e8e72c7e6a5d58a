//! `wrap x by e;` of an effect: the equation of a site with the effect round its value (E2).
//!
//! ```text
//! grip = F        with  wrap grip by grip + dF        is  grip = F + dF
//! ```

use crate::experiment::replayed;
use crate::instance::{InstanceId, Member, Scope, Setting, Typed};
use crate::instantiate::Wrap;
use crate::model::Model;
use crate::refusals::effects as refused;
use crate::site;
use hyde_ir::{Index, Memo, VarId};
use hyde_syntax::ast::{Element, Expr, ExprKind, Prefix, Reference};

/// A value with the effects that wrap its variable, in the order written.
pub(crate) fn wrapped(
    model: &mut Model<'_, '_>,
    var: VarId,
    value: Typed,
    setting: Setting,
) -> Typed {
    let mut value = replayed(model, var, value);
    for number in wraps_of(model, var) {
        model.wraps[number].used = true;
        let Wrap {
            value: by, effect, ..
        } = model.wraps[number];
        let mut scope = Scope::new(effect, setting);
        if has_a_past(by)
            && let Some(site) = model.wraps[number].site.as_word()
        {
            scope.locals.push((site, before(model, &value, &scope)));
        }
        let new = model.value(by, &scope);
        let declared = model.typed(value.id, model.dim(var), value.span);
        model.agree(&declared, &new, "the site and its wrapper are", effect);
        let leaf = model.flat.exprs.var(var);
        let mut memo = Memo::from_iter([(leaf, value.id)]);
        value.id = model.flat.exprs.rewrite(new.id, &mut memo, |_, _, _| None);
    }
    value
}

/// A variable for the value that a site has without the effect: a delay or a derivative is of a variable.
fn before(model: &mut Model<'_, '_>, value: &Typed, scope: &Scope<'_>) -> VarId {
    match model.flat.exprs[value.id].access() {
        Some((var, Index::SCALAR, false)) => var,
        Some(_) | None => model.named(value, scope),
    }
}

fn wraps_of(model: &Model<'_, '_>, var: VarId) -> Vec<usize> {
    let instance = model.notes(var).instance;
    let name = crate::words::short(&model.flat.variables[var].name);
    (0..model.wraps.len())
        .filter(|&number| {
            let wrap = &model.wraps[number];
            wrap.host == instance && wrap.site.as_word() == Some(name)
        })
        .collect()
}

/// Wraps the sites that an equation determines, joins connectors, and reports what found no site.
pub(crate) fn finish_effects(model: &mut Model<'_, '_>) {
    model.connections.append(&mut model.joined);
    for number in 0..model.wraps.len() {
        check_site(model, number);
        if !model.wraps[number].used {
            wrap_equation(model, number);
        }
    }
    let unused: Vec<(InstanceId, &Reference)> = model
        .making
        .hooks
        .iter()
        .filter(|hook| !hook.used)
        .map(|hook| (hook.scope, hook.site))
        .collect();
    for (scope, site) in unused {
        model.report(site::no_place(&model.tree, scope, site));
    }
    let unused: Vec<(InstanceId, &Reference)> = model
        .making
        .replacements
        .iter()
        .filter(|replacement| !replacement.used)
        .map(|replacement| (replacement.host, replacement.component))
        .collect();
    for (host, component) in unused {
        model.report(site::no_component(&model.tree, host, component));
    }
}

/// Only what is declared a site, an input or an output may be wrapped (E1).
fn check_site(model: &mut Model<'_, '_>, number: usize) {
    let Wrap { host, site, .. } = model.wraps[number];
    let declared = model.tree[host].elements.iter().find_map(|(_, element)| {
        let Element::Declaration(declaration) = element else {
            return None;
        };
        declaration
            .declarators
            .iter()
            .any(|declarator| site.as_word() == Some(declarator.name.text.as_str()))
            .then_some(declaration)
    });
    let is_site = |prefix: &Prefix| matches!(prefix, Prefix::Site | Prefix::Input | Prefix::Output);
    if declared.is_some_and(|declaration| declaration.prefixes.iter().any(is_site)) {
        return;
    }
    model.wraps[number].used = true;
    let declared = declared.map(|declaration| declaration.span);
    model.report(site::no_site(&model.tree, host, site, declared));
}

/// `x = e`, written as an equation of the host, becomes `x = e2` with e for x.
fn wrap_equation(model: &mut Model<'_, '_>, number: usize) {
    let Wrap { host, site, .. } = model.wraps[number];
    let Some(Member::Variable(var)) = site
        .as_word()
        .and_then(|name| model.tree[host].members.get(name))
    else {
        return;
    };
    let var = *var;
    let leaf = model.flat.exprs.var(var);
    let plain = model.flat.equations.iter().position(|e| e.lhs == leaf);
    let clocked = model
        .flat
        .clocked_equations
        .iter()
        .position(|e| e.equation.lhs == leaf);
    let (rhs, setting) = match (plain, clocked) {
        (Some(at), _) => (model.flat.equations[at].rhs, Setting::Equation),
        (None, Some(at)) => (
            model.flat.clocked_equations[at].equation.rhs,
            Setting::Clocked,
        ),
        (None, None) => {
            model.report(refused::no_equation_to_wrap(site));
            return;
        }
    };
    let value = model.typed(rhs, model.dim(var), site.span);
    let new = wrapped(model, var, value, setting).id;
    match (plain, clocked) {
        (Some(at), _) => model.flat.equations[at].rhs = new,
        (None, Some(at)) => model.flat.clocked_equations[at].equation.rhs = new,
        (None, None) => {}
    }
}

/// Whether an expression reads more than the value that things have now.
fn has_a_past(expr: &Expr) -> bool {
    let own = matches!(&expr.kind, ExprKind::Call(function, _) if matches!(function.as_word(), Some("delay" | "der")));
    own || expr.children().into_iter().any(has_a_past)
}
