//! [`Slopes`]: forces by derivatives, of many shapes of one effect: one evaluation a shape tells those of all its sizes. What the
//! effect brings along moves as its shapes say: each shape has a track of its own then, all of them along one route.

use super::Forces;
use crate::observer::track::{Place, Track, Vectors};
use hyde_program::{Function, PartialEntry, Program, SomeRows, Workspace, Wrt};
use nalgebra::DMatrix;
use std::collections::BTreeSet;

/// A shape of an effect.
pub(crate) struct Shape {
    /// The whole parameter vector where derivatives are taken.
    pub(crate) p: Vec<f64>,
    /// What a unit of each size changes of it: places and by how much.
    pub(crate) by_size: Vec<Vec<(usize, f64)>>,
}

/// Derivatives of the model by the sizes of some shapes where the plant is; a column a size of a shape, sizes behind each other.
pub(crate) struct Slopes<'p> {
    touched: Vec<usize>,
    residual: Chosen<'p>,
    measured: Chosen<'p>,
    shapes: &'p [Shape],
    /// Where the plant is with each.
    tracks: &'p [Track<'p>],
    workspace: Workspace,
    room: Vectors,
}

/// Some derivatives of a function by parameters.
struct Chosen<'p> {
    derivatives: Box<dyn SomeRows + 'p>,
    values: Vec<f64>,
    /// Of each shape, what its sizes make of the values.
    products: Vec<Vec<Product>>,
}

/// A product in the change by a size: a derivative by a parameter, and how much a unit of the size changes that.
struct Product {
    value: usize,
    /// The row and the column in which it is put.
    at: (usize, usize),
    change: f64,
}

impl<'p> Slopes<'p> {
    /// Those of shapes along a track each.
    pub(crate) fn new(program: &'p Program, shapes: &'p [Shape], tracks: &'p [Track<'p>]) -> Self {
        let moved = shapes
            .iter()
            .flat_map(|shape| shape.by_size.iter().flatten());
        let moved: BTreeSet<usize> = moved.map(|(place, _)| *place).collect();
        let rows = program.kernels.still_entries(Function::Residual);
        let rows = rows.iter().filter(|entry| by(entry, &moved).is_some());
        let touched: BTreeSet<usize> = rows.map(|entry| entry.row).collect();
        let touched: Vec<usize> = touched.into_iter().collect();
        let channels = program.experiment.measured.iter();
        let channels: Vec<usize> = channels.map(|measured| measured.output).collect();
        Self {
            residual: Chosen::new(program, (Function::Residual, &touched), &moved, shapes),
            measured: Chosen::new(program, (Function::Outputs, &channels), &moved, shapes),
            shapes,
            tracks,
            workspace: Workspace::new(program.n_work),
            room: Vectors::default(),
            touched,
        }
    }
}

impl Forces for Slopes<'_> {
    fn count(&self) -> usize {
        self.shapes.iter().map(|shape| shape.by_size.len()).sum()
    }

    fn touched(&self) -> &[usize] {
        &self.touched
    }

    fn shown(&self) -> bool {
        !self.measured.values.is_empty()
    }

    fn forces(&mut self, place: Place<'_>, out: &mut DMatrix<f64>) {
        let room = (&mut self.room, &mut self.workspace);
        let shapes = self.shapes.iter().zip(self.tracks);
        self.residual.put(place, shapes, room, out);
    }

    fn seen(&mut self, place: Place<'_>, out: &mut DMatrix<f64>) {
        let room = (&mut self.room, &mut self.workspace);
        let shapes = self.shapes.iter().zip(self.tracks);
        self.measured.put(place, shapes, room, out);
    }
}

impl<'p> Chosen<'p> {
    /// Those of some rows of a function by what is moved.
    fn new(
        program: &'p Program,
        (function, rows): (Function, &[usize]),
        moved: &BTreeSet<usize>,
        shapes: &[Shape],
    ) -> Self {
        let entries = program.kernels.still_entries(function);
        // The number of each, the row in which it is put, and the place of the parameter it is by.
        let (mut numbers, mut places) = (Vec::new(), Vec::new());
        for (number, entry) in entries.iter().enumerate() {
            let Some(place) = by(entry, moved) else {
                continue;
            };
            let each = rows.iter().enumerate();
            for (row, _) in each.filter(|(_, row)| **row == entry.row) {
                numbers.push(number);
                places.push((row, place));
            }
        }
        let mut columns = 0..;
        let mut products_of = |shape: &Shape| {
            let mut products = Vec::new();
            for (size, column) in shape.by_size.iter().zip(&mut columns) {
                for (value, (row, place)) in places.iter().enumerate() {
                    let changes = size.iter().filter(|(own, _)| own == place);
                    products.extend(changes.map(|&(_, change)| Product {
                        value,
                        at: (*row, column),
                        change,
                    }));
                }
            }
            products
        };
        Self {
            derivatives: program.kernels.some_still_partials(function, &numbers),
            values: vec![0.0; places.len()],
            products: shapes.iter().map(&mut products_of).collect(),
        }
    }

    /// What a unit of each size of each shape changes of the rows: a column a size.
    fn put<'s>(
        &mut self,
        place: Place<'_>,
        shapes: impl Iterator<Item = (&'s Shape, &'s Track<'s>)>,
        (room, workspace): (&mut Vectors, &mut Workspace),
        out: &mut DMatrix<f64>,
    ) {
        out.fill(0.0);
        for ((shape, track), products) in shapes.zip(&self.products) {
            let at = track.point(place, &shape.p, room);
            self.derivatives.evaluate(at, workspace, &mut self.values);
            for product in products {
                out[product.at] += self.values[product.value] * product.change;
            }
        }
    }
}

/// The parameter that a derivative is by, if it is one of those that are moved.
fn by(entry: &PartialEntry, moved: &BTreeSet<usize>) -> Option<usize> {
    let Wrt::Parameter(place) = entry.wrt else {
        return None;
    };
    moved.contains(&place).then_some(place)
}
