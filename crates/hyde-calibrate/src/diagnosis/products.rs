//! [`Products`]: changes of innovations with the derivatives by the parameters, with the innovations, and with each other,
//! summed row by row: all that a score needs of them. The changes themselves are not kept.

use super::projection::dot;
use nalgebra::DMatrix;

/// Rows summed at once.
const BLOCK: usize = 32;

/// Sums over all records of products with the changes by each size of some shapes.
pub(crate) struct Products {
    /// Sizes of a shape: its columns lie behind each other.
    pub(crate) sizes: usize,
    /// A column each: its products with every derivative, and with the innovations.
    pub(crate) with_record: DMatrix<f64>,
    /// Of each shape, the products of its columns.
    pub(crate) with_each_other: Vec<DMatrix<f64>>,
}

impl Products {
    /// Nothing yet of some shapes.
    pub(crate) fn new(derivatives: usize, shapes: usize, sizes: usize) -> Self {
        Self {
            sizes,
            with_record: DMatrix::zeros(derivatives + 1, shapes * sizes),
            with_each_other: vec![DMatrix::zeros(sizes, sizes); shapes],
        }
    }

    /// Adds the rows of a record as they come: see [`Adding`].
    pub(crate) fn adding<'p>(
        &'p mut self,
        record: &'p DMatrix<f64>,
        channels: usize,
    ) -> Adding<'p> {
        let block = DMatrix::zeros(BLOCK * channels, self.with_record.ncols());
        Adding {
            products: self,
            record,
            channels,
            block,
            first: 0,
            filled: 0,
        }
    }
}

/// Rows of a record on their way into sums.
pub(crate) struct Adding<'p> {
    products: &'p mut Products,
    record: &'p DMatrix<f64>,
    channels: usize,
    block: DMatrix<f64>,
    first: usize,
    filled: usize,
}

impl Adding<'_> {
    /// Adds a row: the changes of each channel, a column a direction.
    pub(crate) fn row(&mut self, changes: &DMatrix<f64>) {
        self.block
            .rows_mut(self.filled, self.channels)
            .copy_from(changes);
        self.filled += self.channels;
        if self.filled == self.block.nrows() {
            self.sum();
        }
    }

    /// Sums what is left.
    pub(crate) fn end(mut self) {
        self.sum();
    }

    fn sum(&mut self) {
        let rows = self.block.rows(0, self.filled);
        let own = self.record.columns(self.first, self.filled);
        self.products.with_record.gemm(1.0, &own, &rows, 1.0);
        let (sizes, stride) = (self.products.sizes, self.block.nrows());
        let values = self.block.as_slice();
        let column = |number: usize| &values[number * stride..number * stride + self.filled];
        for (shape, products) in self.products.with_each_other.iter_mut().enumerate() {
            for i in 0..sizes {
                for j in 0..=i {
                    let product = dot(column(shape * sizes + i), column(shape * sizes + j));
                    products[(i, j)] += product;
                    if i != j {
                        products[(j, i)] += product;
                    }
                }
            }
        }
        self.first += self.filled;
        self.filled = 0;
    }
}
