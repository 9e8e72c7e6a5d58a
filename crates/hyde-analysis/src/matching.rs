//! Matches every equation to the unknown it determines, whole arrays to whole equations.
//!
//! The unknowns are derivatives of states and values of the other variables. What stays unmatched is told in the words
//! of the model: a boundary flux without a condition, an input that nothing drives, states that are constrained to each
//! other, equations too many or too few with the part of the system they conflict in (Dulmage and Mendelsohn).

mod mismatch;
mod node;

use crate::graph::Bipartite;
use crate::mode_constraints;
use crate::pins::mark;
use crate::segments::{self, Segment};
use crate::system::System;
use crate::unroll;
use hyde_diag::Diagnostics;
use hyde_ir::{BinaryOp, Expr, ExprId, UnaryOp};
pub(crate) use mismatch::{equation_for, missing_boundary, name, unbound_input};
use mismatch::{report, undetermined};
pub(crate) use node::{Node, origin, sides};
use rustc_hash::FxHashMap;
use std::cmp::Ordering;

/// The matched system.
pub(crate) struct Matched {
    /// The unknowns.
    pub(crate) unknowns: Vec<Segment>,
    /// The equation that determines each of them.
    pub(crate) equation_of: Vec<Node>,
}

/// Matches the system; reports why it cannot.
pub(crate) fn match_equations(
    system: &mut System,
    diagnostics: &mut Diagnostics,
) -> Option<Matched> {
    let mut unknowns = match segments::segments(system) {
        Ok(unknowns) => unknowns,
        Err(arrays) => {
            unroll::unroll(system, &arrays, diagnostics)?;
            match segments::segments(system) {
                Ok(unknowns) => unknowns,
                Err(arrays) => {
                    for array in arrays {
                        diagnostics.push(undetermined(system, array));
                    }
                    return None;
                }
            }
        }
    };
    mark(system, &unknowns);
    unknowns.sort_unstable();
    if mode_constraints::refuse(system, &unknowns, diagnostics) {
        return None;
    }
    let nodes: Vec<Node> = (0..system.equations.len())
        .map(Node::Equation)
        .chain((0..system.slots.len()).map(Node::Slot))
        .collect();
    let edges: Vec<Vec<usize>> = nodes
        .iter()
        .map(|&node| edges(system, node, &unknowns))
        .collect();
    let graph = Bipartite {
        edges,
        n_right: unknowns.len(),
    };
    let matching = graph.maximum_matching();
    if matching.of_left.contains(&None) || matching.of_right.contains(&None) {
        report(system, &nodes, &unknowns, &graph, &matching, diagnostics);
        return None;
    }
    let equation_of = matching
        .of_right
        .iter()
        .map(|left| nodes[left.unwrap_or(0)])
        .collect();
    Some(Matched {
        unknowns,
        equation_of,
    })
}

/// The unknowns an equation can determine, best first: what it is written for, derivatives, the rest. Of several derivatives
/// those with the larger constant factor come first: in the row of a mass matrix the cell's own, so that each row is that
/// of its cell, where a mode may hold it.
pub(crate) fn edges(system: &System, node: Node, unknowns: &[Segment]) -> Vec<usize> {
    let constraint = matches!(node, Node::Equation(number) if system.equations[number].constraint);
    let mut found: Vec<(u8, usize, f64)> = Vec::new();
    for (range, lhs, rhs) in sides(system, node) {
        let factors = constant_factors(system, [lhs, rhs]);
        for id in system.flat.exprs.below(&[lhs, rhs]) {
            let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
                continue;
            };
            let (first, last) = System::interval(index, range);
            let covered = unknowns.binary_search_by(|u| (u.var, u.first).cmp(&(var, first)));
            let Ok(number) = covered else { continue };
            let unknown = unknowns[number];
            // A constraint determines one of its group instead of the row that would tie its derivative.
            let tied = constraint && unknown.state && system.rate_of((var, first)).is_some();
            if unknown.last != last
                || unknown.len() != range.len()
                || (unknown.state != derivative && !tied)
            {
                continue;
            }
            let cost = match (id == lhs, derivative) {
                (true, false) => 0,
                (_, true) => 1,
                (false, false) if id == rhs => 2,
                (false, false) => 3,
            };
            let factor = factors.get(&id).filter(|_| derivative).map_or(1.0, |f| *f);
            match found.iter_mut().find(|(_, known, _)| *known == number) {
                Some(known) => known.0 = known.0.min(cost),
                None => found.push((cost, number, factor)),
            }
        }
    }
    found.sort_by(|a, b| {
        (a.0, -a.2, a.1)
            .partial_cmp(&(b.0, -b.2, b.1))
            .unwrap_or(Ordering::Equal)
    });
    found.into_iter().map(|(_, number, _)| number).collect()
}

/// The magnitudes of the numbers that parts of sums are multiplied by, the largest where a part is met more than once.
fn constant_factors(system: &System, sums: [ExprId; 2]) -> FxHashMap<ExprId, f64> {
    let exprs = &system.flat.exprs;
    let mut factors: FxHashMap<ExprId, f64> = sums.iter().map(|&id| (id, 1.0)).collect();
    // Each sum before its parts, each once: parts are shared, and the ways to one may be without number.
    for id in exprs.below(&sums).into_iter().rev() {
        let Some(&factor) = factors.get(&id) else {
            continue;
        };
        let mut goes_on = |part: ExprId, factor: f64| {
            let own = factors.entry(part).or_insert(0.0);
            *own = own.max(factor);
        };
        match exprs[id] {
            Expr::Binary(BinaryOp::Add | BinaryOp::Sub, a, b) => {
                goes_on(a, factor);
                goes_on(b, factor);
            }
            Expr::Unary(UnaryOp::Neg, a) => goes_on(a, factor),
            Expr::Binary(BinaryOp::Mul, a, b) => {
                let (of_a, of_b) = (exprs.as_constant(a), exprs.as_constant(b));
                goes_on(a, factor * of_b.map_or(1.0, f64::abs));
                goes_on(b, factor * of_a.map_or(1.0, f64::abs));
            }
            Expr::Der(..)
            | Expr::Const(_)
            | Expr::Time
            | Expr::Counter
            | Expr::Param(..)
            | Expr::Var(..)
            | Expr::Pre(..)
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::Unary(..)
            | Expr::Binary(..)
            | Expr::If(..)
            | Expr::NoEvent(_) => {}
        }
    }
    factors
}
