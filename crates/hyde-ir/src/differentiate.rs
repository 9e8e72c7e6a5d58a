//! Derivatives of expressions: each operation has its rule beside its meaning.
//!
//! [`ExprArena::tangent`] carries derivatives of the leaves up to the root (one direction, any leaves);
//! [`ExprArena::gradient`] carries the root's sensitivity down to every leaf (all leaves in one pass). Both visit a
//! shared node once. Truths, modes and counters are constant; quantisers count as the identity (S3).
//!
//! A function that ends upright, as a root at 0, has in the gradient the slope there that it has [`NEAR`] its end: its value
//! is exact, and Newton's method needs a slope that is finite. The tangent, which becomes part of equations, is exact.

use crate::expr::{Expr, ExprArena};
use crate::id::ExprId;
use crate::{BinaryOp, UnaryOp};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// How far from the end of its domain a function has the slope that stands for the infinite one at the end.
const NEAR: f64 = 1e-8;

/// The slope of a function where it ends upright.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ends {
    /// As it is.
    Exact,
    /// Finite.
    Finite,
}

/// What is known of the nodes of one gradient.
#[derive(Default)]
struct Branches {
    /// Whether a branch below is zero.
    zero: FxHashMap<ExprId, bool>,
    /// Whether an operation below may give infinity, or no number.
    infinite: FxHashMap<ExprId, bool>,
}

impl Branches {
    fn end_in_zero(&mut self, arena: &ExprArena, root: ExprId) -> bool {
        below(arena, root, &mut self.zero, |expr| {
            let zero = |id| arena.as_constant(id) == Some(0.0);
            matches!(expr, Expr::If(_, a, b) if zero(a) || zero(b))
        })
    }

    fn may_be_infinite(&mut self, arena: &ExprArena, root: ExprId) -> bool {
        below(arena, root, &mut self.infinite, |expr| {
            if let Expr::Binary(BinaryOp::Div, _, b) = expr {
                return !arena.is_parametric(b);
            }
            matches!(
                expr,
                Expr::Binary(BinaryOp::Pow, ..)
                    | Expr::Unary(
                        UnaryOp::Sqrt
                            | UnaryOp::Exp
                            | UnaryOp::Log
                            | UnaryOp::Log10
                            | UnaryOp::Tan
                            | UnaryOp::Asin
                            | UnaryOp::Acos
                            | UnaryOp::Sinh
                            | UnaryOp::Cosh,
                        _
                    )
            )
        })
    }
}

/// Whether a node below `root` is of a kind, with the answers for all nodes on the way remembered.
fn below(
    arena: &ExprArena,
    root: ExprId,
    known: &mut FxHashMap<ExprId, bool>,
    kind: impl Fn(Expr) -> bool,
) -> bool {
    for id in arena.below_new(root, |id| known.contains_key(&id)) {
        let mut is_found = kind(arena[id]);
        arena[id].for_each_child(|child| is_found |= known[&child]);
        known.insert(id, is_found);
    }
    known[&root]
}

/// The children of a node, in their order.
fn children(expr: Expr) -> impl Iterator<Item = ExprId> {
    let mut children = [None; 3];
    let mut places = children.iter_mut();
    expr.for_each_child(|child| {
        if let Some(place) = places.next() {
            *place = Some(child);
        }
    });
    children.into_iter().flatten()
}

impl ExprArena {
    /// The derivative of `root` where `leaf` gives the derivative of each leaf, `None` for zero.
    pub fn tangent(
        &mut self,
        root: ExprId,
        mut leaf: impl FnMut(&mut Self, Expr) -> Option<ExprId>,
    ) -> ExprId {
        let mut known: FxHashMap<ExprId, Option<ExprId>> = FxHashMap::default();
        for id in self.below(&[root]) {
            let expr = self[id];
            let derivative = if children(expr).next().is_none() {
                leaf(self, expr).filter(|&d| !self.is_constant(d, 0.0))
            } else if let Expr::If(c, a, b) = expr {
                match (known[&a], known[&b]) {
                    (None, None) => None,
                    (da, db) => {
                        let zero = self.constant(0.0);
                        Some(self.if_else(c, da.unwrap_or(zero), db.unwrap_or(zero)))
                    }
                }
            } else if let Expr::NoEvent(inner) = expr {
                // What makes no event has a derivative that makes none.
                known[&inner].map(|derivative| self.no_event(derivative))
            } else {
                let mut sum: Option<ExprId> = None;
                for (position, child) in children(expr).enumerate() {
                    let Some(dc) = known[&child] else { continue };
                    let Some(factor) = self.factor(id, position, Ends::Exact) else {
                        continue;
                    };
                    let term = self.times(factor, dc);
                    sum = Some(sum.map_or(term, |sum| self.plus(sum, term)));
                }
                sum
            };
            known.insert(id, derivative);
        }
        known[&root].unwrap_or_else(|| self.constant(0.0))
    }

    /// The derivative of `root` by each of its leaves that `wanted` picks, in the order of the leaves' ids.
    pub fn gradient(&mut self, root: ExprId, wanted: impl Fn(Expr) -> bool) -> Vec<(Expr, ExprId)> {
        let nodes = self.below(&[root]);
        let mut relevant: FxHashMap<ExprId, bool> = FxHashMap::default();
        for &id in &nodes {
            let mut depends = wanted(self[id]);
            self[id].for_each_child(|child| depends |= relevant[&child]);
            relevant.insert(id, depends);
        }
        let mut adjoints: BTreeMap<ExprId, ExprId> = BTreeMap::new();
        let one = self.constant(1.0);
        adjoints.insert(root, one);
        let mut found = Vec::new();
        let mut branches = Branches::default();
        for &id in nodes.iter().rev() {
            let Some(&adjoint) = adjoints.get(&id) else {
                continue;
            };
            let expr = self[id];
            if children(expr).next().is_none() {
                if wanted(expr) && !self.is_constant(adjoint, 0.0) {
                    found.push((expr, adjoint));
                }
                continue;
            }
            for (position, child) in children(expr).enumerate() {
                if !relevant[&child] {
                    continue;
                }
                let term = if let Expr::If(c, ..) = expr {
                    let zero = self.constant(0.0);
                    match position {
                        1 => self.if_else(c, adjoint, zero),
                        2 => self.if_else(c, zero, adjoint),
                        _ => continue,
                    }
                } else {
                    let Some(factor) = self.factor(id, position, Ends::Finite) else {
                        continue;
                    };
                    self.times_in_branch(adjoint, factor, &mut branches)
                };
                let sum = match adjoints.get(&child) {
                    Some(&old) => self.plus(old, term),
                    None => term,
                };
                adjoints.insert(child, sum);
            }
        }
        found.reverse();
        found
    }

    /// A product whose first factor may be the zero of a branch that is not taken: there the second one may be infinite, as
    /// the derivative of an exponential beyond the range it is for, and zero times infinity is no number.
    fn times_in_branch(
        &mut self,
        adjoint: ExprId,
        factor: ExprId,
        branches: &mut Branches,
    ) -> ExprId {
        if let Expr::If(c, a, b) = self[adjoint]
            && !self.is_parametric(factor)
        {
            if self.is_constant(b, 0.0) {
                let product = self.times_in_branch(a, factor, branches);
                return self.if_else(c, product, b);
            }
            if self.is_constant(a, 0.0) {
                let product = self.times_in_branch(b, factor, branches);
                return self.if_else(c, a, product);
            }
        }
        let product = self.times(adjoint, factor);
        if !branches.end_in_zero(self, adjoint) || !branches.may_be_infinite(self, factor) {
            return product;
        }
        // A sum over branches: the value is read in more than one of them.
        let zero = self.constant(0.0);
        let unread = self.binary(BinaryOp::Eq, adjoint, zero);
        let chosen = self.if_else(unread, zero, product);
        self.no_event(chosen)
    }

    /// The partial derivative of node `id` by its child at `position`; `None` for zero.
    fn factor(&mut self, id: ExprId, position: usize, ends: Ends) -> Option<ExprId> {
        match self[id] {
            Expr::Unary(op, a) => self.unary_factor(op, a, id, ends),
            Expr::NoEvent(_) => Some(self.constant(1.0)),
            Expr::Binary(op, a, b) => self.binary_factor(op, (a, b), id, position == 0, ends),
            Expr::Const(_)
            | Expr::Time
            | Expr::Counter
            | Expr::Param(..)
            | Expr::Var(..)
            | Expr::Der(..)
            | Expr::Pre(..)
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::If(..) => None,
        }
    }

    fn unary_factor(
        &mut self,
        op: UnaryOp,
        a: ExprId,
        value: ExprId,
        ends: Ends,
    ) -> Option<ExprId> {
        let one = self.constant(1.0);
        Some(match op {
            UnaryOp::Neg => self.constant(-1.0),
            UnaryOp::Not | UnaryOp::Floor | UnaryOp::Ceil => return None,
            UnaryOp::Abs => {
                let zero = self.constant(0.0);
                let below = self.binary(BinaryOp::Lt, a, zero);
                let minus = self.constant(-1.0);
                let sign = self.if_else(below, minus, one);
                self.no_event(sign)
            }
            UnaryOp::Sqrt => {
                let half = self.constant(0.5);
                let root = self.off_zero(ends, value, NEAR.sqrt());
                self.over(half, root)
            }
            UnaryOp::Exp => value,
            UnaryOp::Log => self.over(one, a),
            UnaryOp::Log10 => {
                let factor = self.constant(std::f64::consts::LOG10_E);
                self.over(factor, a)
            }
            UnaryOp::Sin => self.unary(UnaryOp::Cos, a),
            UnaryOp::Cos => {
                let sine = self.unary(UnaryOp::Sin, a);
                self.negative(sine)
            }
            UnaryOp::Tan => {
                let square = self.times(value, value);
                self.plus(one, square)
            }
            UnaryOp::Asin | UnaryOp::Acos => {
                let square = self.times(a, a);
                let rest = self.minus(one, square);
                let root = self.unary(UnaryOp::Sqrt, rest);
                let root = self.off_zero(ends, root, NEAR.sqrt());
                let factor = self.over(one, root);
                if op == UnaryOp::Asin {
                    factor
                } else {
                    self.negative(factor)
                }
            }
            UnaryOp::Atan => {
                let square = self.times(a, a);
                let below = self.plus(one, square);
                self.over(one, below)
            }
            UnaryOp::Sinh => self.unary(UnaryOp::Cosh, a),
            UnaryOp::Cosh => self.unary(UnaryOp::Sinh, a),
            UnaryOp::Tanh => {
                let square = self.times(value, value);
                self.minus(one, square)
            }
        })
    }

    /// An expression, and where it is exactly 0 another value if ends are to be finite.
    fn off_zero(&mut self, ends: Ends, id: ExprId, instead: f64) -> ExprId {
        if ends == Ends::Exact || self.as_constant(id).is_some_and(|value| value != 0.0) {
            return id;
        }
        let zero = self.constant(0.0);
        let at_zero = self.binary(BinaryOp::Eq, id, zero);
        let instead = self.constant(instead);
        let chosen = self.if_else(at_zero, instead, id);
        self.no_event(chosen)
    }

    fn binary_factor(
        &mut self,
        op: BinaryOp,
        (a, b): (ExprId, ExprId),
        value: ExprId,
        by_first: bool,
        ends: Ends,
    ) -> Option<ExprId> {
        let one = self.constant(1.0);
        Some(match op {
            BinaryOp::Add => one,
            BinaryOp::Sub => self.constant(if by_first { 1.0 } else { -1.0 }),
            BinaryOp::Mul => {
                if by_first {
                    b
                } else {
                    a
                }
            }
            BinaryOp::Div if by_first => self.over(one, b),
            BinaryOp::Div => {
                let quotient = self.over(value, b);
                self.negative(quotient)
            }
            BinaryOp::Pow if by_first => {
                let less = self.minus(b, one);
                let base = match self.as_constant(b) {
                    Some(exponent) if exponent >= 1.0 => a,
                    Some(_) => self.off_zero(ends, a, NEAR),
                    None => {
                        let upright = self.binary(BinaryOp::Lt, b, one);
                        let near = self.off_zero(ends, a, NEAR);
                        self.if_else(upright, near, a)
                    }
                };
                let power = self.binary(BinaryOp::Pow, base, less);
                self.times(b, power)
            }
            BinaryOp::Pow => {
                // At 0 the power is 0 whatever a positive exponent is.
                let base = self.off_zero(ends, a, 1.0);
                let log = self.unary(UnaryOp::Log, base);
                self.times(value, log)
            }
            BinaryOp::Min | BinaryOp::Max => {
                let comparison = if op == BinaryOp::Min {
                    BinaryOp::Lt
                } else {
                    BinaryOp::Gt
                };
                let second = self.binary(comparison, b, a);
                let zero = self.constant(0.0);
                let chosen = if by_first {
                    self.if_else(second, zero, one)
                } else {
                    self.if_else(second, one, zero)
                };
                self.no_event(chosen)
            }
            BinaryOp::Atan2 => {
                let (aa, bb) = (self.times(a, a), self.times(b, b));
                let below = self.plus(aa, bb);
                let below = self.off_zero(ends, below, NEAR);
                let above = if by_first { b } else { self.negative(a) };
                self.over(above, below)
            }
            BinaryOp::FloorTo | BinaryOp::RoundTo if by_first => one,
            BinaryOp::FloorTo
            | BinaryOp::RoundTo
            | BinaryOp::Lt
            | BinaryOp::Le
            | BinaryOp::Gt
            | BinaryOp::Ge
            | BinaryOp::Eq
            | BinaryOp::Ne
            | BinaryOp::And
            | BinaryOp::Or => return None,
        })
    }
}
