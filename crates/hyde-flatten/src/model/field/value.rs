//! The value of a field, of its coordinate and of its derivative where an expression is evaluated.

use super::mesh::shifted;
use crate::instance::{DomainId, Field, FieldPlace, Scope, Typed};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::fields as refused;
use hyde_diag::Span;
use hyde_ir::{Expr as Ir, ExprId, Index, VarId};
use hyde_syntax::ast::{Expr, ExprKind, Reference};

impl<'a> Model<'a, '_> {
    /// The value of a field where the expression is evaluated.
    pub(crate) fn field_value(
        &mut self,
        var: VarId,
        field: Field,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let (domain, index, cell) = match scope.place {
            FieldPlace::Node(domain, index) => (domain, index, false),
            FieldPlace::Cell(domain, index) => (domain, index, true),
            FieldPlace::Nowhere => {
                let name = self.flat.variables[var].name.clone();
                self.report(refused::needs_place(&name, span));
                return self.poison(span);
            }
        };
        if domain != field.domain {
            self.report(refused::of_another_domain(
                self.domains[field.domain].name,
                span,
            ));
            return self.poison(span);
        }
        let id = match (field.flux, cell) {
            (false, false) => self.flat.exprs.add(Ir::Var(var, index)),
            (true, true) => self.flat.exprs.add(Ir::Var(var, shifted(index, -1))),
            (false, true) => {
                let (left, right) = (self.node(var, index, -1), self.node(var, index, 0));
                let sum = self.flat.exprs.plus(left, right);
                let half = self.flat.exprs.constant(0.5);
                self.flat.exprs.times(half, sum)
            }
            (true, false) => match self.end_trace(field, index) {
                Some(trace) => self.flat.exprs.var(trace),
                None => {
                    let name = self.flat.variables[var].name.clone();
                    self.report(refused::flux_outside_pder(&name, span));
                    return self.poison(span);
                }
            },
        };
        let dim = self.dim(var);
        self.typed(id, dim, span)
    }

    /// The coordinate where a field expression is evaluated.
    pub(crate) fn coordinate_value(&mut self, scope: &Scope<'a>, span: Span) -> Typed {
        let (FieldPlace::Node(domain, index) | FieldPlace::Cell(domain, index)) = scope.place
        else {
            return self.poison(span);
        };
        let (from, h, dim) = self.mesh(domain);
        let arena = &mut self.flat.exprs;
        let counter = arena.add(Ir::Counter);
        let stride = arena.constant(f64::from(index.stride));
        let middle = if matches!(scope.place, FieldPlace::Cell(..)) {
            0.5
        } else {
            0.0
        };
        let offset = arena.constant(f64::from(index.offset) - middle);
        let counted = arena.times(stride, counter);
        let number = arena.plus(counted, offset);
        let along = arena.times(number, h);
        let id = arena.plus(from, along);
        self.typed(id, dim, span)
    }

    /// `pder(f, x)`: between nodes the slope of a nodal field.
    pub(crate) fn pder(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([f, by]) = self.exactly("pder", args, span) else {
            return self.poison(span);
        };
        let Some((var, field)) = self.field_named(f, scope) else {
            return self.poison(span);
        };
        let coordinate = self.domains[field.domain].coordinate;
        if !matches!(&by.kind, ExprKind::Reference(name) if name.as_word() == Some(coordinate)) {
            self.report(refused::wrong_coordinate(coordinate, by.span));
        }
        let (_, h, length) = self.mesh(field.domain);
        let dim = self.dim(var).divide(&length);
        let id = match (field.flux, scope.place) {
            (false, FieldPlace::Cell(domain, index)) if domain == field.domain => {
                let (left, right) = (self.node(var, index, -1), self.node(var, index, 0));
                let step = self.flat.exprs.minus(right, left);
                self.flat.exprs.over(step, h)
            }
            (true, FieldPlace::Node(domain, index)) if domain == field.domain => {
                self.flux_difference(var, field.domain, index, h)
            }
            (false, _) => {
                self.report(refused::slope_outside_flux(span));
                return self.poison(span);
            }
            (true, _) => {
                self.report(refused::derivative_outside_domain(span));
                return self.poison(span);
            }
        };
        self.typed(id, dim, span)
    }

    /// `th.at(x)`: a nodal field read at a place.
    pub(crate) fn field_at(
        &mut self,
        function: &'a Reference,
        at: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let name = Reference {
            parts: function.parts[..function.parts.len() - 1].to_vec(),
            span: function.span,
        };
        let Some((var, field)) = self.field_of_parts(&name, scope) else {
            return self.poison(span);
        };
        if field.flux {
            let name = self.flat.variables[var].name.clone();
            self.report(refused::flux_at_point(&name, span));
            return self.poison(span);
        }
        let Some(point) = self.point(field.domain, at, scope) else {
            return self.poison(span);
        };
        let n = self.cells(field.domain);
        let mut id = self.flat.exprs.constant(0.0);
        for node in point.nodes(n) {
            if let Some(weight) = self.weight(&point, Index::fixed(node), n) {
                let value = self.flat.exprs.add(Ir::Var(var, Index::fixed(node)));
                let share = self.flat.exprs.times(weight, value);
                id = self.flat.exprs.plus(id, share);
            }
        }
        let dim = self.dim(var);
        self.typed(id, dim, span)
    }

    /// `(q[k+1] - q[k])/h`, with the end fluxes and half cells at the ends.
    fn flux_difference(&mut self, var: VarId, domain: DomainId, index: Index, h: ExprId) -> ExprId {
        let n = self.cells(domain);
        let traces = self.notes(var).field.and_then(|field| field.traces);
        let (below, above) = match (index, traces) {
            (
                Index {
                    stride: 0,
                    offset: 0,
                },
                Some((left, _)),
            ) => (
                self.flat.exprs.var(left),
                self.flat.exprs.add(Ir::Var(var, Index::fixed(0))),
            ),
            (Index { stride: 0, offset }, Some((_, right))) if offset == n => (
                self.flat.exprs.add(Ir::Var(var, Index::fixed(n - 1))),
                self.flat.exprs.var(right),
            ),
            _ => (
                self.flat.exprs.add(Ir::Var(var, shifted(index, -1))),
                self.flat.exprs.add(Ir::Var(var, index)),
            ),
        };
        let arena = &mut self.flat.exprs;
        let step = arena.minus(above, below);
        let at_end = index.stride == 0 && (index.offset == 0 || index.offset == n);
        let half = arena.constant(0.5);
        let length = if at_end { arena.times(half, h) } else { h };
        arena.over(step, length)
    }

    /// The end flux, where a flux is read at an end node.
    fn end_trace(&self, field: Field, index: Index) -> Option<VarId> {
        let n = self.cells(field.domain);
        let (left, right) = field.traces?;
        match index {
            Index {
                stride: 0,
                offset: 0,
            } => Some(left),
            Index { stride: 0, offset } if offset == n => Some(right),
            _ => None,
        }
    }

    pub(super) fn field_named(
        &mut self,
        expr: &'a Expr,
        scope: &Scope<'a>,
    ) -> Option<(VarId, Field)> {
        let ExprKind::Reference(name) = &expr.kind else {
            self.report(refused::derivative_of_expression(expr.span));
            return None;
        };
        let resolved = self.resolve(name, scope)?;
        if let Resolved::Variable(var, None) = resolved
            && let Some(field) = self.notes(var).field
        {
            return Some((var, field));
        }
        self.report(refused::derivative_of_no_field(name, expr.span));
        None
    }

    /// A field by a name that was cut out of a longer one.
    fn field_of_parts(&mut self, name: &Reference, scope: &Scope<'a>) -> Option<(VarId, Field)> {
        let mut at = scope.instance;
        let mut found = None;
        for (position, part) in name.parts.iter().enumerate() {
            let word = part.name.text.as_str();
            let mut member = self.tree[at].members.get(word);
            while position == 0 && member.is_none() {
                let Some(outer) = self.tree[at].outer else {
                    break;
                };
                at = outer;
                member = self.tree[at].members.get(word);
            }
            match member {
                Some(crate::instance::Member::Instance(inner)) => at = *inner,
                Some(crate::instance::Member::Variable(var)) => found = Some(*var),
                _ => {
                    found = None;
                    break;
                }
            }
        }
        let field = found.and_then(|var| Some((var, self.notes(var).field?)));
        // A field whose domain is refused is reported there.
        let mut words = name.parts.iter().map(|part| part.name.text.as_str());
        if field.is_none() && !words.any(|word| self.undeclared.contains(word)) {
            self.report(refused::position_of_no_field(name));
        }
        field
    }

    pub(super) fn node(&mut self, var: VarId, index: Index, shift: i32) -> ExprId {
        self.flat.exprs.add(Ir::Var(var, shifted(index, shift)))
    }
}
