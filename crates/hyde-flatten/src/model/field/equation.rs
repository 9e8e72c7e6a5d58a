//! Equations of fields: bindings, boundary equations, and equations at every node with their loads.

use super::mesh::{collapsed, counted_index, pieces, shifted};
use super::point::Point;
use crate::instance::{DomainId, Field, FieldPlace, Scope, Typed};
use crate::instantiate::domain_named;
use crate::model::Model;
use crate::refusals::fields as refused;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::Equation;
use hyde_ir::{Expr as Ir, ExprId, Index, Range, VarId};
use hyde_syntax::ast::{Binary, Expr, ExprKind, Place, Unary};

impl<'a> Model<'a, '_> {
    /// The binding of a field, `field … on bar = e`.
    pub(crate) fn field_binding(
        &mut self,
        var: VarId,
        field: Field,
        value: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let n = self.cells(field.domain);
        let origin = self
            .tree
            .origin(scope.instance, span)
            .made_by(MadeBy::Discretization);
        let places = if field.flux {
            vec![Range { first: 1, last: n }]
        } else {
            pieces(n, &[])
        };
        let dim = self.dim(var);
        for range in places {
            let index = counted_index(range);
            let place = if field.flux {
                FieldPlace::Cell(field.domain, index)
            } else {
                FieldPlace::Node(field.domain, index)
            };
            let rhs = self.value(value, &scope.at(place));
            let element = if field.flux {
                shifted(index, -1)
            } else {
                index
            };
            let lhs = self.flat.exprs.add(Ir::Var(var, element));
            let left = self.typed(lhs, dim.clone(), span);
            self.agree(&left, &rhs, "the field and its value are", scope.instance);
            let (lhs, rhs) = (
                self.fix_counter(lhs, range),
                self.fix_counter(rhs.id, range),
            );
            self.flat.equations.push(Equation {
                range: collapsed(range),
                lhs,
                rhs,
                origin: origin.clone(),
            });
        }
    }

    /// `lhs = rhs indomain bar load(…)` or `… indomain bar.left`.
    pub(crate) fn field_equation(
        &mut self,
        lhs: &'a Expr,
        rhs: &'a Expr,
        place: &'a Place,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let name = place.domain.text.as_str();
        let Some(domain) = domain_named(self, scope.instance, &place.domain) else {
            return;
        };
        match place.end.as_ref().map(|end| (end.text.as_str(), end.span)) {
            None => self.interior(domain, lhs, rhs, place, scope, span),
            Some(("left", _)) => self.boundary(domain, 0, lhs, rhs, scope, span),
            Some(("right", _)) => self.boundary(domain, self.cells(domain), lhs, rhs, scope, span),
            Some((other, at)) => self.report(refused::no_end(name, (other, at))),
        }
    }

    /// A boundary equation: fields stand for their value or flux at the end.
    fn boundary(
        &mut self,
        domain: DomainId,
        node: i32,
        lhs: &'a Expr,
        rhs: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let scope = scope.at(FieldPlace::Node(domain, Index::fixed(node)));
        let (left, right) = (self.value(lhs, &scope), self.value(rhs, &scope));
        self.agree(&left, &right, "`=` equates", scope.instance);
        let range = Range {
            first: node,
            last: node,
        };
        let (lhs, rhs) = (
            self.fix_counter(left.id, range),
            self.fix_counter(right.id, range),
        );
        let origin = self.tree.origin(scope.instance, span);
        self.flat.equations.push(Equation {
            range: Range::SCALAR,
            lhs,
            rhs,
            origin,
        });
    }

    /// An equation at every node.
    fn interior(
        &mut self,
        domain: DomainId,
        lhs: &'a Expr,
        rhs: &'a Expr,
        place: &'a Place,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let n = self.cells(domain);
        let mut mass = Vec::new();
        let mut fluxes = Vec::new();
        split(lhs, true, &mut mass, &mut fluxes);
        split(rhs, false, &mut mass, &mut fluxes);
        let mut loads = Vec::new();
        for (at, force) in &place.loads {
            let Some(point) = self.point(domain, at, scope) else {
                continue;
            };
            let force = self.value(force, scope);
            loads.push((point, force));
        }
        let loaded: Vec<i32> = loads
            .iter()
            .flat_map(|(point, _)| point.single_nodes(n))
            .collect();
        let origin = self
            .tree
            .origin(scope.instance, span)
            .made_by(MadeBy::Discretization);
        let averaged = self.domains[domain].averaged && !fluxes.is_empty();
        for range in pieces(n, &loaded) {
            let index = counted_index(range);
            let at = |shift: i32| scope.at(FieldPlace::Node(domain, shifted(index, shift)));
            if range.first == range.last || range.first == 1 {
                // The dimensions of the whole equation, once.
                let (left, right) = (self.value(lhs, &at(0)), self.value(rhs, &at(0)));
                self.agree(&left, &right, "`=` equates", scope.instance);
                let side = Typed {
                    dim: crate::model::lower::sum_dim(&left.dim, &right.dim),
                    ..left
                };
                self.agree_loads(&side, &loads, domain, scope);
            }
            let left = if averaged {
                self.weighted(&mass, range, n, &at)
            } else {
                self.total(&mass, &at(0))
            };
            let mut right = self.total(&fluxes, &at(0));
            for (point, force) in &loads {
                right = self.with_load(right, point, force.id, index, n, domain);
            }
            let (lhs, rhs) = (
                self.fix_counter(left, range),
                self.fix_counter(right, range),
            );
            self.flat.equations.push(Equation {
                range: collapsed(range),
                lhs,
                rhs,
                origin: origin.clone(),
            });
        }
    }

    /// The mean of the consistent and the lumped mass matrix, applied to M.
    fn weighted(
        &mut self,
        mass: &[(&'a Expr, bool)],
        range: Range,
        n: i32,
        at: &dyn Fn(i32) -> Scope<'a>,
    ) -> ExprId {
        let ends: &[(i32, f64, f64)] = if range.first == 0 {
            &[(0, 5.0, 6.0), (1, 1.0, 6.0)]
        } else if range.first == n {
            &[(0, 5.0, 6.0), (-1, 1.0, 6.0)]
        } else {
            &[(-1, 1.0, 12.0), (0, 10.0, 12.0), (1, 1.0, 12.0)]
        };
        let mut sum = self.flat.exprs.constant(0.0);
        for &(shift, above, below) in ends {
            let value = self.total(mass, &at(shift));
            let weight = self.flat.exprs.constant(above / below);
            let term = self.flat.exprs.times(weight, value);
            sum = self.flat.exprs.plus(sum, term);
        }
        sum
    }

    /// The sum of terms with their signs.
    fn total(&mut self, terms: &[(&'a Expr, bool)], scope: &Scope<'a>) -> ExprId {
        let mut sum = self.flat.exprs.constant(0.0);
        for &(term, positive) in terms {
            let value = self.value(term, scope).id;
            sum = if positive {
                self.flat.exprs.plus(sum, value)
            } else {
                self.flat.exprs.minus(sum, value)
            };
        }
        sum
    }

    /// Adds the share of a point load at a node: its weight over the node's length.
    fn with_load(
        &mut self,
        sum: ExprId,
        point: &Point,
        force: ExprId,
        node: Index,
        n: i32,
        domain: DomainId,
    ) -> ExprId {
        let Some(weight) = self.weight(point, node, n) else {
            return sum;
        };
        let (_, h, _) = self.mesh(domain);
        let arena = &mut self.flat.exprs;
        let at_end = node.stride == 0 && (node.offset == 0 || node.offset == n);
        let half = arena.constant(0.5);
        let length = if at_end { arena.times(half, h) } else { h };
        let density = arena.over(force, length);
        let share = arena.times(weight, density);
        arena.plus(sum, share)
    }

    /// A load has the unit of the equation times the domain's length (U3).
    fn agree_loads(
        &mut self,
        side: &Typed,
        loads: &[(Point, Typed)],
        domain: DomainId,
        scope: &Scope<'a>,
    ) {
        let (_, _, length) = self.mesh(domain);
        for (_, force) in loads {
            let spread = Typed {
                dim: force.dim.divide(&length),
                ..force.clone()
            };
            self.agree(
                side,
                &spread,
                "the equation and the load per length are",
                scope.instance,
            );
        }
    }
}

/// Splits a side into terms, those with the derivative of a flux apart. `left` tells the sign in `M = fluxes`.
pub(super) fn split<'a>(
    expr: &'a Expr,
    left: bool,
    mass: &mut Vec<(&'a Expr, bool)>,
    fluxes: &mut Vec<(&'a Expr, bool)>,
) {
    match &expr.kind {
        ExprKind::Binary(Binary::Add, a, b) => {
            split(a, left, mass, fluxes);
            split(b, left, mass, fluxes);
        }
        ExprKind::Binary(Binary::Sub, a, b) => {
            split(a, left, mass, fluxes);
            split(b, !left, mass, fluxes);
        }
        ExprKind::Unary(Unary::Negative, inner) => split(inner, !left, mass, fluxes),
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => {
            if expr.calls("pder") {
                fluxes.push((expr, !left));
            } else {
                mass.push((expr, left));
            }
        }
    }
}
