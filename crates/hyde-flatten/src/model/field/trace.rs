//! End fluxes: the two more unknowns of a flux whose derivative is taken.

use super::equation::split;
use crate::instance::{DomainId, Scope};
use crate::model::Model;
use hyde_diag::{MadeBy, Span};
use hyde_ir::{Id as _, VariableKind};
use hyde_syntax::ast::{Expr, ExprKind, Place};

impl<'a> Model<'a, '_> {
    /// Makes the end fluxes that an equation on a domain needs.
    pub(crate) fn traces_of(
        &mut self,
        lhs: &'a Expr,
        rhs: &'a Expr,
        place: &'a Place,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let member = self.tree[scope.instance]
            .members
            .get(place.domain.text.as_str());
        let Some(crate::instance::Member::Domain(domain)) = member else {
            return;
        };
        let domain = *domain;
        let (mut mass, mut fluxes) = (Vec::new(), Vec::new());
        split(lhs, true, &mut mass, &mut fluxes);
        split(rhs, false, &mut mass, &mut fluxes);
        self.make_traces(domain, &fluxes, scope, span);
    }

    /// The end fluxes of every flux whose derivative is taken.
    fn make_traces(
        &mut self,
        domain: DomainId,
        fluxes: &[(&'a Expr, bool)],
        scope: &Scope<'a>,
        span: Span,
    ) {
        let mut found = Vec::new();
        for (term, _) in fluxes {
            arguments_of_pder(term, &mut found);
        }
        for argument in found {
            let Some((var, mut field)) = self.field_named(argument, scope) else {
                continue;
            };
            if !field.flux || field.domain != domain || field.traces.is_some() {
                continue;
            }
            let (name, origin) = (
                self.flat.variables[var].name.clone(),
                self.flat.variables[var].origin.clone(),
            );
            let bar = self.domains[domain].name;
            let mut end = |side: &str| {
                let trace = self.add_variable(
                    scope.instance,
                    format!("{name}.{side}"),
                    VariableKind::Continuous,
                    self.dim(var),
                    span,
                    MadeBy::Discretization,
                );
                self.flat.variables[trace].trace = Some(format!("{bar}.{side}"));
                self.flat.variables[trace].origin = origin.clone().made_by(MadeBy::Discretization);
                trace
            };
            field.traces = Some((end("left"), end("right")));
            self.variables[var.index()].field = Some(field);
        }
    }
}

fn arguments_of_pder<'a>(expr: &'a Expr, found: &mut Vec<&'a Expr>) {
    match &expr.kind {
        ExprKind::Call(name, arguments) => {
            if let (Some("pder"), Some(first)) = (name.as_word(), arguments.first()) {
                found.push(&first.value);
            } else {
                arguments
                    .iter()
                    .for_each(|argument| arguments_of_pder(&argument.value, found));
            }
        }
        ExprKind::Unary(_, inner) => arguments_of_pder(inner, found),
        ExprKind::Binary(_, a, b) => {
            arguments_of_pder(a, found);
            arguments_of_pder(b, found);
        }
        ExprKind::If(branches, otherwise) => {
            branches
                .iter()
                .for_each(|(_, value)| arguments_of_pder(value, found));
            arguments_of_pder(otherwise, found);
        }
        ExprKind::Array(items, _) => items.iter().for_each(|item| arguments_of_pder(item, found)),
        ExprKind::Comprehension(list) => arguments_of_pder(&list.value, found),
        ExprKind::Slice(..)
        | ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_) => {}
    }
}
