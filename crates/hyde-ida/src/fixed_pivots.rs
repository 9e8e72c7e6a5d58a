//! LU factors with the pivots and the pattern of an earlier factorization by KLU: what is computed for every matrix after
//! the first one.
//!
//! KLU chose a block triangular form, an order within the blocks, and pivots. As long as they serve, the same few
//! multiplications in the same order factor the next matrix, row after row, each from the rows above that its pattern
//! reaches (J. R. Gilbert and T. Peierls, SIAM J. Sci. Stat. Comput. 9 (1988) 862, for rows and without the search).
//! Whether the entries have grown is seen on the way. Rows and entries are stored in the order in which a solution reads
//! them, and a row adds up in a register: the time of a solution is that of its longest chain of operations.
//!
//! ```text
//! P R A Q = block triangular;  L U = a diagonal block;  F = what is above the blocks
//! ```

use crate::Pattern;

/// An entry of a factor: its column, in the order of the solution, and its value.
#[derive(Clone, Copy, Debug)]
struct Entry {
    column: u32,
    value: f64,
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

impl Entry {
    fn of(&column: &u32) -> Self {
        Self { column, value: 0.0 }
    }
}

/// A row of the factors.
#[derive(Debug)]
struct Row {
    /// The equation and the unknown of its pivot.
    equation: u32,
    unknown: u32,
    /// 1 over the scale of the row.
    scale: f64,
    /// 1 over the diagonal of U.
    pivot: f64,
    /// How many entries it reads on the way down, and how many of these are of F.
    n_down: u32,
    n_above: u32,
    /// Where its entries of U begin, and how many there are.
    upper: u32,
    n_upper: u32,
}

impl Row {
    /// A row without entries, for one of KLU's pivots.
    fn new(found: &Extracted, pivot: usize) -> Option<Self> {
        Some(Self {
            equation: u32::try_from(found.row_at[pivot]).ok()?,
            unknown: u32::try_from(found.column_at[pivot]).ok()?,
            scale: 1.0 / found.scale[pivot],
            pivot: 0.0,
            n_down: 0,
            n_above: 0,
            upper: 0,
            n_upper: 0,
        })
    }
}

/// The factors of a matrix, row by row in the order of the solution: the blocks from the last to the first, in each the
/// pivots as KLU has them.
#[derive(Debug)]
pub(crate) struct FixedPivots {
    rows: Vec<Row>,
    /// The end of each block.
    ends: Vec<u32>,
    /// What the rows read on the way down, one after the other: F, then L from left to right.
    down: Vec<Entry>,
    /// What they read on the way up, in each block from the last row to the first: U from right to left.
    up: Vec<Entry>,
    /// For each entry of the matrix, row after row: its place in the values, and its column.
    sources: Vec<(u32, u32)>,
    source_ends: Vec<u32>,
    work: Vec<f64>,
}

impl FixedPivots {
    /// The factors of matrices of a pattern; they have no values yet. `None` where the indices do not fit.
    pub(crate) fn new(pattern: &Pattern, found: &Extracted) -> Option<Self> {
        let blocks = narrow(&found.blocks)?;
        let order: Vec<u32> = (blocks.windows(2).rev())
            .flat_map(|ends| ends[0]..ends[1])
            .collect();
        let mut factors = Self {
            rows: Vec::with_capacity(order.len()),
            ends: Vec::with_capacity(blocks.len()),
            down: Vec::new(),
            up: Vec::new(),
            sources: Vec::with_capacity(pattern.n_entries()),
            source_ends: Vec::with_capacity(order.len()),
            work: vec![0.0; order.len()],
        };
        let mut place_of = vec![0_u32; order.len()];
        for (place, &pivot) in (0..).zip(&order) {
            place_of[pivot as usize] = place;
            factors.rows.push(Row::new(found, pivot as usize)?);
        }
        factors.read_down(
            &columns(&found.above, &place_of)?,
            &columns(&found.lower, &place_of)?,
        )?;
        let lengths = blocks.windows(2).rev().map(|ends| ends[1] - ends[0]);
        factors.read_up(lengths, &columns(&found.upper, &place_of)?)?;
        factors.read_sources(pattern)?;
        Some(factors)
    }

    /// What the rows read of F and L.
    fn read_down(&mut self, above: &[Vec<u32>], lower: &[Vec<u32>]) -> Option<()> {
        for (place, row) in (0_u32..).zip(&mut self.rows) {
            let above = &above[place as usize];
            let lower = lower[place as usize].iter();
            let start = self.down.len();
            self.down.extend(above.iter().map(Entry::of));
            let before = lower.take_while(|&&column| column < place);
            self.down.extend(before.map(Entry::of));
            row.n_above = u32::try_from(above.len()).ok()?;
            row.n_down = u32::try_from(self.down.len() - start).ok()?;
        }
        Some(())
    }

    /// What the rows of blocks of these lengths read of U.
    fn read_up(&mut self, lengths: impl Iterator<Item = u32>, upper: &[Vec<u32>]) -> Option<()> {
        let mut start = 0;
        for length in lengths {
            let end = start + length;
            for place in (start..end).rev() {
                let begin = self.up.len();
                let from_right = upper[place as usize].iter().rev();
                let after = from_right.take_while(|&&column| column > place);
                self.up.extend(after.map(Entry::of));
                let row = &mut self.rows[place as usize];
                row.upper = u32::try_from(begin).ok()?;
                row.n_upper = u32::try_from(self.up.len() - begin).ok()?;
            }
            self.ends.push(end);
            start = end;
        }
        Some(())
    }

    /// Where the entries of each row are in the values of the matrix.
    fn read_sources(&mut self, pattern: &Pattern) -> Option<()> {
        let mut place_of = vec![0; self.rows.len()];
        for (place, row) in self.rows.iter().enumerate() {
            place_of[row.equation as usize] = place;
        }
        let mut of_row = vec![Vec::new(); self.rows.len()];
        for (place, row) in (0_u32..).zip(&self.rows) {
            let starts = &pattern.column_starts()[row.unknown as usize..];
            for entry in usize::try_from(starts[0]).ok()?..usize::try_from(starts[1]).ok()? {
                let equation = usize::try_from(pattern.rows()[entry]).ok()?;
                of_row[place_of[equation]].push((u32::try_from(entry).ok()?, place));
            }
        }
        for sources in of_row {
            self.sources.extend(sources);
            let end = u32::try_from(self.sources.len()).ok()?;
            self.source_ends.push(end);
        }
        Some(())
    }

    /// Factors the matrix with these values. Returns the reciprocal growth of the entries, the least of all rows; 0 if a
    /// pivot is 0 or not finite.
    pub(crate) fn factor(&mut self, values: &[f64]) -> f64 {
        let x = &mut self.work;
        x.fill(0.0);
        let mut growth = f64::INFINITY;
        let mut down = self.down.iter_mut();
        let mut start = 0;
        for k in 0..self.rows.len() {
            let row = &self.rows[k];
            let mut largest = 0.0_f64;
            let end = self.source_ends[k] as usize;
            for &(entry, column) in &self.sources[start..end] {
                let value = values[entry as usize] * row.scale;
                x[column as usize] = value;
                largest = largest.max(value.abs());
            }
            start = end;
            for entry in down.by_ref().take(row.n_above as usize) {
                entry.value = std::mem::take(&mut x[entry.column as usize]);
            }
            for entry in down.by_ref().take((row.n_down - row.n_above) as usize) {
                let above = &self.rows[entry.column as usize];
                let factor = std::mem::take(&mut x[entry.column as usize]) * above.pivot;
                entry.value = factor;
                for above in &self.up[above.upper as usize..][..above.n_upper as usize] {
                    x[above.column as usize] -= factor * above.value;
                }
            }
            let pivot = std::mem::take(&mut x[k]);
            let mut grown = pivot.abs();
            for entry in &mut self.up[row.upper as usize..][..row.n_upper as usize] {
                entry.value = std::mem::take(&mut x[entry.column as usize]);
                grown = grown.max(entry.value.abs());
            }
            growth = growth.min(largest / grown);
            let pivot = 1.0 / pivot;
            self.rows[k].pivot = pivot;
            if !pivot.is_finite() || grown.is_nan() {
                return 0.0;
            }
        }
        growth
    }

    /// Replaces `b` by the solution with the matrix factored last.
    pub(crate) fn solve(&mut self, b: &mut [f64]) {
        let x = &mut self.work;
        let (mut down, mut up) = (&self.down[..], &self.up[..]);
        let mut start = 0;
        for &end in &self.ends {
            let end = end as usize;
            let rows = &self.rows[start..end];
            for (k, row) in (start..).zip(rows) {
                let (own, rest) = down.split_at(row.n_down as usize);
                down = rest;
                x[k] = subtract(own, x, b[row.equation as usize] * row.scale);
            }
            for (k, row) in (start..end).zip(rows).rev() {
                let (own, rest) = up.split_at(row.n_upper as usize);
                up = rest;
                x[k] = subtract(own, x, x[k]) * row.pivot;
            }
            start = end;
        }
        for (row, x) in self.rows.iter().zip(x) {
            b[row.unknown as usize] = *x;
        }
    }
}

/// What is left of `value` after the entries of a row times their unknowns are subtracted from it.
#[inline(always)]
fn subtract(row: &[Entry], x: &[f64], mut value: f64) -> f64 {
    for entry in row {
        value -= entry.value * x[entry.column as usize];
    }
    value
}

/// The columns of each row of a matrix that KLU gives by columns, ascending, in the order of the solution.
fn columns((starts, rows): &(Vec<i64>, Vec<i64>), place_of: &[u32]) -> Option<Vec<Vec<u32>>> {
    let mut found = vec![Vec::new(); place_of.len()];
    for (&place, ends) in place_of.iter().zip(starts.windows(2)) {
        for &row in &rows[usize::try_from(ends[0]).ok()?..usize::try_from(ends[1]).ok()?] {
            let of_row: &mut Vec<u32> = &mut found[place_of[usize::try_from(row).ok()?] as usize];
            of_row.push(place);
        }
    }
    found.iter_mut().for_each(|columns| columns.sort_unstable());
    Some(found)
}

fn narrow(numbers: &[i64]) -> Option<Vec<u32>> {
    let each = numbers.iter();
    each.map(|&number| u32::try_from(number).ok()).collect()
}
