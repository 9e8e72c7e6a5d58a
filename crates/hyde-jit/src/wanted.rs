//! What the code of a node is made of: its children, each as a number or as a truth, and whether it changes with the counter.

use crate::routine::{Leaf, Routine};
use hyde_ir::{BinaryOp, Dae, Expr, ExprId, UnaryOp};
use rustc_hash::FxHashMap;
use std::ops::Range;

/// How the value of a node is wanted.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Wanted {
    Number,
    Truth,
}

/// Whether a node is a truth by itself.
pub(crate) fn is_truth(expr: Expr) -> bool {
    match expr {
        Expr::Binary(op, ..) => op.is_truth(),
        Expr::Unary(op, _) => op == UnaryOp::Not,
        Expr::InMode(..) => true,
        Expr::Const(_)
        | Expr::Time
        | Expr::Counter
        | Expr::Param(..)
        | Expr::Var(..)
        | Expr::Der(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::If(..)
        | Expr::NoEvent(_) => false,
    }
}

/// What a node needs of its children, or of itself in another form.
pub(crate) fn children(
    dae: &Dae,
    id: ExprId,
    wanted: Wanted,
    mut need: impl FnMut(ExprId, Wanted),
) {
    let expr = dae.exprs[id];
    match (expr, wanted) {
        (Expr::NoEvent(a), wanted) => need(a, wanted),
        (Expr::If(c, a, b), wanted) => {
            need(b, wanted);
            need(a, wanted);
            need(c, Wanted::Truth);
        }
        _ if is_truth(expr) && wanted == Wanted::Number => need(id, Wanted::Truth),
        _ if !is_truth(expr) && wanted == Wanted::Truth => need(id, Wanted::Number),
        (Expr::Unary(UnaryOp::Not, a), _) => need(a, Wanted::Truth),
        (Expr::Binary(BinaryOp::And | BinaryOp::Or, a, b), _) => {
            need(b, Wanted::Truth);
            need(a, Wanted::Truth);
        }
        (Expr::Unary(_, a), _) => need(a, Wanted::Number),
        (Expr::Binary(_, a, b), _) => {
            need(b, Wanted::Number);
            need(a, Wanted::Number);
        }
        _ => {}
    }
}

/// Which nodes of some steps change with the counter.
pub(crate) fn moving(dae: &Dae, routine: &Routine, steps: Range<usize>) -> FxHashMap<ExprId, bool> {
    let roots: Vec<ExprId> = routine.steps[steps].iter().map(|step| step.value).collect();
    let mut found: FxHashMap<ExprId, bool> = FxHashMap::default();
    for id in dae.exprs.below(&roots) {
        let expr = dae.exprs[id];
        let mut moving = match routine.leaf(dae, expr) {
            Some(Leaf::Counter) => true,
            Some(Leaf::Load(_, index)) => index.stride != 0,
            Some(Leaf::IsMode(..) | Leaf::Number(_) | Leaf::Time) | None => false,
        };
        expr.for_each_child(|child| moving |= found[&child]);
        found.insert(id, moving);
    }
    found
}

/// Sine and cosine of the same argument that are both among some nodes, by either of them.
pub(crate) fn sines_with_cosines(
    dae: &Dae,
    nodes: impl Iterator<Item = ExprId>,
) -> FxHashMap<ExprId, (ExprId, ExprId)> {
    let mut of_argument: FxHashMap<ExprId, (Option<ExprId>, Option<ExprId>)> = FxHashMap::default();
    for id in nodes {
        if let Expr::Unary(op, argument) = dae.exprs[id] {
            let pair = of_argument.entry(argument).or_default();
            if op == UnaryOp::Sin {
                pair.0 = Some(id);
            } else if op == UnaryOp::Cos {
                pair.1 = Some(id);
            }
        }
    }
    let both = of_argument
        .into_values()
        .filter_map(|(sine, cosine)| sine.zip(cosine));
    both.flat_map(|pair| [(pair.0, pair), (pair.1, pair)])
        .collect()
}
