//! [`Half`]: what the rows of one triangular factor read of each other, and the pass through them that solves with it.
//!
//! The rows of a chain, of a band or of many equal machines read, one like the other, values at the same distances. Such
//! rows are one [`Run`]: the pass knows how many values each row reads and where, so that it looks up no column. Rows that
//! do not read each other are a *group*: they are worked at at once, in the lanes of a register. Where each group reads the
//! one before it, as the groups of a chain do, that stays in its register. All other rows look up their columns.

use std::cell::Cell;
use std::ops::Range;

/// So many alike rows are a run of their own; fewer are not worth its start.
const SHORTEST: usize = 8;

/// The entries of one factor beside its diagonal, row after row in the order of the pass, but for those of a group: they
/// stand side by side, the first of each row, the second of each row and so on.
#[derive(Debug)]
pub(super) struct Half {
    /// Whether the pass goes from the last place to the first.
    upward: bool,
    /// The column of each entry, as a place in the order of the solution.
    pub(super) columns: Vec<u32>,
    pub(super) values: Vec<f64>,
    rows: Vec<OfRow>,
    runs: Vec<Run>,
    /// How many rows belong to runs already.
    done: usize,
}

/// A row by its place, and where its entries are.
#[derive(Clone, Copy, Debug)]
struct OfRow {
    place: u32,
    begin: u32,
    count: u32,
    /// How far apart its entries are.
    stride: u32,
}

/// Rows at successive places.
#[derive(Debug)]
struct Run {
    /// Its place that is lowest, and how many there are.
    first: u32,
    length: u32,
    /// Its first row in the order of the pass, and the first of its entries.
    row: u32,
    begin: u32,
    alike: Option<Alike>,
}

/// What the rows of a run have in common.
#[derive(Debug)]
struct Alike {
    /// How far from its own place each row reads, the nearest last.
    distances: Box<[i32]>,
    /// How many rows a group has: 1, 2 or 4.
    group: u32,
}

impl Alike {
    /// What rows are that read at these distances; nothing where these are too many.
    fn new(distances: Box<[i32]>) -> Option<Self> {
        let nearest = distances.iter().map(|distance| distance.unsigned_abs());
        let group = match nearest.min() {
            Some(1) => 1,
            Some(2 | 3) => 2,
            Some(_) | None => 4,
        };
        (distances.len() <= 4).then_some(Self { distances, group })
    }

    /// Whether the last distance is to the group before.
    fn is_chain(&self) -> bool {
        let last = self.distances.last();
        last.is_some_and(|last| last.unsigned_abs() == self.group)
    }
}

impl Half {
    /// Without rows.
    pub(super) fn new(upward: bool) -> Self {
        Self {
            upward,
            columns: Vec::new(),
            values: Vec::new(),
            rows: Vec::new(),
            runs: Vec::new(),
            done: 0,
        }
    }

    /// Appends the row at a place: behind the one before, or in front of it where the pass goes upward. The nearest column
    /// comes last.
    pub(super) fn push<'c>(
        &mut self,
        place: u32,
        columns: impl Iterator<Item = &'c u32>,
    ) -> Option<()> {
        let begin = self.columns.len();
        self.columns.extend(columns);
        self.values.resize(self.columns.len(), 0.0);
        self.rows.push(OfRow {
            place,
            begin: u32::try_from(begin).ok()?,
            count: u32::try_from(self.columns.len() - begin).ok()?,
            stride: 1,
        });
        Some(())
    }

    /// Ends a block: divides the rows appended since the last one into runs. Returns these.
    pub(super) fn end_block(&mut self) -> Option<Range<u32>> {
        let first = u32::try_from(self.runs.len()).ok()?;
        let rows = std::mem::replace(&mut self.done, self.rows.len())..self.rows.len();
        let mut unlike = rows.start;
        let mut at = rows.start;
        while at < rows.end {
            let same = (at..rows.end).take_while(|&other| self.are_alike(at, other));
            let end = at + same.count();
            if end - at >= SHORTEST
                && let Some(alike) = Alike::new(self.distances(at).collect())
            {
                self.add_run(unlike..at, None)?;
                let end = end - (end - at) % alike.group as usize;
                self.set_side_by_side(at..end, alike.group);
                self.add_run(at..end, Some(alike))?;
                unlike = end;
            }
            at = end;
        }
        self.add_run(unlike..rows.end, None)?;
        Some(first..u32::try_from(self.runs.len()).ok()?)
    }

    fn add_run(&mut self, rows: Range<usize>, alike: Option<Alike>) -> Option<()> {
        let own = &self.rows[rows.clone()];
        let first = own.iter().map(|row| row.place).min();
        let begin = own.iter().map(|row| row.begin).min();
        if let (Some(first), Some(begin)) = (first, begin) {
            self.runs.push(Run {
                first,
                begin,
                length: u32::try_from(rows.len()).ok()?,
                row: u32::try_from(rows.start).ok()?,
                alike,
            });
        }
        Some(())
    }

    fn are_alike(&self, one: usize, other: usize) -> bool {
        self.rows[one].count == self.rows[other].count
            && self.distances(one).eq(self.distances(other))
    }

    /// How far from its own place a row reads.
    fn distances(&self, row: usize) -> impl Iterator<Item = i32> {
        let place = self.rows[row].place.cast_signed();
        let columns = self.entries(row).map(|entry| self.columns[entry]);
        columns.map(move |column| column.cast_signed() - place)
    }

    /// Sets the entries of each group of some rows side by side, in the order of their places.
    fn set_side_by_side(&mut self, rows: Range<usize>, group: u32) {
        for rows in self.rows[rows].chunks_exact_mut(group as usize) {
            if self.upward {
                rows.reverse();
            }
            let begin = rows.iter().map(|row| row.begin).min().unwrap_or(0);
            let of_rows = rows.iter().flat_map(|row| {
                let columns = &self.columns[row.begin as usize..];
                columns[..row.count as usize].to_vec()
            });
            let columns: Vec<u32> = of_rows.collect();
            for (lane, row) in (0..group).zip(rows.iter_mut()) {
                (row.begin, row.stride) = (begin + lane, group);
            }
            for (at, column) in (0_u32..).zip(columns) {
                let row = &rows[(at / rows[0].count) as usize];
                let entry = row.begin + row.stride * (at % row.count);
                self.columns[entry as usize] = column;
            }
            if self.upward {
                rows.reverse();
            }
        }
    }

    /// Where the entries of a row are; rows count in the order of the pass.
    pub(super) fn entries(&self, row: usize) -> impl Iterator<Item = usize> + use<> {
        let OfRow {
            begin,
            count,
            stride,
            ..
        } = self.rows[row];
        (0..count).map(move |at| (begin + at * stride) as usize)
    }

    /// Subtracts from each row of some runs, one after the other, its entries times what they read; on the way up each row
    /// is multiplied by its own of `pivots` then.
    pub(super) fn subtract(&self, runs: Range<u32>, x: &mut [f64], pivots: &[f64]) {
        let x = Cell::from_mut(x).as_slice_of_cells();
        for run in &self.runs[runs.start as usize..runs.end as usize] {
            match &run.alike {
                Some(alike) => match *alike.distances {
                    [] => self.diagonal(run, x, pivots),
                    [a] => self.run(run, alike, [a], x, pivots),
                    [a, b] => self.run(run, alike, [a, b], x, pivots),
                    [a, b, c] => self.run(run, alike, [a, b, c], x, pivots),
                    [a, b, c, d, ..] => self.run(run, alike, [a, b, c, d], x, pivots),
                },
                None => self.unlike(run, x, pivots),
            }
        }
    }

    /// The rows of a run that all read at these distances.
    fn run<const N: usize>(
        &self,
        run: &Run,
        alike: &Alike,
        distances: [i32; N],
        x: &[Cell<f64>],
        pivots: &[f64],
    ) {
        match (alike.group, alike.is_chain()) {
            (1, false) => self.groups::<N, 1, false>(run, distances, x, pivots),
            (1, true) => self.groups::<N, 1, true>(run, distances, x, pivots),
            (2, false) => self.groups::<N, 2, false>(run, distances, x, pivots),
            (2, true) => self.groups::<N, 2, true>(run, distances, x, pivots),
            (_, false) => self.groups::<N, 4, false>(run, distances, x, pivots),
            (_, true) => self.groups::<N, 4, true>(run, distances, x, pivots),
        }
    }

    /// The same in groups of `W` rows, which may be a chain.
    fn groups<const N: usize, const W: usize, const CHAIN: bool>(
        &self,
        run: &Run,
        distances: [i32; N],
        x: &[Cell<f64>],
        pivots: &[f64],
    ) {
        let length = run.length as usize;
        let at = |place: u32| x[place as usize..][..length].as_chunks::<W>().0;
        let own = at(run.first);
        // All slices have the length of the first: so the compiler sees that no index leaves one.
        let read =
            distances.map(|distance| &at(run.first.wrapping_add_signed(distance))[..own.len()]);
        let pivots = &pivots[run.first as usize..][..length].as_chunks::<W>().0[..own.len()];
        let entries = &self.values[run.begin as usize..][..N * length];
        let entries = entries.as_chunks::<W>().0.as_chunks::<N>().0;
        let values = |cells: &[Cell<f64>; W]| cells.each_ref().map(Cell::get);
        let start = if self.upward { own.len() - 1 } else { 0 };
        let mut before = values(&read[N - 1][start]);
        let mut subtract = |group: usize, entries: &[[f64; W]; N], pivots: Option<&[f64; W]>| {
            let mut value = values(&own[group]);
            for (at, (entries, read)) in entries.iter().zip(&read).enumerate() {
                let read = match CHAIN && at + 1 == N {
                    true => before,
                    false => values(&read[group]),
                };
                for ((value, entry), read) in value.iter_mut().zip(entries).zip(read) {
                    *value -= entry * read;
                }
            }
            for (value, pivot) in value.iter_mut().zip(pivots.into_iter().flatten()) {
                *value *= pivot;
            }
            for (own, value) in own[group].iter().zip(value) {
                own.set(value);
            }
            before = value;
        };
        if self.upward {
            for (group, entries) in (0..own.len()).rev().zip(entries) {
                subtract(group, entries, Some(&pivots[group]));
            }
        } else {
            for (group, entries) in (0..own.len()).zip(entries) {
                subtract(group, entries, None);
            }
        }
    }

    /// Rows that read nothing.
    fn diagonal(&self, run: &Run, x: &[Cell<f64>], pivots: &[f64]) {
        if !self.upward {
            return;
        }
        let places = run.first as usize..(run.first + run.length) as usize;
        for (own, pivot) in x[places.clone()].iter().zip(&pivots[places]) {
            own.set(own.get() * pivot);
        }
    }

    /// Rows of any kind.
    fn unlike(&self, run: &Run, x: &[Cell<f64>], pivots: &[f64]) {
        let rows = &self.rows[run.row as usize..][..run.length as usize];
        for row in rows {
            let entries = row.begin as usize..(row.begin + row.count) as usize;
            let (columns, values) = (&self.columns[entries.clone()], &self.values[entries]);
            let own = &x[row.place as usize];
            let mut value = own.get();
            for (&column, entry) in columns.iter().zip(values) {
                value -= entry * x[column as usize].get();
            }
            own.set(match self.upward {
                false => value,
                true => value * pivots[row.place as usize],
            });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows that read at the same distances but for the row at place 23, by runs and one by one.
    fn compare(upward: bool, distances: &[i32], group: u32, is_chain: bool) {
        let mut half = Half::new(upward);
        let reads = |place: u32| -> Vec<u32> {
            let signed = |distance: i32| if upward { -distance } else { distance };
            let other = |&distance: &i32| place.checked_add_signed(signed(distance));
            let own = distances.iter().filter_map(other);
            own.filter(|&other| other < 40 && place != 23).collect()
        };
        let mut places: Vec<u32> = (0..40).collect();
        if upward {
            places.reverse();
        }
        for &place in &places {
            half.push(place, reads(place).iter()).unwrap();
        }
        let runs = half.end_block().unwrap();
        let alike: Vec<&Alike> = half.runs.iter().flat_map(|run| &run.alike).collect();
        assert!(!alike.is_empty());
        for alike in alike {
            assert_eq!((alike.group, alike.is_chain()), (group, is_chain));
        }
        for (at, value) in half.values.iter_mut().enumerate() {
            *value = (at as f64).sin();
        }
        let mut x: Vec<f64> = (0..40).map(|place| f64::from(place).cos()).collect();
        let pivots: Vec<f64> = x.iter().map(|value| 2.0 + value).collect();
        let mut expected = x.clone();
        for (row, place) in places.into_iter().enumerate() {
            let own: Vec<usize> = half.entries(row).collect();
            let columns: Vec<u32> = own.iter().map(|&entry| half.columns[entry]).collect();
            assert_eq!(columns, reads(place));
            for (column, entry) in columns.into_iter().zip(own) {
                expected[place as usize] -= half.values[entry] * expected[column as usize];
            }
            if upward {
                expected[place as usize] *= pivots[place as usize];
            }
        }
        half.subtract(runs, &mut x, &pivots);
        assert_eq!(x, expected);
    }

    #[test]
    fn runs_subtract_what_single_rows_do() {
        for upward in [false, true] {
            compare(upward, &[], 4, false);
            compare(upward, &[-1], 1, true);
            compare(upward, &[-3, -1], 1, true);
            compare(upward, &[-2], 2, true);
            compare(upward, &[-9, -7, -6, -2], 2, true);
            compare(upward, &[-3], 2, false);
            compare(upward, &[-6, -5, -4], 4, true);
            compare(upward, &[-5], 4, false);
        }
    }
}
