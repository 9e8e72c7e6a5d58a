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

mod half;

use crate::Pattern;
use half::Half;
use std::ops::Range;

/// So many values move into the order of the solution in one turn of a loop, and so many out of it.
const AT_ONCE: usize = 4;

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

/// The values of the factors of one matrix.
#[derive(Debug, Default)]
pub(crate) struct Values {
    pivots: Vec<f64>,
    down: Vec<f64>,
    up: Vec<f64>,
}

/// A row of the factors.
#[derive(Clone, Copy, Debug, Default)]
struct Row {
    /// How many of the entries on the way down are of F.
    n_above: u32,
    /// Which row it is on the way up.
    upward: u32,
}

/// A diagonal block: the runs of its rows on the way down and on the way up.
#[derive(Debug)]
struct Block {
    down: Range<u32>,
    up: Range<u32>,
}

/// The factors of a matrix, row by row in the order of the solution: the blocks from the last to the first, in each the
/// pivots as KLU has them.
#[derive(Debug)]
pub(crate) struct FixedPivots {
    rows: Vec<Row>,
    /// The equation and the unknown of each pivot.
    equations: Vec<u32>,
    unknowns: Vec<u32>,
    /// 1 over the scale of each row.
    scales: Vec<f64>,
    /// 1 over the diagonal of U.
    pivots: Vec<f64>,
    blocks: Vec<Block>,
    /// What the rows read on the way down: F, then L from left to right.
    down: Half,
    /// What they read on the way up, in each block from the last row to the first: U from right to left.
    up: Half,
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
        let of_pivots = |list: &[i64]| -> Option<Vec<u32>> {
            let list = order.iter().map(|&pivot| list[pivot as usize]);
            list.map(|number| u32::try_from(number).ok()).collect()
        };
        let scales = order.iter().map(|&pivot| found.scale[pivot as usize]);
        let mut factors = Self {
            rows: vec![Row::default(); order.len()],
            equations: of_pivots(&found.row_at)?,
            unknowns: of_pivots(&found.column_at)?,
            scales: scales.map(|scale| 1.0 / scale).collect(),
            pivots: vec![0.0; order.len()],
            blocks: Vec::with_capacity(blocks.len()),
            down: Half::new(false),
            up: Half::new(true),
            sources: Vec::with_capacity(pattern.n_entries()),
            source_ends: Vec::with_capacity(order.len()),
            work: vec![0.0; order.len()],
        };
        let mut place_of = vec![0_u32; order.len()];
        for (place, &pivot) in (0..).zip(&order) {
            place_of[pivot as usize] = place;
        }
        let above = columns(&found.above, &place_of)?;
        let lower = columns(&found.lower, &place_of)?;
        let upper = columns(&found.upper, &place_of)?;
        let mut start = 0;
        for ends in blocks.windows(2).rev() {
            let rows = start..start + (ends[1] - ends[0]);
            start = rows.end;
            factors.add_block(rows, &above, &lower, &upper)?;
        }
        factors.read_sources(pattern)?;
        Some(factors)
    }

    /// Adds a block with the columns of each row of F, L and U.
    fn add_block(
        &mut self,
        rows: Range<u32>,
        above: &[Vec<u32>],
        lower: &[Vec<u32>],
        upper: &[Vec<u32>],
    ) -> Option<()> {
        for place in rows.clone() {
            let (above, lower) = (&above[place as usize], &lower[place as usize]);
            let before = lower.iter().take_while(|&&column| column < place);
            self.down.push(place, above.iter().chain(before))?;
            self.rows[place as usize].n_above = u32::try_from(above.len()).ok()?;
        }
        for (upward, place) in (rows.start..).zip(rows.clone().rev()) {
            let from_right = upper[place as usize].iter().rev();
            let after = from_right.take_while(|&&column| column > place);
            self.up.push(place, after)?;
            self.rows[place as usize].upward = upward;
        }
        self.blocks.push(Block {
            down: self.down.end_block()?,
            up: self.up.end_block()?,
        });
        Some(())
    }

    /// Where the entries of each row are in the values of the matrix.
    fn read_sources(&mut self, pattern: &Pattern) -> Option<()> {
        let mut place_of = vec![0; self.rows.len()];
        for (place, &equation) in self.equations.iter().enumerate() {
            place_of[equation as usize] = place;
        }
        let mut of_row = vec![Vec::new(); self.rows.len()];
        for (place, &unknown) in (0_u32..).zip(&self.unknowns) {
            let starts = &pattern.column_starts()[unknown as usize..];
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

    /// Factors the matrix with these values. Returns whether the factors serve: no pivot is 0 or not finite, and in each row
    /// the largest entry of the matrix is at least `least_reciprocal_growth` times the largest of U.
    pub(crate) fn factor(&mut self, values: &[f64], least_reciprocal_growth: f64) -> bool {
        let x = &mut self.work;
        x.fill(0.0);
        let mut start = 0;
        for (k, row) in self.rows.iter().enumerate() {
            let mut largest = 0.0_f64;
            let end = self.source_ends[k] as usize;
            for &(entry, column) in &self.sources[start..end] {
                let value = values[entry as usize] * self.scales[k];
                x[column as usize] = value;
                largest = larger(largest, value);
            }
            start = end;
            for (nth, entry) in self.down.entries(k).enumerate() {
                let column = self.down.columns[entry] as usize;
                let value = std::mem::take(&mut x[column]);
                if nth < row.n_above as usize {
                    self.down.values[entry] = value;
                    continue;
                }
                let factor = value * self.pivots[column];
                self.down.values[entry] = factor;
                for right in self.up.entries(self.rows[column].upward as usize) {
                    x[self.up.columns[right] as usize] -= factor * self.up.values[right];
                }
            }
            let pivot = std::mem::take(&mut x[k]);
            let mut grown = pivot.abs();
            for entry in self.up.entries(row.upward as usize) {
                let value = std::mem::take(&mut x[self.up.columns[entry] as usize]);
                self.up.values[entry] = value;
                grown = larger(grown, value);
            }
            let pivot = 1.0 / pivot;
            self.pivots[k] = pivot;
            let serves = pivot.is_finite() && largest >= least_reciprocal_growth * grown;
            if !serves {
                return false;
            }
        }
        true
    }

    /// Exchanges the values for others of the same pivots, or for room where there are none.
    pub(crate) fn exchange(&mut self, other: &mut Values) {
        let own = [&mut self.pivots, &mut self.down.values, &mut self.up.values];
        let others = [&mut other.pivots, &mut other.down, &mut other.up];
        for (own, other) in own.into_iter().zip(others) {
            other.resize(own.len(), 0.0);
            std::mem::swap(own, other);
        }
    }

    /// Replaces `b` by the solution with the matrix factored last.
    pub(crate) fn solve(&mut self, b: &mut [f64]) {
        let x = &mut self.work[..];
        let (groups, rest) = x.as_chunks_mut::<AT_ONCE>();
        let (of_groups, of_rest) = self.equations.as_chunks();
        let (scales, scales_of_rest) = self.scales.as_chunks::<AT_ONCE>();
        for ((x, equations), scales) in groups.iter_mut().zip(of_groups).zip(scales) {
            *x = equations.map(|equation| b[equation as usize]);
            for (x, scale) in x.iter_mut().zip(scales) {
                *x *= scale;
            }
        }
        for ((x, &equation), scale) in rest.iter_mut().zip(of_rest).zip(scales_of_rest) {
            *x = b[equation as usize] * scale;
        }
        for Block { down, up } in &self.blocks {
            self.down.subtract(down.clone(), x, &self.pivots);
            self.up.subtract(up.clone(), x, &self.pivots);
        }
        let (groups, rest) = x.as_chunks::<AT_ONCE>();
        let (of_groups, of_rest) = self.unknowns.as_chunks::<AT_ONCE>();
        for (x, unknowns) in groups.iter().zip(of_groups) {
            for (x, &unknown) in x.iter().zip(unknowns) {
                b[unknown as usize] = *x;
            }
        }
        for (x, &unknown) in rest.iter().zip(of_rest) {
            b[unknown as usize] = *x;
        }
    }
}

/// The larger of two absolute values: what is not a number shows in a pivot.
fn larger(largest: f64, value: f64) -> f64 {
    if value.abs() > largest {
        value.abs()
    } else {
        largest
    }
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
