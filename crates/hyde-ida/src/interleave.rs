//! Another order of KLU's pivots, with the same entries in the factors, in which what does not depend on each other
//! stands side by side.
//!
//! An order from one end of a chain to the other makes every unknown wait for the one before it. From both ends at once
//! there are two unknowns to work at at any time, and the processor does so. Of all orders without further entries this is
//! one in which the longest way through the factors is short:
//!
//! 1. Round after round, all pivots that bring no entry which is not there already, and that do not meet each other, go
//!    next (J. A. G. Jess and H. G. M. Kees, IEEE Trans. Comput. C-31 (1982) 231, there for symmetric patterns).
//! 2. In each round the pivots stand in the order in which the later ones need them. So the rows of a chain read, each, at
//!    the same distances, and are solved in one loop ([`Half`](crate::fixed_pivots)).

use std::ops::Range;

use crate::fixed_pivots::Extracted;

/// A pivot whose row and column have more pairs of entries than this waits for its turn in KLU's order: to look at all of
/// them would take too long.
const MOST_PAIRS: usize = 256;

/// KLU's factors in this order; the entries are all places that may be other than zero.
pub(crate) fn interleaved(found: &Extracted) -> Option<Extracted> {
    let filled = Filled::new(found)?;
    let order = filled.by_need(&filled.rounds());
    let mut place_of = vec![0_i64; order.len()];
    for (place, &pivot) in (0_i64..).zip(&order) {
        place_of[pivot] = place;
    }
    let (mut lower, mut upper) = (Vec::new(), Vec::new());
    for (row, column) in filled.entries() {
        let (row, column) = (place_of[row], place_of[column]);
        let part = if row > column { &mut lower } else { &mut upper };
        part.push((column, row));
    }
    let above = entries(&found.above)?.map(|(row, column)| (place_of[column], place_of[row]));
    let above = above.collect();
    Some(Extracted {
        lower: by_columns(lower, order.len()),
        upper: by_columns(upper, order.len()),
        above: by_columns(above, order.len()),
        row_at: order.iter().map(|&pivot| found.row_at[pivot]).collect(),
        column_at: order.iter().map(|&pivot| found.column_at[pivot]).collect(),
        blocks: found.blocks.clone(),
        scale: order.iter().map(|&pivot| found.scale[pivot]).collect(),
    })
}

/// The entries of L and U beside the diagonal, in the order of KLU's pivots, each list ascending.
struct Filled {
    rows_of: Vec<Vec<usize>>,
    columns_of: Vec<Vec<usize>>,
    blocks: Vec<Range<usize>>,
}

impl Filled {
    fn new(found: &Extracted) -> Option<Self> {
        let n = found.row_at.len();
        let mut filled = Self {
            rows_of: vec![Vec::new(); n],
            columns_of: vec![Vec::new(); n],
            blocks: Vec::new(),
        };
        for part in [&found.lower, &found.upper] {
            for (row, column) in entries(part)?.filter(|(row, column)| row != column) {
                filled.rows_of[column].push(row);
                filled.columns_of[row].push(column);
            }
        }
        for list in filled.rows_of.iter_mut().chain(&mut filled.columns_of) {
            list.sort_unstable();
        }
        for ends in found.blocks.windows(2) {
            let end = |k: usize| usize::try_from(ends[k]).ok();
            filled.blocks.push(end(0)?..end(1)?);
        }
        Some(filled)
    }

    fn entries(&self) -> impl Iterator<Item = (usize, usize)> {
        let columns = self.rows_of.iter().enumerate();
        columns.flat_map(|(column, rows)| rows.iter().map(move |&row| (row, column)))
    }

    /// The pivots block after block, in each round after round.
    fn rounds(&self) -> Vec<Vec<usize>> {
        let n = self.rows_of.len();
        let mut rounds: Vec<Vec<usize>> = Vec::new();
        let mut gone = vec![false; n];
        // The round in which a pivot was last met by another one.
        let mut met = vec![0_usize; n];
        let mut round = 0;
        for block in &self.blocks {
            let mut candidates: Vec<usize> = block.clone().collect();
            let mut first = block.start;
            let mut left = block.len();
            while left > 0 {
                round += 1;
                let mut own = Vec::new();
                for &pivot in &candidates {
                    if met[pivot] != round && !gone[pivot] && self.brings_nothing(pivot, &gone) {
                        gone[pivot] = true;
                        own.push(pivot);
                        self.neighbours(pivot).for_each(|other| met[other] = round);
                    }
                }
                if own.is_empty() {
                    // What all others follow in KLU's order brings nothing either.
                    while gone[first] {
                        first += 1;
                    }
                    gone[first] = true;
                    own.push(first);
                }
                left -= own.len();
                candidates.clear();
                for &pivot in &own {
                    candidates.extend(self.neighbours(pivot).filter(|&other| !gone[other]));
                }
                candidates.sort_unstable();
                candidates.dedup();
                rounds.push(own);
            }
        }
        rounds
    }

    /// The pivots that share an entry with this one.
    fn neighbours(&self, pivot: usize) -> impl Iterator<Item = usize> {
        let columns = &self.columns_of[pivot];
        self.rows_of[pivot].iter().chain(columns).copied()
    }

    /// Whether a pivot, taken next, changes only entries that are there.
    fn brings_nothing(&self, pivot: usize, gone: &[bool]) -> bool {
        let left = |list: &[usize]| list.iter().filter(|&&other| !gone[other]).count();
        let (rows, columns) = (&self.rows_of[pivot], &self.columns_of[pivot]);
        if left(rows) * left(columns) > MOST_PAIRS {
            return false;
        }
        let columns = columns.iter().filter(|&&column| !gone[column]);
        columns.into_iter().all(|&column| {
            let mut rows = rows.iter().filter(|&&row| !gone[row]);
            rows.all(|row| *row == column || self.rows_of[column].binary_search(row).is_ok())
        })
    }

    /// The pivots round after round, in each by the first of a later round that needs it.
    fn by_need(&self, rounds: &[Vec<usize>]) -> Vec<usize> {
        let mut end = self.rows_of.len();
        let mut place_of = vec![end; end];
        let mut order = vec![0; end];
        for round in rounds.iter().rev() {
            let first_need = |pivot| self.neighbours(pivot).map(|other| place_of[other]).min();
            let mut own: Vec<_> = (round.iter())
                .map(|&pivot| (first_need(pivot), pivot))
                .collect();
            own.sort_unstable();
            let start = end - own.len();
            for (place, (_, pivot)) in (start..).zip(own) {
                order[place] = pivot;
                place_of[pivot] = place;
            }
            end = start;
        }
        order
    }
}

/// Row and column of each entry of a matrix given by columns.
fn entries((starts, rows): &(Vec<i64>, Vec<i64>)) -> Option<impl Iterator<Item = (usize, usize)>> {
    let rows: Vec<usize> = rows
        .iter()
        .map(|&row| usize::try_from(row).ok())
        .collect::<Option<_>>()?;
    let mut found = Vec::with_capacity(rows.len());
    for (column, ends) in starts.windows(2).enumerate() {
        let range = usize::try_from(ends[0]).ok()?..usize::try_from(ends[1]).ok()?;
        found.extend(rows[range].iter().map(|&row| (row, column)));
    }
    Some(found.into_iter())
}

/// Columns and rows of entries as the starts of the columns and the rows.
fn by_columns(mut entries: Vec<(i64, i64)>, n: usize) -> (Vec<i64>, Vec<i64>) {
    entries.sort_unstable();
    let mut starts = vec![0_i64; n + 1];
    for &(column, _) in &entries {
        starts[column as usize + 1] += 1;
    }
    for column in 0..n {
        starts[column + 1] += starts[column];
    }
    (starts, entries.into_iter().map(|(_, row)| row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A chain of pairs, each of a place and a speed, as KLU would take it from one end: the places meet nothing but speeds.
    fn chain(pairs: usize) -> Extracted {
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        let mut meet = |row: usize, column: usize| {
            let part = if row > column { &mut lower } else { &mut upper };
            part.push((column as i64, row as i64));
        };
        for k in 0..pairs {
            let (place, speed) = (2 * k, 2 * k + 1);
            meet(place, speed);
            for other in k.saturating_sub(1)..(k + 2).min(pairs) {
                meet(2 * other + 1, place);
                if other != k {
                    meet(2 * other + 1, speed);
                }
            }
        }
        let n = 2 * pairs;
        Extracted {
            lower: by_columns(lower, n),
            upper: by_columns(upper, n),
            above: by_columns(Vec::new(), n),
            row_at: (0..n as i64).collect(),
            column_at: (0..n as i64).collect(),
            blocks: vec![0, n as i64],
            scale: (1..=n).map(|k| k as f64).collect(),
        }
    }

    #[test]
    fn a_chain_is_worked_at_from_both_ends() {
        let found = interleaved(&chain(5)).unwrap();
        let speeds: Vec<i64> = (found.row_at.iter().copied())
            .filter(|pivot| pivot % 2 == 1)
            .map(|pivot| pivot / 2)
            .collect();
        assert_eq!(speeds, [0, 4, 1, 3, 2]);
        // Places stand in the order in which the speeds need them: that of the third pair is needed last.
        assert_eq!(found.row_at, [0, 2, 6, 8, 4, 1, 9, 3, 7, 5]);
        assert_eq!(found.row_at, found.column_at);
        let scale = found.row_at.iter().map(|&pivot| pivot as f64 + 1.0);
        assert!(found.scale.iter().copied().eq(scale));
    }

    #[test]
    fn no_entry_comes_and_none_goes() {
        for pairs in 1..8 {
            let before = chain(pairs);
            let after = interleaved(&before).unwrap();
            let count = |found: &Extracted| found.lower.1.len() + found.upper.1.len();
            assert_eq!(count(&before), count(&after));
            let back = |entry: &(usize, usize)| {
                let pivot = |place: usize| usize::try_from(after.row_at[place]).unwrap();
                (pivot(entry.0), pivot(entry.1))
            };
            let mut moved: Vec<_> = (entries(&after.lower).unwrap())
                .chain(entries(&after.upper).unwrap())
                .map(|entry| back(&entry))
                .collect();
            let mut all: Vec<_> = (entries(&before.lower).unwrap())
                .chain(entries(&before.upper).unwrap())
                .collect();
            moved.sort_unstable();
            all.sort_unstable();
            assert_eq!(moved, all);
        }
    }
}
