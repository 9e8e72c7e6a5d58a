//! LU factors with the pivots and the pattern of an earlier factorization by KLU: what is computed for every matrix after
//! the first one.
//!
//! KLU chose a block triangular form, an order within the blocks, and pivots. As long as they serve, the same few
//! multiplications in the same order factor the next matrix: column after column, each from the columns to the left that
//! its pattern reaches (J. R. Gilbert and T. Peierls, SIAM J. Sci. Stat. Comput. 9 (1988) 862, without the search). Indices
//! are 32 bits wide, pivots are kept as their reciprocals, and whether the entries have grown is seen on the way.
//!
//! ```text
//! P R A Q = block triangular;  L U = a diagonal block;  F = what is above the blocks
//! ```

use crate::Pattern;

/// Where a column of a sparse matrix begins, its rows and its values.
#[derive(Debug, Default)]
struct Columns {
    starts: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Columns {
    fn range(&self, column: usize) -> std::ops::Range<usize> {
        self.starts[column] as usize..self.starts[column + 1] as usize
    }
}

/// What KLU found, in its own numbers: rows and columns in the order of the pivots.
pub(crate) struct Extracted {
    /// L with its unit diagonal, U with its diagonal, and F: starts of columns and rows.
    pub(crate) lower: (Vec<i64>, Vec<i64>),
    pub(crate) upper: (Vec<i64>, Vec<i64>),
    pub(crate) above: (Vec<i64>, Vec<i64>),
    /// The row of the matrix that is at each place, the column, and the first place of each block.
    pub(crate) row_at: Vec<i64>,
    pub(crate) column_at: Vec<i64>,
    pub(crate) blocks: Vec<i64>,
    /// What each row is divided by, in the order of the pivots.
    pub(crate) scale: Vec<f64>,
}

/// The factors of a matrix.
#[derive(Debug)]
pub(crate) struct FixedPivots {
    lower: Columns,
    upper: Columns,
    above: Columns,
    /// 1 over the diagonal of U.
    pivots: Vec<f64>,
    /// For each entry of the matrix, in the order of the pivots' columns: its place in the values, and its row.
    sources: Vec<(u32, u32)>,
    source_starts: Vec<u32>,
    row_at: Vec<u32>,
    column_at: Vec<u32>,
    blocks: Vec<u32>,
    /// 1 over the scale of each row, in the order of the pivots.
    scale: Vec<f64>,
    column: Vec<f64>,
    right: Vec<f64>,
}

impl FixedPivots {
    /// The factors of matrices of a pattern; they have no values yet. `None` where the indices do not fit.
    pub(crate) fn new(pattern: &Pattern, found: &Extracted) -> Option<Self> {
        let n = pattern.n();
        let row_at = narrow(&found.row_at)?;
        let column_at = narrow(&found.column_at)?;
        let blocks = narrow(&found.blocks)?;
        let mut place_of_row = vec![0_u32; n];
        for (place, &row) in row_at.iter().enumerate() {
            place_of_row[row as usize] = u32::try_from(place).ok()?;
        }
        let mut sources = Vec::with_capacity(pattern.n_entries());
        let mut source_starts = vec![0];
        for &column in &column_at {
            let starts = &pattern.column_starts()[column as usize..];
            for entry in usize::try_from(starts[0]).ok()?..usize::try_from(starts[1]).ok()? {
                let row = usize::try_from(pattern.rows()[entry]).ok()?;
                sources.push((u32::try_from(entry).ok()?, place_of_row[row]));
            }
            source_starts.push(u32::try_from(sources.len()).ok()?);
        }
        Some(Self {
            lower: columns(&found.lower, |row, column| row > column)?,
            upper: columns(&found.upper, |row, column| row < column)?,
            above: columns(&found.above, |_, _| true)?,
            pivots: vec![0.0; n],
            sources,
            source_starts,
            row_at,
            column_at,
            blocks,
            scale: found.scale.iter().map(|scale| 1.0 / scale).collect(),
            column: vec![0.0; n],
            right: vec![0.0; n],
        })
    }

    /// Factors the matrix with these values. Returns the reciprocal growth of the entries, the least of all columns of the
    /// blocks; 0 if a pivot is 0 or not finite.
    pub(crate) fn factor(&mut self, values: &[f64]) -> f64 {
        let Self {
            lower,
            upper,
            above,
            column: x,
            ..
        } = self;
        let mut growth = f64::INFINITY;
        let mut block = 0;
        for k in 0..self.pivots.len() {
            if self.blocks[block + 1] as usize == k {
                block += 1;
            }
            let first = self.blocks[block];
            let mut largest = 0.0_f64;
            let sources = self.source_starts[k] as usize..self.source_starts[k + 1] as usize;
            for &(entry, row) in &self.sources[sources] {
                let value = values[entry as usize] * self.scale[row as usize];
                x[row as usize] = value;
                if row >= first {
                    largest = largest.max(value.abs());
                }
            }
            for entry in above.range(k) {
                let row = above.rows[entry] as usize;
                above.values[entry] = std::mem::take(&mut x[row]);
            }
            let mut grown = 0.0_f64;
            for entry in upper.range(k) {
                let row = upper.rows[entry] as usize;
                let value = std::mem::take(&mut x[row]);
                upper.values[entry] = value;
                grown = grown.max(value.abs());
                let below = lower.range(row);
                let pairs = lower.rows[below.clone()].iter().zip(&lower.values[below]);
                for (&row, factor) in pairs {
                    x[row as usize] -= factor * value;
                }
            }
            let pivot = std::mem::take(&mut x[k]);
            grown = grown.max(pivot.abs());
            growth = growth.min(largest / grown);
            let pivot = 1.0 / pivot;
            self.pivots[k] = pivot;
            let below = lower.range(k);
            for (&row, value) in lower.rows[below.clone()]
                .iter()
                .zip(&mut lower.values[below])
            {
                *value = std::mem::take(&mut x[row as usize]) * pivot;
            }
            if !pivot.is_finite() || grown.is_nan() {
                x.fill(0.0);
                return 0.0;
            }
        }
        growth
    }

    /// Replaces `b` by the solution with the matrix factored last.
    pub(crate) fn solve(&mut self, b: &mut [f64]) {
        let x = &mut self.right;
        for (place, &row) in self.row_at.iter().enumerate() {
            x[place] = b[row as usize] * self.scale[place];
        }
        for ends in self.blocks.windows(2).rev() {
            let block = ends[0] as usize..ends[1] as usize;
            if block.len() > 1 {
                for k in block.clone() {
                    subtract(&self.lower, k, x[k], x);
                }
            }
            for k in block.rev() {
                x[k] *= self.pivots[k];
                subtract(&self.upper, k, x[k], x);
                subtract(&self.above, k, x[k], x);
            }
        }
        for (place, &column) in self.column_at.iter().enumerate() {
            b[column as usize] = x[place];
        }
    }
}

/// Subtracts a column times a number.
fn subtract(columns: &Columns, column: usize, factor: f64, x: &mut [f64]) {
    let range = columns.range(column);
    let rows = &columns.rows[range.clone()];
    for (&row, value) in rows.iter().zip(&columns.values[range]) {
        x[row as usize] -= value * factor;
    }
}

/// A pattern with ascending rows, of the entries that are wanted.
fn columns(
    (starts, rows): &(Vec<i64>, Vec<i64>),
    wanted: impl Fn(i64, i64) -> bool,
) -> Option<Columns> {
    let mut found = Columns {
        starts: vec![0],
        ..Columns::default()
    };
    for (column, ends) in (0_i64..).zip(starts.windows(2)) {
        let range = usize::try_from(ends[0]).ok()?..usize::try_from(ends[1]).ok()?;
        let mut own: Vec<i64> = rows[range].to_vec();
        own.retain(|&row| wanted(row, column));
        own.sort_unstable();
        found.rows.extend(narrow(&own)?);
        found.starts.push(u32::try_from(found.rows.len()).ok()?);
    }
    found.values = vec![0.0; found.rows.len()];
    Some(found)
}

fn narrow(numbers: &[i64]) -> Option<Vec<u32>> {
    let each = numbers.iter();
    each.map(|&number| u32::try_from(number).ok()).collect()
}
