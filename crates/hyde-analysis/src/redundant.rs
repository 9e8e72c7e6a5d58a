//! Constraints that depend on each other by their numbers alone: a linkage with a crank too many moves, but how its cranks
//! share the force cannot be told.
//!
//! Their Jacobian is regular at places that are none of the linkage's, so that [`crate::regularity`] finds nothing. It is
//! looked at where the constraints hold: from the start values, moved a little without relation to each other (a dead
//! centre is no crank too many), the nearest such place is sought by Levenberg and Marquardt's steps (Nocedal and Wright,
//! Numerical Optimization, §10.3). What depends at two such places depends everywhere.

use crate::matching::Node;
use crate::reduce;
use crate::regularity::held_once_more;
use crate::system::{Cell, System};
use hyde_diag::Diagnostics;
use hyde_ir::{Expr, ExprId};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// Places that are looked at.
const PLACES: usize = 2;
/// Steps to one of them at most.
const MAX_STEPS: usize = 100;
/// The constraints hold to this, over the size of their values.
const HOLDS: f64 = 1e-12;
/// A singular value is zero below this times the largest: what the place is off by leaves much less.
const ZERO: f64 = 1e-8;
/// What takes part in a combination does so from this times the largest.
const TAKES_PART: f64 = 1e-5;
/// How far the start values are moved: radians and metres of a machine, small beside its parts or not.
const MOVED: f64 = 0.1;
/// Larger groups are left to the run.
const MAX_VARIABLES: usize = 300;

/// Reports constraints that depend on each other wherever they hold; whether there are any.
pub(crate) fn refuse(system: &mut System, diagnostics: &mut Diagnostics) -> bool {
    let declared = system.declared_values();
    let mut found = false;
    for group in 0..system.groups.len() {
        let Some(constraints) = Constraints::new(system, group) else {
            continue;
        };
        if let Some(rows) = constraints.dependent(system, &declared) {
            let nodes = rows
                .iter()
                .map(|&row| Node::Equation(constraints.equations[row]));
            diagnostics.push(held_once_more(system, nodes.collect()));
            found = true;
        }
    }
    found
}

/// The constraints of a group as written, with their derivatives by its variables.
struct Constraints {
    equations: Vec<usize>,
    cells: Vec<Cell>,
    residuals: Vec<ExprId>,
    /// Row, column and value of each entry of the Jacobian.
    entries: Vec<(usize, usize, ExprId)>,
}

impl Constraints {
    /// `None` where derivatives of constraints are among them, or more than one cares to look at.
    fn new(system: &mut System, group: usize) -> Option<Self> {
        let equations: Vec<usize> = (0..system.equations.len())
            .filter(|&number| reduce::group_of(system, number) == Some(group))
            .collect();
        let cells: Vec<Cell> = system.groups[group]
            .candidates
            .iter()
            .map(|(cell, _)| *cell)
            .collect();
        let derived = equations
            .iter()
            .any(|&number| system.equations[number].order > 0);
        if derived || equations.len() < 2 || cells.len() > MAX_VARIABLES {
            return None;
        }
        let (mut residuals, mut entries) = (Vec::new(), Vec::new());
        for (row, &number) in equations.iter().enumerate() {
            let (lhs, rhs) = (system.equations[number].lhs, system.equations[number].rhs);
            let residual = system.flat.exprs.minus(lhs, rhs);
            residuals.push(residual);
            for (leaf, value) in system
                .flat
                .exprs
                .gradient(residual, |leaf| matches!(leaf, Expr::Var(..)))
            {
                let Expr::Var(var, index) = leaf else {
                    continue;
                };
                let cell = System::cell(var, index)?;
                if let Some(column) = cells.iter().position(|&own| own == cell) {
                    entries.push((row, column, value));
                }
            }
        }
        Some(Self {
            equations,
            cells,
            residuals,
            entries,
        })
    }

    /// The rows that combine to zero at every place that is looked at.
    fn dependent(&self, system: &System, declared: &[Vec<f64>]) -> Option<Vec<usize>> {
        let mut rows = None;
        for place in 0..PLACES {
            let jacobian = self.at_a_place(system, declared, place)?;
            let svd = jacobian.svd(true, false);
            let least = svd.singular_values.imin();
            if svd.singular_values[least] > ZERO * svd.singular_values.max() {
                return None;
            }
            let combination = svd.u?.column(least).into_owned();
            let most = combination.amax();
            let part = combination.iter().enumerate();
            let part = part.filter(|(_, value)| value.abs() > TAKES_PART * most);
            rows = Some(part.map(|(row, _)| row).collect());
        }
        rows
    }

    /// The Jacobian where the constraints hold, near the start; `None` if such a place is not found.
    fn at_a_place(
        &self,
        system: &System,
        declared: &[Vec<f64>],
        place: usize,
    ) -> Option<DMatrix<f64>> {
        let mut values = starts(system, declared);
        for (number, cell) in self.cells.iter().enumerate() {
            let turns = ((number + 1) * (2 * place + 1)) as f64 * 0.618_033_988_749_895;
            *values.entry(*cell).or_insert(0.0) += MOVED * (2.0 * turns.fract() - 1.0);
        }
        for _ in 0..MAX_STEPS {
            let residual = self.residual(system, declared, &values)?;
            let jacobian = self.jacobian(system, declared, &values)?;
            let size = self
                .cells
                .iter()
                .map(|cell| values[cell].abs())
                .fold(1.0, f64::max);
            if residual.amax() <= HOLDS * size {
                return Some(jacobian);
            }
            let damping = residual.norm_squared().min(1.0) * jacobian.norm_squared() * 1e-3;
            let mut normal = &jacobian * jacobian.transpose();
            for row in 0..normal.nrows() {
                normal[(row, row)] += damping.max(1e-15 * jacobian.norm_squared());
            }
            let step = jacobian.transpose() * normal.cholesky()?.solve(&residual);
            for (cell, step) in self.cells.iter().zip(step.iter()) {
                *values.get_mut(cell)? -= step;
            }
        }
        None
    }

    fn residual(
        &self,
        system: &System,
        declared: &[Vec<f64>],
        values: &BTreeMap<Cell, f64>,
    ) -> Option<DVector<f64>> {
        let list: Option<Vec<f64>> = self
            .residuals
            .iter()
            .map(|&id| {
                system
                    .value_at(declared, values, id)
                    .filter(|value| value.is_finite())
            })
            .collect();
        Some(DVector::from_vec(list?))
    }

    fn jacobian(
        &self,
        system: &System,
        declared: &[Vec<f64>],
        values: &BTreeMap<Cell, f64>,
    ) -> Option<DMatrix<f64>> {
        let mut found = DMatrix::zeros(self.equations.len(), self.cells.len());
        for &(row, column, id) in &self.entries {
            let value = system.value_at(declared, values, id)?;
            found[(row, column)] += value.is_finite().then_some(value)?;
        }
        Some(found)
    }
}

/// The start values of all scalars that have one of parameters alone.
fn starts(system: &System, declared: &[Vec<f64>]) -> BTreeMap<Cell, f64> {
    let given = system.starts.iter();
    let given = given.filter_map(|(&cell, list)| {
        let first = list
            .iter()
            .find(|(_, fixed, _)| *fixed)
            .or_else(|| list.first());
        Some((cell, first?.0))
    });
    let values = given.filter_map(|(cell, id)| Some((cell, system.value_with(declared, id)?)));
    values.collect()
}
