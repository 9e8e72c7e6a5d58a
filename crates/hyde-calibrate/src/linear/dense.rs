//! Products of small dense matrices with vectors, column by column: what an observer does most. In registers as wide as the
//! processor has them.

use nalgebra::DMatrix;
use pulp::{Arch, Simd, WithSimd};
use std::iter::Zip;
use std::slice::{ChunksExact, ChunksExactMut};
use std::sync::LazyLock;

/// What the processor has.
static ARCH: LazyLock<Arch> = LazyLock::new(Arch::new);

/// Adds the product of a matrix and a vector to another vector.
pub(crate) fn add_product(matrix: &DMatrix<f64>, vector: &[f64], sum: &mut [f64]) {
    assert_eq!(matrix.ncols(), vector.len(), "a factor a column");
    let rows = matrix.nrows();
    if rows > 0 {
        ARCH.dispatch(AddProduct {
            matrix: matrix.as_slice(),
            vector,
            sum: &mut sum[..rows],
        });
    }
}

/// The product of a matrix and a vector.
pub(crate) fn set_product(matrix: &DMatrix<f64>, vector: &[f64], product: &mut [f64]) {
    product.iter_mut().for_each(|value| *value = 0.0);
    add_product(matrix, vector, product);
}

/// Vectors that are multiplied at once: two or more registers full on any processor.
pub(crate) const SIDE_BY_SIDE: usize = 8;

/// The products of a matrix and of so many vectors, one or [`SIDE_BY_SIDE`]; their first entries stand side by side, then
/// their second ones, and so on.
pub(crate) fn set_products<const N: usize>(
    matrix: &DMatrix<f64>,
    vectors: &[f64],
    products: &mut [f64],
) {
    if N == 1 {
        set_product(matrix, vectors, products);
        return;
    }
    assert_eq!(N * matrix.ncols(), vectors.len(), "factors a column");
    assert_eq!(N * matrix.nrows(), products.len(), "products a row");
    ARCH.dispatch(SetProducts::<N> {
        matrix: matrix.as_slice(),
        rows: matrix.nrows(),
        vectors,
        products,
    });
}

/// Adds to the head `x` of each column what products of thin matrices make of it and of a column `g` of `given`:
/// `u (v' x + w g)`.
pub(crate) fn add_low_rank(
    u: &DMatrix<f64>,
    [v, w]: [&DMatrix<f64>; 2],
    given: &DMatrix<f64>,
    columns: &mut DMatrix<f64>,
) {
    let ((rows, rank), height) = (u.shape(), columns.nrows());
    assert_eq!(v.shape(), (rows, rank), "as many rows and columns");
    assert_eq!(w.shape(), (rank, given.nrows()), "a factor each given");
    assert_eq!(given.ncols(), columns.ncols(), "something given a column");
    assert!(rows <= height, "a head is no longer than its column");
    if rows > 0 && rank > 0 {
        ARCH.dispatch(AddLowRank {
            u: u.as_slice(),
            v: v.as_slice(),
            w: w.as_slice(),
            rows,
            given: given.as_slice(),
            givens: given.nrows(),
            asked: &mut vec![0.0; rank],
            columns: columns.as_mut_slice().chunks_exact_mut(height),
        });
    }
}

/// Adds to the head of each column what products of thin matrices make of the head of a column of others: `u v' x`.
pub(crate) fn add_low_rank_across(
    [u, v]: [&DMatrix<f64>; 2],
    others: &DMatrix<f64>,
    columns: &mut DMatrix<f64>,
) {
    assert_eq!(u.ncols(), v.ncols(), "as many products");
    assert_eq!(others.ncols(), columns.ncols(), "another a column");
    assert!(v.nrows() <= others.nrows() && u.nrows() <= columns.nrows());
    if !u.is_empty() && !v.is_empty() {
        let (from, to) = (others.nrows(), columns.nrows());
        ARCH.dispatch(AddLowRankAcross {
            pairs: u
                .as_slice()
                .chunks_exact(u.nrows())
                .zip(v.as_slice().chunks_exact(v.nrows())),
            others: others.as_slice().chunks_exact(from),
            columns: columns.as_mut_slice().chunks_exact_mut(to),
        });
    }
}

/// See [`add_low_rank_across`].
struct AddLowRankAcross<'a> {
    pairs: Zip<ChunksExact<'a, f64>, ChunksExact<'a, f64>>,
    others: ChunksExact<'a, f64>,
    columns: ChunksExactMut<'a, f64>,
}

impl WithSimd for AddLowRankAcross<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (other, column) in self.others.zip(self.columns) {
            for (u, v) in self.pairs.clone() {
                let asked = add_dot(simd, 0.0, &other[..v.len()], v);
                add_times(simd, asked, u, &mut column[..u.len()]);
            }
        }
    }
}

/// See [`add_low_rank`].
struct AddLowRank<'a> {
    u: &'a [f64],
    v: &'a [f64],
    w: &'a [f64],
    rows: usize,
    given: &'a [f64],
    givens: usize,
    /// Room for what is asked of a column.
    asked: &'a mut [f64],
    columns: ChunksExactMut<'a, f64>,
}

impl WithSimd for AddLowRank<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        for (number, column) in self.columns.enumerate() {
            let given = &self.given[number * self.givens..][..self.givens];
            self.asked.fill(0.0);
            for (given, w) in given.iter().zip(self.w.chunks_exact(self.asked.len())) {
                let each = self.asked.iter_mut().zip(w);
                each.for_each(|(asked, w)| *asked += w * given);
            }
            let head = &mut column[..self.rows];
            for (asked, v) in self.asked.iter_mut().zip(self.v.chunks_exact(self.rows)) {
                *asked = add_dot(simd, *asked, head, v);
            }
            for (&asked, u) in self.asked.iter().zip(self.u.chunks_exact(self.rows)) {
                add_times(simd, asked, u, head);
            }
        }
    }
}

/// A sum and the product of two vectors on top of it.
#[inline(always)]
fn add_dot<S: Simd>(simd: S, sum: f64, x: &[f64], v: &[f64]) -> f64 {
    let (x, x_rest) = S::as_simd_f64s(x);
    let (v, v_rest) = S::as_simd_f64s(v);
    let mut wide = simd.splat_f64s(0.0);
    for (&x, &v) in x.iter().zip(v) {
        wide = simd.mul_add_e_f64s(x, v, wide);
    }
    let mut sum = sum + simd.reduce_sum_f64s(wide);
    for (x, v) in x_rest.iter().zip(v_rest) {
        sum += x * v;
    }
    sum
}

/// Adds a number times a vector to another.
#[inline(always)]
fn add_times<S: Simd>(simd: S, times: f64, u: &[f64], out: &mut [f64]) {
    let (out, out_rest) = S::as_mut_simd_f64s(out);
    let (u, u_rest) = S::as_simd_f64s(u);
    let wide = simd.splat_f64s(times);
    for (out, &u) in out.iter_mut().zip(u) {
        *out = simd.mul_add_e_f64s(wide, u, *out);
    }
    for (out, &u) in out_rest.iter_mut().zip(u_rest) {
        *out += times * u;
    }
}

/// A matrix, column behind column, times vectors that stand side by side.
struct SetProducts<'a, const N: usize> {
    matrix: &'a [f64],
    rows: usize,
    vectors: &'a [f64],
    products: &'a mut [f64],
}

impl<const N: usize> WithSimd for SetProducts<'_, N> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let mut row = 0;
        // Four rows at a time: their sums stay in registers.
        let mut blocks = self.products.chunks_exact_mut(4 * N);
        for block in blocks.by_ref() {
            let mut sums = [[simd.splat_f64s(0.0); N]; 4];
            for (column, vector) in self.vectors.chunks_exact(N).enumerate() {
                let entries = &self.matrix[column * self.rows + row..][..4];
                let (wide, _) = S::as_simd_f64s(vector);
                for (sums, &entry) in sums.iter_mut().zip(entries) {
                    let entry = simd.splat_f64s(entry);
                    for (sum, &value) in sums.iter_mut().zip(wide) {
                        *sum = simd.mul_add_e_f64s(entry, value, *sum);
                    }
                }
            }
            for (out, sums) in block.chunks_exact_mut(N).zip(sums) {
                let (wide, _) = S::as_mut_simd_f64s(out);
                wide.iter_mut().zip(sums).for_each(|(out, sum)| *out = sum);
            }
            row += 4;
        }
        for out in blocks.into_remainder().chunks_exact_mut(N) {
            let (wide, _) = S::as_mut_simd_f64s(out);
            wide.fill(simd.splat_f64s(0.0));
            for (column, vector) in self.vectors.chunks_exact(N).enumerate() {
                let entry = simd.splat_f64s(self.matrix[column * self.rows + row]);
                let (values, _) = S::as_simd_f64s(vector);
                for (out, &value) in wide.iter_mut().zip(values) {
                    *out = simd.mul_add_e_f64s(entry, value, *out);
                }
            }
            row += 1;
        }
    }
}

/// A matrix, column behind column, times a vector, added to a sum as long as a column.
struct AddProduct<'a> {
    matrix: &'a [f64],
    vector: &'a [f64],
    sum: &'a mut [f64],
}

impl WithSimd for AddProduct<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let rows = self.sum.len();
        let (sum, sum_rest) = S::as_mut_simd_f64s(self.sum);
        // Four columns at a time: the sum is loaded and stored a quarter as often.
        let mut blocks = self.matrix.chunks_exact(4 * rows);
        let mut factors = self.vector.chunks_exact(4);
        for (block, factors) in blocks.by_ref().zip(factors.by_ref()) {
            let (a, b) = block.split_at(rows);
            let (b, c) = b.split_at(rows);
            let (c, d) = c.split_at(rows);
            let (a, a_rest) = S::as_simd_f64s(a);
            let (b, b_rest) = S::as_simd_f64s(b);
            let (c, c_rest) = S::as_simd_f64s(c);
            let (d, d_rest) = S::as_simd_f64s(d);
            // A closure would be compiled for what any processor has.
            let (fa, fb) = (simd.splat_f64s(factors[0]), simd.splat_f64s(factors[1]));
            let (fc, fd) = (simd.splat_f64s(factors[2]), simd.splat_f64s(factors[3]));
            let columns = a.iter().zip(b).zip(c).zip(d);
            for (out, (((&a, &b), &c), &d)) in sum.iter_mut().zip(columns) {
                let first = simd.mul_add_e_f64s(fa, a, *out);
                let second = simd.mul_add_e_f64s(fc, c, simd.mul_f64s(fb, b));
                *out = simd.add_f64s(first, simd.mul_add_e_f64s(fd, d, second));
            }
            let columns = a_rest.iter().zip(b_rest).zip(c_rest).zip(d_rest);
            for (out, (((a, b), c), d)) in sum_rest.iter_mut().zip(columns) {
                *out += (factors[0] * a + factors[1] * b) + (factors[2] * c + factors[3] * d);
            }
        }
        let columns = blocks.remainder().chunks_exact(rows);
        for (column, &factor) in columns.zip(factors.remainder()) {
            let (column, column_rest) = S::as_simd_f64s(column);
            let wide = simd.splat_f64s(factor);
            for (out, &entry) in sum.iter_mut().zip(column) {
                *out = simd.mul_add_e_f64s(wide, entry, *out);
            }
            for (out, &entry) in sum_rest.iter_mut().zip(column_rest) {
                *out += factor * entry;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;

    #[test]
    fn products_of_all_widths_are_those_of_linear_algebra() {
        for rows in 1..20 {
            for columns in 0..10 {
                let matrix = DMatrix::from_fn(rows, columns, |i, j| (i * 7 + j) as f64 - 11.0);
                let vector = DVector::from_fn(columns, |j, _| j as f64 - 3.0);
                let mut product = vec![1.0; rows];
                add_product(&matrix, vector.as_slice(), &mut product);
                let known = (&matrix * vector).add_scalar(1.0);
                assert_eq!(product, known.as_slice(), "{rows} x {columns}");
            }
        }
    }

    #[test]
    fn heads_of_columns_get_what_thin_matrices_make_of_them() {
        for rows in 1..20 {
            for rank in 1..4 {
                let u = DMatrix::from_fn(rows, rank, |i, k| (i + 2 * k) as f64 - 4.0);
                let v = DMatrix::from_fn(rows, rank, |i, k| (3 * i + k) as f64 - 5.0);
                let w = DMatrix::from_fn(rank, 2, |k, g| (k + 3 * g) as f64 - 1.0);
                let given = DMatrix::from_fn(2, 3, |g, j| (g + j) as f64);
                let mut columns = DMatrix::from_fn(rows + 2, 3, |i, j| (i * 5 + j) as f64 - 7.0);
                let mut known = columns.clone();
                let asked = v.tr_mul(&columns.rows(0, rows)) + &w * &given;
                known.rows_mut(0, rows).gemm(1.0, &u, &asked, 1.0);
                add_low_rank(&u, [&v, &w], &given, &mut columns);
                assert_eq!(columns, known, "{rows} x {rank}");
            }
        }
    }

    #[test]
    fn heads_of_columns_get_what_thin_matrices_make_of_others() {
        for rows in 1..20 {
            for rank in 1..4 {
                let u = DMatrix::from_fn(rows, rank, |i, k| (i + 2 * k) as f64 - 4.0);
                let v = DMatrix::from_fn(rows + 3, rank, |i, k| (3 * i + k) as f64 - 5.0);
                let others = DMatrix::from_fn(rows + 4, 3, |i, j| (i + j) as f64 - 2.0);
                let mut columns = DMatrix::from_fn(rows + 2, 3, |i, j| (i * 5 + j) as f64 - 7.0);
                let mut known = columns.clone();
                let asked = v.tr_mul(&others.rows(0, rows + 3));
                known.rows_mut(0, rows).gemm(1.0, &u, &asked, 1.0);
                add_low_rank_across([&u, &v], &others, &mut columns);
                assert_eq!(columns, known, "{rows} x {rank}");
            }
        }
    }

    #[test]
    fn vectors_side_by_side_are_multiplied_as_each_is() {
        const N: usize = SIDE_BY_SIDE;
        for rows in 1..20 {
            for columns in 0..10 {
                let matrix = DMatrix::from_fn(rows, columns, |i, j| (i * 7 + j) as f64 - 11.0);
                let vectors = DMatrix::from_fn(N, columns, |n, j| (3 * n + j) as f64 - 5.0);
                let mut products = vec![1.0; rows * N];
                set_products::<N>(&matrix, vectors.as_slice(), &mut products);
                let known = &vectors * matrix.transpose();
                assert_eq!(products, known.as_slice(), "{rows} x {columns}");
            }
        }
    }
}
