//! `integral(e, bar)`: the integral of an expression over a domain, in an account of the energy ledger.
//!
//! It is taken as the discretisation sees it, so that what is stored is what the equations exchange. A term with a flux
//! or a `pder` has one value a cell. Any other is a function f of nodal fields: finite volumes see it at the nodes, finite
//! elements through the mean of the consistent and the lumped mass matrix,
//!
//! ```text
//! fem: h*(f(left) + f(middle) + f(right))/3     fv: h*(f(left) + f(right))/2
//! ```
//!
//! which is exact for the square of a field that is linear in the cell, half of it by Simpson's rule and half lumped.

use crate::instance::{DomainId, FieldPlace, InstanceId, Scope, Typed};
use crate::model::Model;
use crate::refusals::fields as refused;
use hyde_diag::Span;
use hyde_ir::{Expr as Ir, ExprId, Id as _, Index, Range};
use hyde_syntax::ast::{Expr, ExprKind};

/// Both ends and the middle of a cell that counts along.
const LEFT: Index = Index {
    stride: 1,
    offset: -1,
};
const CELL: Index = Index::COUNTER;

impl<'a> Model<'a, '_> {
    /// The integral's share of each cell, with its dimension.
    pub(crate) fn integral(
        &mut self,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<(Range, Typed)> {
        let [integrand, over] = self.exactly("integral", args, span)?;
        let Some(domain) = self.domain_of(over, scope.instance) else {
            self.report(refused::integral_over_no_domain(over.span));
            return None;
        };
        let (_, h, length) = self.mesh(domain);
        let n = self.cells(domain);
        let mut terms = Vec::new();
        crate::ledger::terms_of(integrand, true, &mut terms);
        let mut total: Option<Typed> = None;
        for (term, positive) in terms {
            let value = self.in_cell(domain, term, scope);
            let zero = self.flat.exprs.constant(0.0);
            let (before, sum) = match total {
                None => (zero, value.clone()),
                Some(sum) => {
                    self.agree(&sum, &value, "`+` adds", scope.instance);
                    (sum.id, sum)
                }
            };
            let arena = &mut self.flat.exprs;
            let id = if positive {
                arena.plus(before, value.id)
            } else {
                arena.minus(before, value.id)
            };
            total = Some(Typed { id, ..sum });
        }
        let total = total?;
        let id = self.flat.exprs.times(h, total.id);
        let dim = total.dim.multiply(&length);
        let share = self.typed(id, dim, span);
        Some((Range { first: 1, last: n }, share))
    }

    /// The mean of a term in a cell.
    fn in_cell(&mut self, domain: DomainId, term: &'a Expr, scope: &Scope<'a>) -> Typed {
        let middle = self.value(term, &scope.at(FieldPlace::Cell(domain, CELL)));
        if term.calls("pder") || self.reads_flux(middle.id) {
            return middle;
        }
        let left = self.value(term, &scope.at(FieldPlace::Node(domain, LEFT)));
        let right = self.value(term, &scope.at(FieldPlace::Node(domain, CELL)));
        let averaged = self.domains[domain].averaged;
        let arena = &mut self.flat.exprs;
        let ends = arena.plus(left.id, right.id);
        let id = if averaged {
            let sum = arena.plus(ends, middle.id);
            let third = arena.constant(1.0 / 3.0);
            arena.times(third, sum)
        } else {
            let half = arena.constant(0.5);
            arena.times(half, ends)
        };
        Typed { id, ..middle }
    }

    fn reads_flux(&self, id: ExprId) -> bool {
        let is_flux = |expr: Ir| {
            let Ir::Var(var, _) = expr else { return false };
            let field = self.variables[var.index()].field;
            field.is_some_and(|field| field.flux)
        };
        self.flat.exprs.any(id, is_flux)
    }

    fn domain_of(&self, expr: &'a Expr, instance: InstanceId) -> Option<DomainId> {
        let ExprKind::Reference(name) = &expr.kind else {
            return None;
        };
        match self.tree[instance].members.get(name.as_word()?) {
            Some(crate::instance::Member::Domain(domain)) => Some(*domain),
            Some(_) | None => None,
        }
    }
}
