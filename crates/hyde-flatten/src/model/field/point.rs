//! A place on a mesh, fixed or moving, and the weights with which it reads and loads the nodes (F4).
//!
//! A place of parameters lies in one cell for good and has the weights of the linear shape functions there. A place that
//! moves, a nut on its screw, has weights that change smoothly as it passes the nodes:
//!
//! ```text
//! th.at(xn)                th[0]*weight(xn, 0) + … + th[n]*weight(xn, n)
//! load(xn, F), node k      … + F*weight(xn, k)/h
//! ```
//!
//! Reading and loading share the weights, so the power that leaves one side of the pair arrives at the other. They are an
//! array variable of their own, computed once for each place, with a node beyond each end.

use super::kernel::kernel;
use crate::dimension::Dim;
use crate::instance::{DomainId, Scope, Setting, Typed, WeightArray};
use crate::model::Model;
use crate::refusals::fields as refused;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::{Assert, Equation};
use hyde_ir::{BinaryOp, Expr as Ir, ExprArena, ExprId, Index, Memo, Range, VarId, VariableKind};
use hyde_syntax::ast::{Expr, ExprKind};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// Fewer cells than this and the weights of a moving place would reach both ends at once.
const LEAST_CELLS: usize = 4;

/// A place on the mesh.
pub(super) enum Point {
    /// It is this node.
    AtNode(i32),
    /// It lies between this node and the next; the share of the cell left of it is made of parameters.
    InCell(i32, ExprId),
    /// It moves: the weights of the nodes, from the one before the first to the one behind the last.
    Moving(Weights),
}

/// The weights of the nodes at a place that moves.
pub(super) enum Weights {
    /// They are this array.
    Array(VarId),
    /// The place is another for each element of a loop: its distance from the first node in cells.
    Each(ExprId),
}

impl Point {
    /// The nodes whose equation differs from that of their neighbours because of this place.
    pub(super) fn single_nodes(&self, n: i32) -> Vec<i32> {
        match *self {
            Self::AtNode(node) => vec![node],
            Self::InCell(node, _) => vec![node, node + 1],
            Self::Moving(_) => vec![1, n - 1],
        }
    }

    /// The nodes that it reads.
    pub(super) fn nodes(&self, n: i32) -> RangeInclusive<i32> {
        match *self {
            Self::AtNode(node) => node..=node,
            Self::InCell(node, _) => node..=node + 1,
            Self::Moving(_) => 0..=n,
        }
    }
}

impl<'a> Model<'a, '_> {
    /// Where a place lies on the mesh. The cell of a place of parameters is structural, its share within it is not.
    pub(super) fn point(
        &mut self,
        domain: DomainId,
        at: &'a Expr,
        scope: &Scope<'a>,
    ) -> Option<Point> {
        let (from, h, dim) = self.mesh(domain);
        let mut place = self.value(at, scope);
        let moves = !self.flat.exprs.is_parametric(place.id);
        if !moves {
            place = self.value(at, &scope.with(Setting::Parameter));
        }
        let along = Typed {
            dim,
            ..place.clone()
        };
        self.agree(
            &place,
            &along,
            "the position and the coordinate are",
            scope.instance,
        );
        let distance = self.flat.exprs.minus(place.id, from);
        let number = self.flat.exprs.over(distance, h);
        if moves {
            self.moving(domain, number, at, scope)
        } else {
            self.fixed(domain, number, at)
        }
    }

    fn fixed(&mut self, domain: DomainId, number: ExprId, at: &'a Expr) -> Option<Point> {
        let value = self.evaluate(number)?;
        let cells = self.domains[domain].cells;
        let outside = !(-1e-9..=cells as f64 + 1e-9).contains(&value);
        if outside {
            self.report(refused::outside_domain(
                (value, cells),
                at.span,
                self.domains[domain].span,
            ));
            return None;
        }
        let nearest = value.round();
        if (value - nearest).abs() < 1e-9 {
            return Some(Point::AtNode(nearest as i32));
        }
        let first = self.flat.exprs.constant(value.floor());
        let share = self.flat.exprs.minus(number, first);
        Some(Point::InCell(value.floor() as i32, share))
    }

    /// A place that moves must stay on the domain: an assertion watches it.
    fn moving(
        &mut self,
        domain: DomainId,
        number: ExprId,
        at: &'a Expr,
        scope: &Scope<'a>,
    ) -> Option<Point> {
        let cells = self.domains[domain].cells;
        if cells < LEAST_CELLS {
            self.report(refused::too_few_cells(
                (cells, LEAST_CELLS),
                at.span,
                self.domains[domain].span,
            ));
            return None;
        }
        let arena = &mut self.flat.exprs;
        let (first, last) = (arena.constant(0.0), arena.constant(cells as f64));
        let behind = arena.binary(BinaryOp::Ge, number, first);
        let before = arena.binary(BinaryOp::Le, number, last);
        let condition = arena.binary(BinaryOp::And, behind, before);
        if !self
            .flat
            .asserts
            .iter()
            .any(|known| known.condition == condition)
        {
            let path = self.tree[scope.instance].path.clone();
            let place = if let ExprKind::Reference(name) = &at.kind {
                format!("`{}`", path.member(&name.dotted()))
            } else {
                "the place".to_owned()
            };
            let domain = path.member(self.domains[domain].name);
            let message = format!("{place} has left the domain `{domain}`");
            let origin = self.tree.origin(scope.instance, at.span);
            self.flat.asserts.push(Assert {
                condition,
                message,
                origin,
            });
        }
        let each = self.flat.exprs.any(number, |expr| expr == Ir::Counter);
        Some(Point::Moving(if each {
            Weights::Each(number)
        } else {
            Weights::Array(self.weights(domain, number, at.span))
        }))
    }

    /// The array of the weights at a place.
    fn weights(&mut self, domain: DomainId, place: ExprId, span: Span) -> VarId {
        let known = &self.domains[domain].weights;
        if let Some(known) = known.iter().find(|known| known.place == place) {
            return known.array;
        }
        let name = format!("weights{}", known.len() + 1);
        let array = self.array_of_nodes(domain, &name, span, |arena, node| {
            kernel(arena, place, node)
        });
        self.domains[domain].weights.push(WeightArray {
            place,
            array,
            slopes: None,
            span,
        });
        array
    }

    /// The derivative by a variable of each array of weights that is read below an expression: the array of the
    /// derivatives by the place, and that of the place.
    pub(crate) fn slopes_of_weights(
        &mut self,
        id: ExprId,
        by: impl Fn(&mut Self, ExprId) -> ExprId,
    ) -> BTreeMap<VarId, (VarId, ExprId)> {
        let mut found = BTreeMap::new();
        let read: BTreeSet<VarId> = (self.flat.exprs.below(&[id]).into_iter())
            .filter_map(|id| self.flat.exprs[id].access().map(|(var, ..)| var))
            .collect();
        for domain in 0..self.domains.len() {
            for number in 0..self.domains[domain].weights.len() {
                let weights = self.domains[domain].weights[number];
                if !read.contains(&weights.array) {
                    continue;
                }
                let of_place = by(self, weights.place);
                if self.flat.exprs.as_constant(of_place) == Some(0.0) {
                    continue;
                }
                let slopes = weights
                    .slopes
                    .unwrap_or_else(|| self.slopes(domain, number, weights));
                found.insert(weights.array, (slopes, of_place));
            }
        }
        found
    }

    /// The array of the derivatives of weights by their place.
    fn slopes(&mut self, domain: DomainId, number: usize, weights: WeightArray) -> VarId {
        let name = format!("slopes{}", number + 1);
        let slopes = self.array_of_nodes(domain, &name, weights.span, |arena, node| {
            // By the time in the place of the place, which then takes the place of the time.
            let time = arena.add(Ir::Time);
            let weight = kernel(arena, time, node);
            let slope = arena.tangent(weight, |arena, leaf| {
                (leaf == Ir::Time).then(|| arena.constant(1.0))
            });
            arena.rewrite(slope, &mut Memo::default(), |_, _, expr| {
                (expr == Ir::Time).then_some(weights.place)
            })
        });
        self.domains[domain].weights[number].slopes = Some(slopes);
        slopes
    }

    /// An array with an element for each node and one beyond each end, each given by its node's number.
    fn array_of_nodes(
        &mut self,
        domain: DomainId,
        name: &str,
        span: Span,
        value: impl FnOnce(&mut ExprArena, ExprId) -> ExprId,
    ) -> VarId {
        let (of, bar) = (self.domains[domain].instance, self.domains[domain].name);
        let name = self.tree[of].path.member(&format!("{bar}.{name}"));
        let kind = VariableKind::Continuous;
        let array = self.add_variable(of, name, kind, Dim::NUMBER, span, MadeBy::Expression);
        let nodes = self.cells(domain) + 3;
        self.flat.variables[array].len = usize::try_from(nodes).ok();
        self.flat.variables[array].first = -1;
        let arena = &mut self.flat.exprs;
        let whole = Index::COUNTER;
        let lhs = arena.add(Ir::Var(array, whole));
        let (counter, one) = (arena.add(Ir::Counter), arena.constant(1.0));
        let node = arena.minus(counter, one);
        let rhs = value(arena, node);
        let origin = self.tree.origin(of, span).made_by(MadeBy::Expression);
        self.flat.equations.push(Equation {
            range: Range {
                first: 0,
                last: nodes - 1,
            },
            lhs,
            rhs,
            origin,
        });
        array
    }

    /// The weight of a node in what is read or loaded at a place; `None` where it has none.
    ///
    /// `node` counts along where the equation does, between the nodes that [`Point::single_nodes`] and the ends are.
    pub(super) fn weight(&mut self, point: &Point, node: Index, n: i32) -> Option<ExprId> {
        let single = (node.stride == 0).then_some(node.offset);
        let arena = &mut self.flat.exprs;
        match *point {
            Point::AtNode(at) => (single == Some(at)).then(|| arena.constant(1.0)),
            Point::InCell(left, share) if single == Some(left) => {
                let one = arena.constant(1.0);
                Some(arena.minus(one, share))
            }
            Point::InCell(left, share) => (single == Some(left + 1)).then_some(share),
            Point::Moving(ref weights) => {
                let own = weights.at(arena, node);
                // The nodes beyond an end go on in a straight line: th[-1] = 2*th[0] - th[1].
                let (beyond, factor) = match single {
                    Some(0) => (-1, 2.0),
                    Some(1) => (-1, -1.0),
                    Some(at) if at == n - 1 => (n + 1, -1.0),
                    Some(at) if at == n => (n + 1, 2.0),
                    Some(_) | None => return Some(own),
                };
                let ghost = weights.at(arena, Index::fixed(beyond));
                let factor = arena.constant(factor);
                let share = arena.times(factor, ghost);
                Some(arena.plus(own, share))
            }
        }
    }
}

impl Weights {
    /// The weight of a node.
    fn at(&self, arena: &mut ExprArena, node: Index) -> ExprId {
        match *self {
            // The array begins with the node before the first.
            Self::Array(var) => arena.add(Ir::Var(
                var,
                Index {
                    offset: node.offset + 1,
                    ..node
                },
            )),
            Self::Each(number) => {
                let counter = arena.add(Ir::Counter);
                let stride = arena.constant(f64::from(node.stride));
                let offset = arena.constant(f64::from(node.offset));
                let counted = arena.times(stride, counter);
                let place = arena.plus(counted, offset);
                kernel(arena, number, place)
            }
        }
    }
}
