//! LU factorization of a small dense matrix, with scaled rows and partial pivoting.
//!
//! Golub and Van Loan, Matrix Computations, 4th edition, algorithm 3.4.1 (outer product form) and section 3.5.2 (rows
//! scaled first, since the equations of a model come in different units).

use crate::{Pattern, Singular};

/// The factors of a matrix `R A`, where `R` scales each row of `A` to a largest entry of 1. By columns.
#[derive(Clone, Debug)]
pub(crate) struct DenseFactors {
    n: usize,
    /// `L` below the diagonal, `U` above it, the reciprocals of the pivots on it.
    lu: Vec<f64>,
    /// The row that was exchanged with row `k` before step `k`.
    exchanges: Vec<usize>,
    row_scales: Vec<f64>,
    /// The largest column sum of `|R A|`.
    norm: f64,
}

impl DenseFactors {
    pub(crate) fn new(n: usize) -> Self {
        Self {
            n,
            lu: vec![0.0; n * n],
            exchanges: vec![0; n],
            row_scales: vec![1.0; n],
            norm: 0.0,
        }
    }

    /// Factors the matrix with these values in the order of the pattern.
    pub(crate) fn factor(&mut self, pattern: &Pattern, values: &[f64]) -> Result<(), Singular> {
        self.load(pattern, values);
        let n = self.n;
        for k in 0..n {
            let pivot_row = self.exchange_rows(k);
            self.exchanges[k] = pivot_row;
            let pivot = self.lu[k * n + k];
            if pivot == 0.0 || !pivot.is_finite() {
                return Err(Singular { unknown: k });
            }
            let (left, right) = self.lu.split_at_mut((k + 1) * n);
            let column = &mut left[k * n..];
            let reciprocal = 1.0 / pivot;
            column[k] = reciprocal;
            for entry in &mut column[k + 1..] {
                *entry *= reciprocal;
            }
            for other in right.chunks_exact_mut(n) {
                let factor = other[k];
                for (entry, multiplier) in other[k + 1..].iter_mut().zip(&column[k + 1..]) {
                    *entry -= factor * multiplier;
                }
            }
        }
        Ok(())
    }

    /// Replaces `b` by `x` with `A x = b`.
    pub(crate) fn solve(&self, b: &mut [f64]) {
        for (entry, scale) in b.iter_mut().zip(&self.row_scales) {
            *entry *= scale;
        }
        self.solve_scaled(b);
    }

    /// 1 over the condition number of `R A` in the 1-norm, from all columns of the inverse.
    pub(crate) fn reciprocal_condition(&self) -> f64 {
        let mut inverse_norm = 0.0_f64;
        for k in 0..self.n {
            let mut column = vec![0.0; self.n];
            column[k] = 1.0;
            self.solve_scaled(&mut column);
            inverse_norm = inverse_norm.max(column.iter().map(|entry| entry.abs()).sum());
        }
        1.0 / (self.norm * inverse_norm)
    }

    fn load(&mut self, pattern: &Pattern, values: &[f64]) {
        self.row_scales.fill(0.0);
        for (row, _, entry) in pattern.entries() {
            self.row_scales[row] = self.row_scales[row].max(values[entry].abs());
        }
        for scale in &mut self.row_scales {
            *scale = if *scale > 0.0 { 1.0 / *scale } else { 1.0 };
        }
        self.lu.fill(0.0);
        for (row, column, entry) in pattern.entries() {
            self.lu[column * self.n + row] = values[entry] * self.row_scales[row];
        }
        let column_sums = self
            .lu
            .chunks_exact(self.n)
            .map(|column| column.iter().map(|entry| entry.abs()).sum());
        self.norm = column_sums.fold(0.0, f64::max);
    }

    /// Brings the largest entry of column `k`, from row `k` on, to row `k`, and says where it was.
    fn exchange_rows(&mut self, k: usize) -> usize {
        let n = self.n;
        let mut largest = k;
        for row in k + 1..n {
            if self.lu[k * n + row].abs() > self.lu[k * n + largest].abs() {
                largest = row;
            }
        }
        if largest != k {
            for column in self.lu.chunks_exact_mut(n) {
                column.swap(k, largest);
            }
        }
        largest
    }

    fn solve_scaled(&self, b: &mut [f64]) {
        for (k, &row) in self.exchanges.iter().enumerate() {
            b.swap(k, row);
        }
        for (k, column) in self.lu.chunks_exact(self.n).enumerate() {
            let solved = b[k];
            for (entry, multiplier) in b[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *entry -= solved * multiplier;
            }
        }
        for (k, column) in self.lu.chunks_exact(self.n).enumerate().rev() {
            let solved = b[k] * column[k];
            b[k] = solved;
            for (entry, multiplier) in b[..k].iter_mut().zip(&column[..k]) {
                *entry -= solved * multiplier;
            }
        }
    }
}
