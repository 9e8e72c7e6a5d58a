//! Rigid parts that hold each other where they are: two ratios in one loop leave every angle of it at zero.
//!
//! Such a model is regular and moves nowhere. Equations without a derivative, a known number or a signal in them, which give
//! a state the value zero, are no drive: reported where more than one component has a part in it.

use super::elimination::{Row, dependent_sets, free_columns};
use super::exact::Exact;
use super::residue::Residue;
use super::words::{Conflict, jammed};
use crate::matching::Node;
use crate::system::{Equation, System};
use hyde_diag::Diagnostics;
use hyde_ir::{Expr, Memo, Range, VarId};
use std::collections::{BTreeMap, BTreeSet};

/// Reports states that rigid parts hold at zero; whether there are any.
pub(super) fn refuse(system: &System, diagnostics: &mut Diagnostics) -> bool {
    let (rows, nodes, columns) = proportions(system);
    // What no combination of unknowns that satisfies them moves.
    let free = free_columns(&rows, columns.len());
    let mut reported: BTreeSet<usize> = BTreeSet::new();
    for var in bodies(system) {
        let Some(&column) = columns.get(&var).filter(|column| !free.contains(column)) else {
            continue;
        };
        // With `x = 0` added: the others say it already where they depend on it.
        let mut with = rows.clone();
        with.push(Row::from([(column, Residue::ONE)]));
        let sets = dependent_sets(&with);
        let Some(set) = sets.iter().find(|set| set.contains(&rows.len())) else {
            continue;
        };
        let equations: Vec<Node> = set
            .iter()
            .filter(|&&row| row < rows.len())
            .map(|&row| nodes[row])
            .collect();
        let conflict = Conflict::new(system, equations);
        if conflict.is_of_several() && set.iter().all(|row| !reported.contains(row)) {
            reported.extend(set.iter().filter(|&&row| row < rows.len()));
            diagnostics.push(jammed(system, &conflict, var));
        }
    }
    !reported.is_empty()
}

/// The scalar equations that are sums of factors times variables and nothing else.
fn proportions(system: &System) -> (Vec<Row>, Vec<Node>, BTreeMap<VarId, usize>) {
    let mut exprs = system.flat.exprs.clone();
    let mut exact = Exact::new(&system.flat);
    let mut columns: BTreeMap<VarId, usize> = BTreeMap::new();
    let (mut rows, mut nodes) = (Vec::new(), Vec::new());
    for (number, equation) in system.equations.iter().enumerate() {
        if !may_be_proportion(system, equation) {
            continue;
        }
        let residual = exprs.minus(equation.lhs, equation.rhs);
        let gradient = exprs.gradient(residual, |leaf| leaf.access().is_some());
        let mut row = Row::new();
        let mut linear = true;
        for (leaf, factor) in gradient {
            let Some((var, ..)) = leaf.access() else {
                continue;
            };
            let next = columns.len();
            let column = *columns.entry(var).or_insert(next);
            match exact.residue(&exprs, factor, 0) {
                Some(value) if value == Residue::ZERO => {}
                Some(value) => drop(row.insert(column, value)),
                None => linear = false,
            }
        }
        // Without its variables nothing must be left: no length, no offset.
        let bare = exprs.rewrite(residual, &mut Memo::default(), |exprs, _, expr| {
            expr.access().map(|_| exprs.constant(0.0))
        });
        if linear && exprs.as_constant(bare) == Some(0.0) {
            rows.push(row);
            nodes.push(Node::Equation(number));
        }
    }
    (rows, nodes, columns)
}

/// A scalar equation of scalars that are known at no instant beforehand.
fn may_be_proportion(system: &System, equation: &Equation) -> bool {
    let own = |expr: Expr| {
        if let Expr::Var(var, _) = expr {
            return system.is_continuous(var) && system.flat.variables[var].len.is_none();
        }
        expr.is_parametric()
    };
    let below = system.flat.exprs.below(&[equation.lhs, equation.rhs]);
    equation.range == Range::SCALAR && below.into_iter().all(|id| own(system.flat.exprs[id]))
}

/// Variables that a body starts with: differentiated, with a fixed start value.
fn bodies(system: &System) -> Vec<VarId> {
    let differentiated = crate::segments::state_cells(system);
    let variables = system.flat.variables.enumerate();
    let bodies = variables.filter(|&(var, variable)| {
        variable.fixed && variable.len.is_none() && differentiated.contains(&(var, 0))
    });
    bodies.map(|(var, _)| var).collect()
}
