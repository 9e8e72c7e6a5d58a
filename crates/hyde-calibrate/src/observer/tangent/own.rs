//! [`Own`]: forces by differences: evaluations of the model with other parameters where the plant is.

use super::{Direction, Forces};
use crate::observer::track::{Place, Track, Vectors};
use crate::plant::measured;
use hyde_program::{Function, Point, Program, SomeRows, Workspace, Wrt};
use nalgebra::DMatrix;

/// A change below this part of a residual is its rounding.
const ROUNDING: f64 = 1e-13;

/// Evaluations of the model with other parameters where the plant is.
pub(crate) struct Own<'p> {
    /// Where the plant is, with the parameters as they are.
    track: &'p Track<'p>,
    p: &'p [f64],
    room: Vectors,
    /// The equations that some direction changes.
    pub(crate) touched: Vec<usize>,
    /// Their residuals.
    residual: Rows<'p>,
    /// What the channels show.
    measured: Rows<'p>,
    /// Whether some direction changes what is measured.
    pub(crate) shown: bool,
    directions: &'p [Direction],
    workspace: Workspace,
}

impl<'p> Own<'p> {
    /// Those of a program along a track that is its own or serves it; `p` are its parameters there.
    pub(crate) fn new(
        program: &'p Program,
        (track, p): (&'p Track<'p>, &'p [f64]),
        directions: &'p [Direction],
    ) -> Self {
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
        let residual = program.kernels.some_rows(Function::Residual, &touched);
        let channels = program.experiment.measured.len();
        Self {
            track,
            p,
            room: Vectors::default(),
            residual: Rows::new(residual, touched.len()),
            measured: Rows::new(measured(program), channels),
            shown: !rows(Function::Outputs).is_empty(),
            directions,
            workspace: Workspace::new(program.n_work),
            touched,
        }
    }
}

impl Forces for Own<'_> {
    fn count(&self) -> usize {
        self.directions.len()
    }

    fn touched(&self) -> &[usize] {
        &self.touched
    }

    fn shown(&self) -> bool {
        self.shown
    }

    fn forces(&mut self, place: Place<'_>, out: &mut DMatrix<f64>) {
        let at = self.track.point(place, self.p, &mut self.room);
        let workspace = &mut self.workspace;
        self.residual
            .changes(at, self.directions, workspace, ROUNDING, out);
    }

    fn seen(&mut self, place: Place<'_>, out: &mut DMatrix<f64>) {
        let at = self.track.point(place, self.p, &mut self.room);
        let workspace = &mut self.workspace;
        self.measured
            .changes(at, self.directions, workspace, 0.0, out);
    }
}

/// Some rows of a function, with room for their values.
struct Rows<'p> {
    rows: Box<dyn SomeRows + 'p>,
    plain: Vec<f64>,
    with: Vec<f64>,
}

impl<'p> Rows<'p> {
    fn new(rows: Box<dyn SomeRows + 'p>, count: usize) -> Self {
        Self {
            rows,
            plain: vec![0.0; count],
            with: vec![0.0; count],
        }
    }

    /// What a unit of each direction adds; nothing where that is a smaller part of a value than `rounding`.
    fn changes(
        &mut self,
        at: Point<'_>,
        directions: &[Direction],
        workspace: &mut Workspace,
        rounding: f64,
        out: &mut DMatrix<f64>,
    ) {
        self.rows.evaluate(at, workspace, &mut self.plain);
        for (number, direction) in directions.iter().enumerate() {
            let p = &direction.p;
            self.rows
                .evaluate(Point { p, ..at }, workspace, &mut self.with);
            for (row, (with, plain)) in self.with.iter().zip(&self.plain).enumerate() {
                let change = with - plain;
                out[(row, number)] = if change.abs() <= rounding * plain.abs() {
                    0.0
                } else {
                    change / direction.step
                };
            }
        }
    }
}
