//! Expressions: nodes in an arena that keeps equal nodes once and folds what it can see at once.
//!
//! The constructors fold constants, drop `+ 0`, `* 1`, `/ 1`, make `* 0` zero, and turn small integer powers into
//! products. Children are always older than their parents, so ids are a topological order of every expression.

use crate::id::{AutomatonId, ExprId, Id, ParamId, RelationId, VarId};
use crate::{BinaryOp, UnaryOp};
use rustc_hash::FxHashMap;
use std::ops::Index as IndexOp;

/// What nodes were rewritten to, for [`ExprArena::rewrite`].
pub type Memo = FxHashMap<ExprId, ExprId>;

/// A constant, compared by its bits.
#[derive(Clone, Copy, Debug)]
pub struct Number(pub f64);

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}
impl Eq for Number {}
impl std::hash::Hash for Number {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

/// Which element of an array a reference means: `stride * counter + offset`, from 0. A scalar has `(0, 0)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Index {
    /// Factor of the counter of the enclosing equation.
    pub stride: i32,
    /// Constant part.
    pub offset: i32,
}

impl Index {
    /// The only element of a scalar, or element 0.
    pub const SCALAR: Self = Self {
        stride: 0,
        offset: 0,
    };

    /// Every element where the counter is its number.
    pub const COUNTER: Self = Self {
        stride: 1,
        offset: 0,
    };

    /// A fixed element.
    #[must_use]
    pub fn fixed(offset: i32) -> Self {
        Self { stride: 0, offset }
    }

    /// The element at a value of the counter.
    #[must_use]
    pub fn at(self, counter: i32) -> i32 {
        self.stride * counter + self.offset
    }
}

/// The values a counter takes, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Range {
    /// First value.
    pub first: i32,
    /// Last value.
    pub last: i32,
}

impl Range {
    /// The range of a scalar equation.
    pub const SCALAR: Self = Self { first: 0, last: 0 };

    /// Number of values.
    #[must_use]
    pub fn len(self) -> usize {
        usize::try_from(self.last - self.first + 1).unwrap_or(0)
    }

    /// Whether the counter takes no value at all.
    #[must_use]
    pub fn is_empty(self) -> bool {
        self.last < self.first
    }

    /// Every value.
    pub fn iter(self) -> impl Iterator<Item = i32> {
        self.first..=self.last
    }
}

/// A node. Leaves name variables and parameters; [`crate::Dae::place`] tells where their values lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Expr {
    /// A number.
    Const(Number),
    /// Time in s.
    Time,
    /// The value of the counter of the enclosing equation.
    Counter,
    /// A parameter (an element of it).
    Param(ParamId, Index),
    /// A variable (an element of it).
    Var(VarId, Index),
    /// The time derivative of a variable.
    Der(VarId, Index),
    /// In a `when` or a transition: the value before the event. In a clocked part: the value at the previous tick.
    Pre(VarId, Index),
    /// The truth of a relation, frozen between events.
    Relation(RelationId),
    /// 1 while the automaton is in the mode of that number.
    InMode(AutomatonId, u32),
    /// An operation on one value.
    Unary(UnaryOp, ExprId),
    /// An operation on two values.
    Binary(BinaryOp, ExprId, ExprId),
    /// The second where the first is not 0, else the third.
    If(ExprId, ExprId, ExprId),
    /// The expression with relations inside taken as they are now, without an event (`noEvent`).
    NoEvent(ExprId),
}

impl Expr {
    /// The element of a variable that a leaf reads, and whether it reads its derivative.
    #[must_use]
    pub fn access(self) -> Option<(VarId, Index, bool)> {
        match self {
            Self::Var(var, index) => Some((var, index, false)),
            Self::Der(var, index) => Some((var, index, true)),
            Self::Const(_)
            | Self::Time
            | Self::Counter
            | Self::Param(..)
            | Self::Pre(..)
            | Self::Relation(_)
            | Self::InMode(..)
            | Self::Unary(..)
            | Self::Binary(..)
            | Self::If(..)
            | Self::NoEvent(_) => None,
        }
    }

    /// Whether the node is made of parameters and numbers alone where its children are.
    #[must_use]
    pub fn is_parametric(self) -> bool {
        match self {
            Self::Const(_)
            | Self::Param(..)
            | Self::Unary(..)
            | Self::Binary(..)
            | Self::If(..)
            | Self::NoEvent(_) => true,
            Self::Time
            | Self::Counter
            | Self::Var(..)
            | Self::Der(..)
            | Self::Pre(..)
            | Self::Relation(_)
            | Self::InMode(..) => false,
        }
    }

    /// Whether the node reads one number, whatever the counter of its equation is.
    #[must_use]
    pub fn is_one_number(self) -> bool {
        self.is_parametric() && !matches!(self, Self::Param(_, index) if index.stride != 0)
    }

    /// Calls `visit` with each child.
    pub fn for_each_child(self, mut visit: impl FnMut(ExprId)) {
        match self {
            Self::Const(_)
            | Self::Time
            | Self::Counter
            | Self::Param(..)
            | Self::Var(..)
            | Self::Der(..)
            | Self::Pre(..)
            | Self::Relation(_)
            | Self::InMode(..) => {}
            Self::Unary(_, a) | Self::NoEvent(a) => visit(a),
            Self::Binary(_, a, b) => {
                visit(a);
                visit(b);
            }
            Self::If(c, a, b) => {
                visit(c);
                visit(a);
                visit(b);
            }
        }
    }
}

/// All expressions of a model.
#[derive(Clone, Debug, Default)]
pub struct ExprArena {
    nodes: Vec<Expr>,
    known: FxHashMap<Expr, ExprId>,
}

impl IndexOp<ExprId> for ExprArena {
    type Output = Expr;
    fn index(&self, id: ExprId) -> &Expr {
        &self.nodes[id.index()]
    }
}

impl ExprArena {
    /// Without expressions.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// A leaf, or a node to be folded as far as it can.
    pub fn add(&mut self, expr: Expr) -> ExprId {
        match expr {
            Expr::Unary(op, a) => self.unary(op, a),
            Expr::Binary(op, a, b) => self.binary(op, a, b),
            Expr::If(c, a, b) => self.if_else(c, a, b),
            Expr::NoEvent(a) => self.no_event(a),
            Expr::Const(_)
            | Expr::Time
            | Expr::Counter
            | Expr::Param(..)
            | Expr::Var(..)
            | Expr::Der(..)
            | Expr::Pre(..)
            | Expr::Relation(_)
            | Expr::InMode(..) => self.intern(expr),
        }
    }

    /// A number.
    pub fn constant(&mut self, value: f64) -> ExprId {
        self.intern(Expr::Const(Number(value)))
    }

    /// A scalar variable.
    pub fn var(&mut self, var: VarId) -> ExprId {
        self.intern(Expr::Var(var, Index::SCALAR))
    }

    /// The number, if the expression is one.
    #[must_use]
    pub fn as_constant(&self, id: ExprId) -> Option<f64> {
        if let Expr::Const(Number(value)) = self[id] {
            Some(value)
        } else {
            None
        }
    }

    /// Whether the expression is the number given.
    #[must_use]
    pub fn is_constant(&self, id: ExprId, value: f64) -> bool {
        self.as_constant(id)
            .is_some_and(|c| c.to_bits() == value.to_bits())
    }

    /// An operation on one value.
    pub fn unary(&mut self, op: UnaryOp, a: ExprId) -> ExprId {
        if let Some(value) = self.as_constant(a) {
            return self.constant(op.apply(value));
        }
        if let (UnaryOp::Neg, Expr::Unary(UnaryOp::Neg, inner)) = (op, self[a]) {
            return inner;
        }
        self.intern(Expr::Unary(op, a))
    }

    /// An operation on two values.
    pub fn binary(&mut self, op: BinaryOp, a: ExprId, b: ExprId) -> ExprId {
        use BinaryOp::{
            Add, And, Atan2, Div, Eq, FloorTo, Ge, Gt, Le, Lt, Max, Min, Mul, Ne, Or, Pow, RoundTo,
            Sub,
        };
        let (left, right) = (self.as_constant(a), self.as_constant(b));
        if let (Some(x), Some(y)) = (left, right) {
            return self.constant(op.apply(x, y));
        }
        let zero = |value: Option<f64>| value == Some(0.0);
        let one = |value: Option<f64>| value == Some(1.0);
        match op {
            Add if zero(left) => b,
            Add | Sub if zero(right) => a,
            Sub if zero(left) => self.unary(UnaryOp::Neg, b),
            Sub if a == b => self.constant(0.0),
            Mul if zero(left) || zero(right) => self.constant(0.0),
            Mul if one(left) => b,
            Mul | Div if one(right) => a,
            Mul if left == Some(-1.0) => self.unary(UnaryOp::Neg, b),
            Mul | Div if right == Some(-1.0) => self.unary(UnaryOp::Neg, a),
            Div if zero(left) => self.constant(0.0),
            Pow => self.power(a, b, right),
            And if zero(left) || zero(right) => self.constant(0.0),
            And if one(left) => b,
            And if one(right) => a,
            Or if one(left) || one(right) => self.constant(1.0),
            Or if zero(left) => b,
            Or if zero(right) => a,
            Add | Sub | Mul | Div | Min | Max | Atan2 | FloorTo | RoundTo | Lt | Le | Gt | Ge
            | Eq | Ne | And | Or => self.intern(Expr::Binary(op, a, b)),
        }
    }

    /// `a + b`
    pub fn plus(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.binary(BinaryOp::Add, a, b)
    }

    /// `a - b`
    pub fn minus(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.binary(BinaryOp::Sub, a, b)
    }

    /// `a * b`
    pub fn times(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.binary(BinaryOp::Mul, a, b)
    }

    /// `a / b`
    pub fn over(&mut self, a: ExprId, b: ExprId) -> ExprId {
        self.binary(BinaryOp::Div, a, b)
    }

    /// `-a`
    pub fn negative(&mut self, a: ExprId) -> ExprId {
        self.unary(UnaryOp::Neg, a)
    }

    /// `if condition then a else b`
    pub fn if_else(&mut self, condition: ExprId, a: ExprId, b: ExprId) -> ExprId {
        if a == b {
            return a;
        }
        match self.as_constant(condition) {
            Some(0.0) => b,
            Some(_) => a,
            None => self.intern(Expr::If(condition, a, b)),
        }
    }

    /// The same without events.
    pub fn no_event(&mut self, a: ExprId) -> ExprId {
        if self.as_constant(a).is_some() {
            a
        } else {
            self.intern(Expr::NoEvent(a))
        }
    }

    /// Rebuilds `root` with every leaf (and `NoEvent`) passed through `replace`, which returns `None` to keep it.
    pub fn rewrite(
        &mut self,
        root: ExprId,
        memo: &mut Memo,
        mut replace: impl FnMut(&mut Self, ExprId, Expr) -> Option<ExprId>,
    ) -> ExprId {
        for id in self.below_new(root, |id| memo.contains_key(&id)) {
            let expr = self[id];
            let new = replace(self, id, expr).unwrap_or_else(|| match expr {
                Expr::Unary(op, a) => self.unary(op, memo[&a]),
                Expr::NoEvent(a) => self.no_event(memo[&a]),
                Expr::Binary(op, a, b) => self.binary(op, memo[&a], memo[&b]),
                Expr::If(c, a, b) => self.if_else(memo[&c], memo[&a], memo[&b]),
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..) => id,
            });
            memo.insert(id, new);
        }
        memo[&root]
    }

    /// What stands below some roots, in an arena of its own with each leaf as `leaf` gives it; the roots there.
    #[must_use]
    pub fn copied(
        &self,
        roots: &[ExprId],
        mut leaf: impl FnMut(Expr) -> Expr,
    ) -> (Self, Vec<ExprId>) {
        let (mut copy, mut places) = (Self::new(), Memo::default());
        for id in self.below(roots) {
            let own = match self[id] {
                Expr::Unary(op, a) => Expr::Unary(op, places[&a]),
                Expr::Binary(op, a, b) => Expr::Binary(op, places[&a], places[&b]),
                Expr::If(c, a, b) => Expr::If(places[&c], places[&a], places[&b]),
                Expr::NoEvent(a) => Expr::NoEvent(places[&a]),
                number @ Expr::Const(_) => number,
                other @ (Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)) => leaf(other),
            };
            let place = copy.add(own);
            places.insert(id, place);
        }
        let roots = roots.iter().map(|root| places[root]).collect();
        (copy, roots)
    }

    fn power(&mut self, a: ExprId, b: ExprId, exponent: Option<f64>) -> ExprId {
        match exponent {
            Some(0.0) => self.constant(1.0),
            Some(1.0) => a,
            Some(0.5) => self.unary(UnaryOp::Sqrt, a),
            Some(2.0) => self.times(a, a),
            Some(3.0) => {
                let square = self.times(a, a);
                self.times(square, a)
            }
            Some(4.0) => {
                let square = self.times(a, a);
                self.times(square, square)
            }
            Some(-1.0) => {
                let one = self.constant(1.0);
                self.over(one, a)
            }
            Some(_) | None => self.intern(Expr::Binary(BinaryOp::Pow, a, b)),
        }
    }

    fn intern(&mut self, expr: Expr) -> ExprId {
        *self.known.entry(expr).or_insert_with(|| {
            let id = ExprId::from_index(self.nodes.len());
            self.nodes.push(expr);
            id
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_nodes_are_one_node_and_constants_fold() {
        let mut arena = ExprArena::new();
        let x = arena.var(VarId::from_index(0));
        let one = arena.constant(1.0);
        let a = arena.plus(x, one);
        let b = arena.plus(x, one);
        assert_eq!(a, b);
        let zero = arena.minus(a, b);
        assert!(arena.is_constant(zero, 0.0));
        let two = arena.plus(one, one);
        let square = arena.binary(BinaryOp::Pow, x, two);
        assert_eq!(arena[square], Expr::Binary(BinaryOp::Mul, x, x));
    }

    #[test]
    fn rewrite_replaces_leaves_and_folds_again() {
        let mut arena = ExprArena::new();
        let (v, w) = (VarId::from_index(0), VarId::from_index(1));
        let (x, y) = (arena.var(v), arena.var(w));
        let product = arena.times(x, y);
        let sum = arena.plus(product, x);
        let new = arena.rewrite(sum, &mut Memo::default(), |arena, _, e| {
            matches!(e, Expr::Var(id, _) if id == w).then(|| arena.constant(0.0))
        });
        assert_eq!(new, x);
    }
}
