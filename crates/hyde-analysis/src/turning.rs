//! How fast sources turn: a sine of the time bounds the steps of a method that looks at their ends alone.
//!
//! Between two ends that tell nothing a source may have its whole effect: a rectifier takes its current in pulses, and a
//! multistep method whose steps have grown in the rest between them passes over one without an error to be seen. So the
//! rates of the arguments of sines and cosines are kept that turn evenly, with the time or with a state of constant rate:
//! ```text
//! 0 = x - sin(2*pi*f*time + phase)              ->  2*pi*f
//! 0 = der(phi) - w;  0 = tau - k*cos(p*phi)     ->  p*w
//! ```
//! An argument whose rate changes (a sweep), or that the counter of an array row is part of, gives none.
//!
//! What makes a pulse of a sine is an exponential that grows, as that of a diode: whether there is one is kept as well. One
//! that decays, as `exp(-(v/vs)^2)` of a friction law, is none. Kept, too, is whether anything but unknowns moves with time.

use crate::solve::solve_for;
use hyde_ir::{BinaryOp, Dae, Expr, ExprArena, ExprId, Index, UnaryOp, VariableKind};
use rustc_hash::FxHashMap;
use std::cell::Cell;

/// What turns in the residual, of which every explicit variable is replaced by its definition.
pub(crate) fn find(dae: &mut Dae, rows: &[ExprId]) {
    let mut turning = Turning::default();
    for &row in rows {
        if let Some((state, rate)) = even(&mut dae.exprs, row) {
            turning.even.insert(state, rate);
        }
    }
    for &row in rows {
        turning.see(&mut dae.exprs, row);
    }
    dae.turning = turning.rates;
    dae.exponential = turning.exponential;
    dae.timed = is_timed(dae);
}

/// The arguments of the sines and cosines in root functions: a root function may come to zero and back between two points of a step
/// as often as they turn between these.
pub(crate) fn find_angles(dae: &mut Dae, roots: &[ExprId]) {
    for id in dae.exprs.below(roots) {
        if let Expr::Unary(UnaryOp::Sin | UnaryOp::Cos, argument) = dae.exprs[id]
            && !dae.exprs.is_parametric(argument)
            && !dae.angles.contains(&argument)
        {
            dae.angles.push(argument);
        }
    }
}

/// Whether the time, a record column or a delayed value stands in the residual or in what is explicit.
fn is_timed(dae: &Dae) -> bool {
    let residuals = dae.residuals.iter().map(|own| own.value);
    let definitions = dae.definitions.iter().map(|own| own.value);
    let roots: Vec<ExprId> = residuals.chain(definitions).collect();
    let moves = |id: ExprId| match dae.exprs[id].access() {
        Some((var, ..)) => matches!(
            dae.variables[var].kind,
            VariableKind::Column(..) | VariableKind::Delayed(_)
        ),
        None => dae.exprs[id] == Expr::Time,
    };
    dae.exprs.below(&roots).into_iter().any(moves)
}

/// The state whose rate a row gives by parameters alone.
fn even(arena: &mut ExprArena, row: ExprId) -> Option<(Expr, ExprId)> {
    let rates = Cell::new(None);
    let other = arena.any(row, |leaf| {
        if matches!(leaf, Expr::Der(..)) {
            return rates.replace(Some(leaf)).is_some();
        }
        own(leaf) != Of::Parameters
    });
    let rate = rates.get().filter(|_| !other)?;
    let Expr::Der(var, index @ Index { stride: 0, .. }) = rate else {
        return None;
    };
    let zero = arena.constant(0.0);
    let value = solve_for(arena, row, zero, rate)?;
    Some((Expr::Var(var, index), value))
}

/// What an expression is made of.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Of {
    Parameters,
    /// The time too, and states that it alone moves.
    Time,
    Other,
}

/// The rates found so far, and what is known of the nodes that were looked at.
#[derive(Default)]
struct Turning {
    even: FxHashMap<Expr, ExprId>,
    known: FxHashMap<ExprId, Of>,
    rates: Vec<ExprId>,
    /// Whether there is an exponential of unknowns.
    exponential: bool,
}

impl Turning {
    fn see(&mut self, arena: &mut ExprArena, root: ExprId) {
        for id in arena.below_new(root, |id| self.known.contains_key(&id)) {
            let expr = arena[id];
            let mut of = match self.even.contains_key(&expr) {
                true => Of::Time,
                false => own(expr),
            };
            expr.for_each_child(|child| of = of.max(self.known[&child]));
            self.known.insert(id, of);
            let Expr::Unary(op, argument) = expr else {
                continue;
            };
            let decays = || signs(arena, argument, 0).0;
            self.exponential |= op == UnaryOp::Exp && of == Of::Other && !decays();
            if matches!(op, UnaryOp::Sin | UnaryOp::Cos) && of == Of::Time {
                self.keep(arena, argument);
            }
        }
    }

    fn keep(&mut self, arena: &mut ExprArena, argument: ExprId) {
        let rate = arena.tangent(argument, |arena, leaf| {
            if leaf == Expr::Time {
                return Some(arena.constant(1.0));
            }
            self.even.get(&leaf).copied()
        });
        if arena.is_parametric(rate) && !self.rates.contains(&rate) {
            self.rates.push(rate);
        }
    }
}

/// Nodes on the way down to what decides the sign of an exponent, at most.
const DEEPEST: u32 = 8;

/// Whether an expression is 0 or less, and whether it is 0 or more, whatever its variables are, if its parameters are positive.
fn signs(arena: &ExprArena, id: ExprId, depth: u32) -> (bool, bool) {
    let of = |id| match depth < DEEPEST {
        true => signs(arena, id, depth + 1),
        false => (false, false),
    };
    match arena[id] {
        Expr::Const(value) => (value.0 <= 0.0, value.0 >= 0.0),
        Expr::Param(..) => (false, true),
        Expr::NoEvent(a) => of(a),
        Expr::Unary(UnaryOp::Neg, a) => {
            let (below, above) = of(a);
            (above, below)
        }
        Expr::Unary(op, _) => {
            let above = matches!(op, UnaryOp::Abs | UnaryOp::Sqrt | UnaryOp::Exp);
            (false, above)
        }
        Expr::Binary(BinaryOp::Mul, a, b) if without_minus(arena, a) == without_minus(arena, b) => {
            (a != b, a == b)
        }
        Expr::Binary(BinaryOp::Mul | BinaryOp::Div, a, b) => {
            let (a, b) = (of(a), of(b));
            (a.0 && b.1 || a.1 && b.0, a.1 && b.1 || a.0 && b.0)
        }
        Expr::Binary(BinaryOp::Add, a, b) => {
            let (a, b) = (of(a), of(b));
            (a.0 && b.0, a.1 && b.1)
        }
        Expr::Binary(BinaryOp::Sub, a, b) => {
            let (a, b) = (of(a), of(b));
            (a.0 && b.1, a.1 && b.0)
        }
        Expr::Binary(BinaryOp::Pow, a, b) => {
            let even = arena.as_constant(b).is_some_and(|power| power % 2.0 == 0.0);
            (false, even || of(a).1)
        }
        Expr::Binary(..) => (false, false),
        // The magnitude of the library: `if x < 0 then -x else x`.
        Expr::If(_, a, b) if a != b && without_minus(arena, a) == without_minus(arena, b) => {
            (false, true)
        }
        Expr::If(_, a, b) => {
            let (a, b) = (of(a), of(b));
            (a.0 && b.0, a.1 && b.1)
        }
        Expr::Time
        | Expr::Counter
        | Expr::Var(..)
        | Expr::Der(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::InMode(..) => (false, false),
    }
}

/// An expression, or what its sign is changed of: `-x*x` is the product of `-x` and `x`.
fn without_minus(arena: &ExprArena, id: ExprId) -> ExprId {
    if let Expr::Unary(UnaryOp::Neg, inner) = arena[id] {
        return inner;
    }
    id
}

/// What a node adds to its children.
fn own(expr: Expr) -> Of {
    if expr.is_one_number() {
        return Of::Parameters;
    }
    match expr == Expr::Time {
        true => Of::Time,
        false => Of::Other,
    }
}
