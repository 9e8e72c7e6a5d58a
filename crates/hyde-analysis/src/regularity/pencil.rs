//! The matrix of a model's equations by its unknowns: of each pair d/dx + s*d/dder(x) at one generic s.
//!
//! Factors of parameters have their declared values, all others are numbers without relation to each other (a mixed matrix:
//! Murota, Matrices and Matroids for Systems Analysis, §4). The model determines its unknowns only if the matrix is regular,
//! of whatever index (Gantmacher, Theory of Matrices II, XII: a regular pencil).

use super::elimination::Row;
use super::exact::Exact;
use super::residue::{Generic, Residue};
use super::shortened::Shortened;
use crate::matching::{Node, sides};
use crate::system::System;
use hyde_ir::{Expr, VarId};
use std::collections::BTreeMap;

/// The matrix with what its rows and columns mean.
pub(crate) struct Pencil {
    pub(crate) rows: Vec<Row>,
    /// The equation of each row.
    pub(crate) nodes: Vec<Node>,
    /// The variable of each column.
    pub(crate) columns: Vec<VarId>,
}

/// Makes the matrix; `None` where equations over ranges skip elements.
pub(crate) fn pencil(system: &System) -> Option<Pencil> {
    let shortened = Shortened::new(system)?;
    let mut first_column: BTreeMap<VarId, usize> = BTreeMap::new();
    let mut columns = Vec::new();
    for (var, _) in system.flat.variables.enumerate() {
        if system.is_continuous(var) {
            first_column.insert(var, columns.len());
            let size = usize::try_from(shortened.size(system, var)).unwrap_or(0);
            columns.extend(std::iter::repeat_n(var, size));
        }
    }
    let mut exprs = system.flat.exprs.clone();
    let mut exact = Exact::new(&system.flat);
    let mut generic = Generic::new();
    let s = generic.next();
    let mut found = Pencil {
        rows: Vec::new(),
        nodes: Vec::new(),
        columns,
    };
    let nodes = (0..system.equations.len()).map(Node::Equation);
    for node in nodes.chain((0..system.slots.len()).map(Node::Slot)) {
        let sides = sides(system, node);
        let mut gradient = Vec::new();
        for &(_, lhs, rhs) in &sides {
            let residual = exprs.minus(lhs, rhs);
            let wanted = |leaf: Expr| {
                let access = leaf.access();
                access.is_some_and(|(var, ..)| first_column.contains_key(&var))
            };
            for (leaf, factor) in exprs.gradient(residual, wanted) {
                gradient.extend(leaf.access().map(|access| (access, factor)));
            }
        }
        let Some(&(range, ..)) = sides.first() else {
            continue;
        };
        let accesses: Vec<_> = gradient.iter().map(|((v, i, _), _)| (*v, *i)).collect();
        let remaining = shortened.range(range, &accesses);
        for counter in remaining.iter() {
            let original = (range.first + counter - remaining.first).min(range.last);
            let mut row = Row::new();
            for &((var, index, derivative), factor) in &gradient {
                let element = match index.stride {
                    0 => shortened.element(var, index.offset),
                    _ => index.at(counter),
                };
                let column = first_column[&var] + usize::try_from(element).unwrap_or(0);
                // The modes of a block have one row: nothing is known of its factors.
                let known = match node {
                    Node::Equation(_) => exact.residue(&exprs, factor, original),
                    Node::Slot(_) => None,
                };
                let value = known.unwrap_or_else(|| generic.next());
                let value = if derivative { value.times(s) } else { value };
                let entry = row.entry(column).or_insert(Residue::ZERO);
                *entry = entry.plus(value);
            }
            row.retain(|_, value| *value != Residue::ZERO);
            found.rows.push(row);
            found.nodes.push(node);
        }
    }
    Some(found)
}
