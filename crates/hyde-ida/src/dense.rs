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

    /// Replaces `b` by the solution of a scaled system. Systems of a few unknowns have loops of a length that the compiler
    /// knows, with the same operations in the same order.
    fn solve_scaled(&self, b: &mut [f64]) {
        let solved = match self.n {
            1 => self.solve_few::<1>(b),
            2 => self.solve_few::<2>(b),
            3 => self.solve_few::<3>(b),
            4 => self.solve_few::<4>(b),
            5 => self.solve_few::<5>(b),
            6 => self.solve_few::<6>(b),
            7 => self.solve_few::<7>(b),
            8 => self.solve_few::<8>(b),
            _ => None,
        };
        if solved.is_none() {
            self.solve_any(b);
        }
    }

    /// The same for `N` unknowns; `None` if there are others.
    fn solve_few<const N: usize>(&self, b: &mut [f64]) -> Option<()> {
        let columns: &[[f64; N]; N] = self.lu.as_chunks::<N>().0.try_into().ok()?;
        let exchanges: &[usize; N] = self.exchanges.as_slice().try_into().ok()?;
        let b: &mut [f64; N] = b.try_into().ok()?;
        for (k, &row) in exchanges.iter().enumerate() {
            b.swap(k, row);
        }
        for (k, column) in columns.iter().enumerate() {
            for row in k + 1..N {
                b[row] -= b[k] * column[row];
            }
        }
        for (k, column) in columns.iter().enumerate().rev() {
            b[k] *= column[k];
            for row in 0..k {
                b[row] -= b[k] * column[row];
            }
        }
        Some(())
    }

    fn solve_any(&self, b: &mut [f64]) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_unknowns_are_solved_as_many_are() {
        for n in 1..=9 {
            let starts = (0..=n).map(|column| (column * n) as i64).collect();
            let rows = (0..n * n).map(|entry| (entry % n) as i64).collect();
            let pattern = Pattern::new(n, starts, rows).unwrap();
            let values: Vec<f64> = (0..n * n).map(|k| (1.0 + 3.7 * k as f64).sin()).collect();
            let mut factors = DenseFactors::new(n);
            factors.factor(&pattern, &values).unwrap();
            let right: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
            let (mut few, mut any) = (right.clone(), right);
            factors.solve_scaled(&mut few);
            factors.solve_any(&mut any);
            let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&few), bits(&any), "{n} unknowns");
        }
    }
}
