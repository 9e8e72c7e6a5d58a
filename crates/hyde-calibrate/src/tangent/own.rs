//! [`Own`]: evaluations of the model with other parameters where the plant is.

use super::Direction;
use crate::observer::measured;
use hyde_program::{Function, Point, Program, SomeRows, Workspace, Wrt};
use nalgebra::DMatrix;

/// Evaluations of the model with other parameters where the plant is.
pub(crate) struct Own<'p> {
    /// The equations that some direction changes.
    pub(crate) touched: Vec<usize>,
    /// Their residuals.
    residual: Box<dyn SomeRows + 'p>,
    /// What the channels show.
    measured: Box<dyn SomeRows + 'p>,
    /// Whether some direction changes what is measured.
    pub(crate) shown: bool,
    workspace: Workspace,
    /// What the channels show without a change.
    values: Vec<f64>,
    others: Vec<f64>,
    force: Vec<f64>,
    plain: Vec<f64>,
}

impl<'p> Own<'p> {
    pub(crate) fn new(program: &'p Program, p: &[f64], directions: &[Direction]) -> Self {
        let moved = |place: usize| {
            directions
                .iter()
                .any(|direction| direction.p[place].to_bits() != p[place].to_bits())
        };
        let rows = |function: Function| -> Vec<usize> {
            let entries = program.kernels.still_entries(function).into_iter();
            entries
                .filter(|entry| matches!(entry.wrt, Wrt::Parameter(place) if moved(place)))
                .map(|entry| entry.row)
                .collect()
        };
        let mut touched = rows(Function::Residual);
        touched.sort_unstable();
        touched.dedup();
        let channels = program.experiment.measured.len();
        Self {
            residual: program.kernels.some_rows(Function::Residual, &touched),
            measured: measured(program),
            shown: !rows(Function::Outputs).is_empty(),
            workspace: Workspace::new(program.n_work),
            values: vec![0.0; channels],
            others: vec![0.0; channels],
            force: vec![0.0; touched.len()],
            plain: vec![0.0; touched.len()],
            touched,
        }
    }

    /// What a unit of each size adds to what the channels show, where it does: a column a direction.
    pub(crate) fn seen(&mut self, at: Point<'_>, directions: &[Direction], out: &mut DMatrix<f64>) {
        self.measured
            .evaluate(at, &mut self.workspace, &mut self.values);
        for (number, direction) in directions.iter().enumerate() {
            let with = Point {
                p: &direction.p,
                ..at
            };
            self.measured
                .evaluate(with, &mut self.workspace, &mut self.others);
            for (channel, (with, plain)) in self.others.iter().zip(&self.values).enumerate() {
                out[(channel, number)] = (with - plain) / direction.step;
            }
        }
    }

    /// What a unit of each size adds to the residual of the equations that are touched: a column a direction.
    pub(crate) fn forces(
        &mut self,
        at: Point<'_>,
        directions: &[Direction],
        out: &mut DMatrix<f64>,
    ) {
        self.residual
            .evaluate(at, &mut self.workspace, &mut self.plain);
        for (number, direction) in directions.iter().enumerate() {
            let with = Point {
                p: &direction.p,
                ..at
            };
            self.residual
                .evaluate(with, &mut self.workspace, &mut self.force);
            for (row, (with, plain)) in self.force.iter().zip(&self.plain).enumerate() {
                let change = with - plain;
                // Below the rounding of the residual there is nothing.
                out[(row, number)] = if change.abs() <= 1e-13 * plain.abs() {
                    0.0
                } else {
                    change / direction.step
                };
            }
        }
    }
}
