//! Products of small dense matrices with vectors, column by column: what an observer does most.

use nalgebra::DMatrix;

/// Adds the product of a matrix and a vector to another vector.
pub(crate) fn add_product(matrix: &DMatrix<f64>, vector: &[f64], sum: &mut [f64]) {
    let rows = matrix.nrows();
    if rows == 0 {
        return;
    }
    let sum = &mut sum[..rows];
    // Four columns at a time: the sum is loaded and stored a quarter as often.
    let mut blocks = matrix.as_slice().chunks_exact(4 * rows);
    let mut factors = vector.chunks_exact(4);
    for (block, factors) in blocks.by_ref().zip(factors.by_ref()) {
        let (a, rest) = block.split_at(rows);
        let (b, rest) = rest.split_at(rows);
        let (c, d) = rest.split_at(rows);
        for i in 0..rows {
            sum[i] +=
                (factors[0] * a[i] + factors[1] * b[i]) + (factors[2] * c[i] + factors[3] * d[i]);
        }
    }
    let columns = blocks.remainder().chunks_exact(rows);
    for (column, &factor) in columns.zip(factors.remainder()) {
        for (out, &entry) in sum.iter_mut().zip(column) {
            *out += factor * entry;
        }
    }
}

/// The product of a matrix and a vector.
pub(crate) fn set_product(matrix: &DMatrix<f64>, vector: &[f64], product: &mut [f64]) {
    product.iter_mut().for_each(|value| *value = 0.0);
    add_product(matrix, vector, product);
}
