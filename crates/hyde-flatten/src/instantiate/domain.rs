//! Domains with their meshes, and the domain of a field.

use crate::dimension::Dim;
use crate::instance::{Domain, DomainId, Field, InstanceId, Member, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::instantiate as refused;
use hyde_diag::Span;
use hyde_syntax::ast::{self, Declarator};
use hyde_units::Dimension;

/// Cells of a domain at most.
const MAX_CELLS: usize = 10_000_000;

pub(super) fn declare_domain<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    domain: &'a ast::Domain,
    method: Option<&'a ast::Discretize>,
    elements: &[&'a ast::Element],
) {
    let name = domain.name.text.as_str();
    let span = domain.name.span;
    let Some(method) = method else {
        model.report(refused::not_discretised(&domain.name));
        model.undeclared.insert(name);
        return;
    };
    let averaged = match method.method.text.as_str() {
        "fem" => true,
        "fv" => false,
        _ => {
            model.report(refused::unknown_discretisation(&method.method));
            model.undeclared.insert(name);
            return;
        }
    };
    let Some((count, span_of_count)) =
        number_of_cells(model, id, domain, method, averaged, elements)
    else {
        model.undeclared.insert(name);
        return;
    };
    let Some(cells) = usize::try_from(count)
        .ok()
        .filter(|&n| (2..=MAX_CELLS).contains(&n))
    else {
        model.report(refused::bad_number_of_cells(
            name,
            (count, span_of_count),
            MAX_CELLS,
        ));
        model.undeclared.insert(name);
        return;
    };
    let domain = Domain {
        instance: id,
        name,
        coordinate: &domain.coordinate.text,
        from: &domain.range.from,
        to: &domain.range.to,
        cells,
        averaged,
        span,
        mesh: None,
        weights: Vec::new(),
    };
    model.domains.push(domain);
    model
        .tree
        .name(id, name, Member::Domain(model.domains.len() - 1));
}

/// The number of cells that a discretisation has, with what says so: `n`, or what waves up to `f_max` need, whichever is
/// more; without both what those need that the experiment asks for.
fn number_of_cells<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    domain: &'a ast::Domain,
    method: &'a ast::Discretize,
    averaged: bool,
    elements: &[&'a ast::Element],
) -> Option<(i64, Span)> {
    let (mut n, mut f_max) = (None, None);
    for argument in &method.arguments {
        let name = argument.name.as_ref();
        match name.map(|name| name.text.as_str()) {
            Some("n") => n = Some(&argument.value),
            Some("f_max") => f_max = Some(&argument.value),
            Some(_) | None => {
                let span = name.map_or(argument.value.span, |name| name.span);
                model.report(refused::unknown_option_of_mesh(span));
                return None;
            }
        }
    }
    let given = match n {
        Some(n) => Some((model.structural_integer(id, n)?, n.span)),
        None => None,
    };
    let (f_max, span) = match (f_max, n) {
        (Some(expr), _) => {
            let scope = Scope::new(id, Setting::Parameter);
            let frequency = model.value(expr, &scope);
            let hertz = Typed {
                dim: Dim::known(Dimension::FREQUENCY),
                ..frequency.clone()
            };
            model.agree(&hertz, &frequency, "waves have a frequency, found", id);
            (model.structural_number(&scope, expr)?, expr.span)
        }
        (None, Some(_)) => return given,
        (None, None) => (model.highest_frequency(), method.method.span),
    };
    if let (true, Some(given)) = (f_max <= 0.0, given) {
        return Some(given);
    }
    let wanted = model.cells_for(id, domain, elements, averaged, (f_max, span))?;
    Some(match given {
        Some(given) if given.0 >= wanted => given,
        Some(_) | None => (wanted, span),
    })
}

/// The domain of that name in an instance; reported once if there is none.
pub(crate) fn domain_named<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    name: &'a ast::Name,
) -> Option<DomainId> {
    if let Some(Member::Domain(domain)) = model.tree[id].members.get(name.text.as_str()) {
        return Some(*domain);
    }
    if model.undeclared.insert(&name.text) {
        model.report(refused::no_domain(name));
    }
    None
}

/// The domain of a field and whether its values lie between the nodes: those of a flux, whose binding has `pder`.
pub(super) fn field<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    declarator: &'a Declarator,
) -> Option<Field> {
    let name = &declarator.name;
    let Some(domain) = &declarator.domain else {
        model.report(refused::field_without_domain(name));
        return None;
    };
    let domain = domain_named(model, id, domain)?;
    let flux = declarator
        .binding
        .as_ref()
        .is_some_and(|binding| binding.calls("pder"));
    Some(Field {
        domain,
        flux,
        traces: None,
    })
}
