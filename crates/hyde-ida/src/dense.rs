//! LU factorization of a small dense matrix, with scaled rows and partial pivoting.
//!
//! Golub and Van Loan, Matrix Computations, 4th edition, algorithm 3.4.1 (outer product form) and section 3.5.2 (rows
//! scaled first, since the equations of a model come in different units).

use crate::{Pattern, Singular, with_few};

/// The factors of a matrix `R A`, where `R` scales each row of `A` to a largest entry of 1. By columns.
#[derive(Clone, Debug)]
pub(crate) struct DenseFactors {
    n: usize,
    /// Row of each entry of the pattern, and its place by columns.
    entries: Vec<(usize, usize)>,
    /// `L` below the diagonal, `U` above it, the reciprocals of the pivots on it.
    lu: Vec<f64>,
    /// The row of the matrix that each row of the factors comes from.
    order: Vec<usize>,
    /// The scale of each row of the matrix.
    row_scales: Vec<f64>,
    /// Room for a right side.
    right: Vec<f64>,
}

impl DenseFactors {
    pub(crate) fn new(pattern: &Pattern) -> Self {
        let n = pattern.n();
        let entries = pattern.entries();
        Self {
            n,
            entries: entries
                .map(|(row, column, _)| (row, column * n + row))
                .collect(),
            lu: vec![0.0; n * n],
            order: vec![0; n],
            row_scales: vec![1.0; n],
            right: vec![0.0; n],
        }
    }

    /// Factors the matrix with these values in the order of the pattern.
    pub(crate) fn factor(&mut self, values: &[f64]) -> Result<(), Singular> {
        self.load(values);
        let (lu, order) = (&mut self.lu, &mut self.order);
        with_few!(self.n, n in [1 2 3 4 5 6 7 8], eliminate(n, lu, order))
    }

    /// Replaces `b` by `x` with `A x = b`.
    pub(crate) fn solve(&mut self, b: &mut [f64]) {
        let Self {
            lu,
            order,
            row_scales,
            right,
            ..
        } = self;
        with_few!(self.n, n in [1 2 3 4 5 6 7 8], {
            let mut few = [0.0; 8];
            let right = few.get_mut(..n).unwrap_or(right);
            let (b, scales, order) = (&mut b[..n], &row_scales[..n], &order[..n]);
            for k in 0..n {
                right[k] = b[order[k]] * scales[order[k]];
            }
            substitute(n, lu, right);
            b.copy_from_slice(right);
        });
    }

    /// 1 over the condition number of `R A` with these values in the 1-norm, from all columns of the inverse; 0 if it has
    /// none.
    pub(crate) fn reciprocal_condition(&mut self, values: &[f64]) -> f64 {
        self.load(values);
        let sum = |column: &[f64]| column.iter().map(|entry| entry.abs()).sum();
        let norm: f64 = self.lu.chunks_exact(self.n).map(sum).fold(0.0, f64::max);
        if self.factor(values).is_err() {
            return 0.0;
        }
        let mut inverse_norm = 0.0_f64;
        for k in 0..self.n {
            let mut column = vec![0.0; self.n];
            column[k] = 1.0;
            // The rows' order does not matter: each unit vector has its turn.
            substitute(self.n, &self.lu, &mut column);
            inverse_norm = inverse_norm.max(sum(&column));
        }
        1.0 / (norm * inverse_norm)
    }

    fn load(&mut self, values: &[f64]) {
        self.row_scales.fill(0.0);
        for ((row, _), value) in self.entries.iter().zip(values) {
            self.row_scales[*row] = self.row_scales[*row].max(value.abs());
        }
        for scale in &mut self.row_scales {
            *scale = if *scale > 0.0 { 1.0 / *scale } else { 1.0 };
        }
        self.lu.fill(0.0);
        for ((row, place), value) in self.entries.iter().zip(values) {
            self.lu[*place] = value * self.row_scales[*row];
        }
    }
}

/// Replaces a matrix of `n` columns by its factors, and writes in which order they have its rows.
#[inline(always)]
fn eliminate(n: usize, lu: &mut [f64], order: &mut [usize]) -> Result<(), Singular> {
    let (lu, order) = (&mut lu[..n * n], &mut order[..n]);
    for (k, row) in order.iter_mut().enumerate() {
        *row = k;
    }
    for k in 0..n {
        order.swap(k, bring_largest(n, lu, k));
        let pivot = lu[k * n + k];
        if pivot == 0.0 || !pivot.is_finite() {
            return Err(Singular { unknown: k });
        }
        let (left, right) = lu.split_at_mut((k + 1) * n);
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

/// Brings the largest entry of column `k`, from row `k` on, to row `k`, and says where it was.
#[inline(always)]
fn bring_largest(n: usize, lu: &mut [f64], k: usize) -> usize {
    let mut largest = k;
    for row in k + 1..n {
        if lu[k * n + row].abs() > lu[k * n + largest].abs() {
            largest = row;
        }
    }
    if largest != k {
        for column in lu.chunks_exact_mut(n) {
            column.swap(k, largest);
        }
    }
    largest
}

/// Replaces `b`, in the order of the factors' rows, by the solution of a scaled system of `n` unknowns.
#[inline(always)]
fn substitute(n: usize, lu: &[f64], b: &mut [f64]) {
    let (lu, b) = (&lu[..n * n], &mut b[..n]);
    for (k, column) in lu.chunks_exact(n).enumerate() {
        let solved = b[k];
        for (entry, multiplier) in b[k + 1..].iter_mut().zip(&column[k + 1..]) {
            *entry -= solved * multiplier;
        }
    }
    for (k, column) in lu.chunks_exact(n).enumerate().rev() {
        let solved = b[k] * column[k];
        b[k] = solved;
        for (entry, multiplier) in b[..k].iter_mut().zip(&column[..k]) {
            *entry -= solved * multiplier;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::hint::black_box;

    #[test]
    fn few_unknowns_are_solved_as_many_are() {
        for n in 1..=9 {
            let starts = (0..=n).map(|column| (column * n) as i64).collect();
            let rows = (0..n * n).map(|entry| (entry % n) as i64).collect();
            let pattern = Pattern::new(n, starts, rows).unwrap();
            let values: Vec<f64> = (0..n * n).map(|k| (1.0 + 3.7 * k as f64).sin()).collect();
            let mut few = DenseFactors::new(&pattern);
            let mut any = few.clone();
            few.factor(&values).unwrap();
            any.load(&values);
            eliminate(black_box(n), &mut any.lu, &mut any.order).unwrap();
            let right: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
            let mut by_few = right.clone();
            few.solve(&mut by_few);
            let scaled = any
                .order
                .iter()
                .map(|&row| right[row] * any.row_scales[row]);
            let mut by_any: Vec<f64> = scaled.collect();
            substitute(black_box(n), &any.lu, &mut by_any);
            let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&by_few), bits(&by_any), "{n} unknowns");
        }
    }
}
