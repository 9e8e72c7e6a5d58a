//! [`Products`]: changes of innovations with the derivatives by the parameters, with the innovations, and with each other,
//! summed row by row: all that a score needs of them. The changes themselves are not kept.

use super::projection::dot;
use nalgebra::{Cholesky, DMatrix, DMatrixView, DVector};
use std::ops::Range;

/// Numerics: rows summed at once.
const BLOCK: usize = 32;
/// Numerics: parts with sizes of their own, in s.
const PART_S: f64 = 0.25;

/// Sums over all records of products with the changes by each size of some shapes.
pub(crate) struct Products {
    /// Sizes of a shape: its columns lie behind each other.
    pub(crate) sizes: usize,
    /// A column each: its products with every derivative, and with the innovations.
    pub(crate) with_record: DMatrix<f64>,
    /// Of each shape, the products of its columns.
    pub(crate) with_each_other: Vec<DMatrix<f64>>,
    /// Of each shape, what parts of a second gain on their own; and how many there were.
    apart: Vec<f64>,
    parts: Vec<usize>,
}

impl Products {
    /// Nothing yet of some shapes.
    pub(crate) fn new(derivatives: usize, shapes: usize, sizes: usize) -> Self {
        Self {
            sizes,
            with_record: DMatrix::zeros(derivatives + 1, shapes * sizes),
            with_each_other: vec![DMatrix::zeros(sizes, sizes); shapes],
            apart: vec![0.0; shapes],
            parts: vec![0; shapes],
        }
    }

    /// What a shape would gain if each part of a second had sizes of its own, parameters standing still, less what chance
    /// makes of as many parts: of a sum of squares of normal numbers that is their number.
    pub(crate) fn apart(&self, shape: usize) -> f64 {
        let freedoms = (self.parts[shape] * self.sizes) as f64;
        self.apart[shape] - freedoms
    }

    /// Adds the rows of a record as they come, of some of the shapes: see [`Adding`].
    pub(crate) fn adding<'p>(
        &'p mut self,
        shapes: Range<usize>,
        record: &'p DMatrix<f64>,
        channels: usize,
        step_s: f64,
    ) -> Adding<'p> {
        let block = DMatrix::zeros(BLOCK * channels, shapes.len() * self.sizes);
        let part = Part::new(shapes.len(), self.sizes);
        Adding {
            products: self,
            shapes,
            part,
            blocks_of_a_part: ((PART_S / step_s / BLOCK as f64).round() as usize).max(1),
            record,
            channels,
            block,
            first: 0,
            filled: 0,
        }
    }
}

/// Sums over a part of a second.
struct Part {
    blocks: usize,
    with_innovations: Vec<DVector<f64>>,
    with_each_other: Vec<DMatrix<f64>>,
}

impl Part {
    fn new(shapes: usize, sizes: usize) -> Self {
        Self {
            blocks: 0,
            with_innovations: vec![DVector::zeros(sizes); shapes],
            with_each_other: vec![DMatrix::zeros(sizes, sizes); shapes],
        }
    }

    /// What a shape gains in this part alone.
    fn gain(&self, shape: usize) -> f64 {
        let (b, m) = (&self.with_innovations[shape], &self.with_each_other[shape]);
        let rounding = DMatrix::identity(m.nrows(), m.nrows()) * (1e-6 * m.trace() + 1e-300);
        let factor = Cholesky::new(m + rounding);
        factor.map_or(0.0, |factor| b.dot(&factor.solve(b)))
    }
}

/// Rows of a record on their way into sums.
pub(crate) struct Adding<'p> {
    products: &'p mut Products,
    shapes: Range<usize>,
    part: Part,
    blocks_of_a_part: usize,
    record: &'p DMatrix<f64>,
    channels: usize,
    block: DMatrix<f64>,
    first: usize,
    filled: usize,
}

impl Adding<'_> {
    /// Adds a row of the record: the changes of each channel, a column a direction.
    pub(crate) fn row(&mut self, changes: DMatrixView<'_, f64>) {
        let columns = self
            .block
            .as_mut_slice()
            .chunks_exact_mut(BLOCK * self.channels);
        for (into, changes) in columns.zip(changes.column_iter()) {
            into[self.filled..self.filled + self.channels].copy_from_slice(changes.as_slice());
        }
        self.filled += self.channels;
        if self.filled == self.block.nrows() {
            self.sum();
        }
    }

    /// Sums what is left.
    pub(crate) fn end(mut self) {
        self.sum();
        self.end_part();
    }

    fn end_part(&mut self) {
        for (number, shape) in self.shapes.clone().enumerate() {
            self.products.apart[shape] += self.part.gain(number);
            self.products.parts[shape] += 1;
        }
        self.part = Part::new(self.shapes.len(), self.products.sizes);
    }

    fn sum(&mut self) {
        let rows = self.block.rows(0, self.filled);
        let own = self.record.columns(self.first, self.filled);
        let sizes = self.products.sizes;
        let (first, count) = (self.shapes.start * sizes, self.shapes.len() * sizes);
        let mut with_record = self.products.with_record.columns_mut(first, count);
        with_record.gemm(1.0, &own, &rows, 1.0);
        let innovations = own.row(own.nrows() - 1).transpose();
        let stride = self.block.nrows();
        let values = self.block.as_slice();
        let column = |number: usize| &values[number * stride..number * stride + self.filled];
        let with_each_other = &mut self.products.with_each_other[self.shapes.clone()];
        for (shape, products) in with_each_other.iter_mut().enumerate() {
            for i in 0..sizes {
                for j in 0..=i {
                    let product = dot(column(shape * sizes + i), column(shape * sizes + j));
                    let part = &mut self.part.with_each_other[shape];
                    for sum in [&mut *products, part] {
                        sum[(i, j)] += product;
                        if i != j {
                            sum[(j, i)] += product;
                        }
                    }
                }
                self.part.with_innovations[shape][i] +=
                    dot(column(shape * sizes + i), innovations.as_slice());
            }
        }
        self.first += self.filled;
        self.filled = 0;
        self.part.blocks += 1;
        if self.part.blocks == self.blocks_of_a_part {
            self.end_part();
        }
    }
}
