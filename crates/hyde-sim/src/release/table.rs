//! [`Table`]: the derivatives of the initial equations by what they may determine, and the first columns of it that are
//! independent. Both keep only what is not 0: of an array each element has its own equation.

use super::by_parameter;
use crate::consistent::Consistent;
use crate::moment::At;
use crate::released::Column;
use crate::state::State;
use hyde_program::{Function, PartialEntry, Wrt};
use std::collections::{BTreeMap, BTreeSet};

/// A derivative is 0 below this part of what its terms amount to.
const ZERO: f64 = 1e-9;

/// Columns for which consistent values are found together.
const TOGETHER: usize = 64;

/// A derivative, and what its terms amount to.
#[derive(Clone, Copy, Default)]
struct Cell {
    value: f64,
    terms: f64,
}

impl Cell {
    fn counts(self) -> bool {
        self.value.abs() > ZERO * self.terms
    }

    fn add(&mut self, term: f64) {
        self.value += term;
        self.terms += term.abs();
    }
}

/// The derivatives of the initial equations by candidates.
pub(super) struct Table {
    rows: Vec<BTreeMap<usize, Cell>>,
    /// The rows of each column that no chosen column was taken for.
    columns: Vec<BTreeSet<usize>>,
    /// Rows that no chosen column was taken for.
    open: BTreeSet<usize>,
}

impl Table {
    /// At consistent values, which follow each candidate. `None` where they do not.
    pub(super) fn new(
        state: &mut State<'_>,
        consistent: &mut Consistent,
        at: At<'_>,
        candidates: &[Column],
        count: usize,
    ) -> Option<Self> {
        let residual = Slopes::of(state, Function::Residual, at);
        let initial = Slopes::of(state, Function::Initial, at);
        let followed = followed(state, &initial, count);
        let mut rows = vec![BTreeMap::<usize, Cell>::new(); count];
        let numbered: Vec<(usize, Column)> = candidates.iter().copied().enumerate().collect();
        for together in numbered.chunks(TOGETHER) {
            let mut follow = Vec::new();
            for &(number, candidate) in together {
                for (row, value) in initial.by(state, candidate, Function::Initial, at) {
                    if row < count && value != 0.0 {
                        rows[row].entry(number).or_default().add(value);
                    }
                }
                if !followed.is_empty() {
                    let mut right = vec![0.0; at.y.len()];
                    for (row, value) in residual.by(state, candidate, Function::Residual, at) {
                        right[row] += value;
                    }
                    follow.push(right);
                }
            }
            if !consistent.correct(state, at, &mut follow) {
                return None;
            }
            for (&(number, _), follow) in together.iter().zip(&follow) {
                for &(row, unknown, value) in &followed {
                    let term = -value * follow[unknown];
                    if term != 0.0 {
                        rows[row].entry(number).or_default().add(term);
                    }
                }
            }
        }
        let cells = || rows.iter().flat_map(BTreeMap::values);
        if !cells().all(|cell| cell.value.is_finite()) {
            return None;
        }
        let mut columns = vec![BTreeSet::new(); candidates.len()];
        for (number, row) in rows.iter().enumerate() {
            row.keys().for_each(|&column| {
                columns[column].insert(number);
            });
        }
        Some(Self {
            open: (0..count).collect(),
            rows,
            columns,
        })
    }

    /// The equations that no chosen column was taken for.
    pub(super) fn open(&self) -> impl Iterator<Item = usize> {
        self.open.iter().copied()
    }

    /// The columns on which an equation still depends.
    pub(super) fn columns_of(&self, row: usize) -> impl Iterator<Item = usize> {
        let cells = self.rows[row].iter();
        cells.filter_map(|(&column, cell)| cell.counts().then_some(column))
    }

    /// The first independent columns of those below `end`, by elimination with the clearest row of each.
    pub(super) fn basis(&mut self, end: usize) -> Vec<usize> {
        let mut found = Vec::new();
        for column in 0..end {
            let cells = self.columns[column]
                .iter()
                .map(|&row| (row, self.rows[row][&column]));
            let clear = |cell: Cell| cell.value.abs() / cell.terms;
            let pivot = cells
                .filter(|(_, cell)| cell.counts())
                .max_by(|(_, a), (_, b)| clear(*a).total_cmp(&clear(*b)));
            if let Some((pivot, _)) = pivot {
                found.push(column);
                self.eliminate(pivot, column);
            }
        }
        found
    }

    /// Takes a row for a column, and the column out of the rows that are still open.
    fn eliminate(&mut self, pivot: usize, column: usize) {
        self.open.remove(&pivot);
        let of_pivot = self.rows[pivot].clone();
        for place in of_pivot.keys() {
            self.columns[*place].remove(&pivot);
        }
        for row in std::mem::take(&mut self.columns[column]) {
            let own = self.rows[row].remove(&column).unwrap_or_default();
            let factor = own.value / of_pivot[&column].value;
            if factor == 0.0 {
                continue;
            }
            for (&place, cell) in of_pivot.iter().filter(|(place, _)| **place != column) {
                let changed = self.rows[row].entry(place).or_default();
                changed.value -= factor * cell.value;
                changed.terms += factor.abs() * cell.terms;
                self.columns[place].insert(row);
            }
        }
    }
}

/// What the initial equations read of what follows the states: equation, unknown, derivative.
fn followed(state: &State<'_>, initial: &Slopes<'_>, count: usize) -> Vec<(usize, usize, f64)> {
    let entries = initial.entries.iter().zip(&initial.values);
    let followed = entries.filter_map(|(entry, &value)| match entry.wrt {
        Wrt::Unknown(unknown) if !state.differential[unknown] => Some((entry.row, unknown, value)),
        Wrt::Derivative(unknown) => Some((entry.row, unknown, value)),
        Wrt::Unknown(_) | Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => None,
    });
    followed.filter(|&(row, ..)| row < count).collect()
}

/// The derivatives of a function, which can be looked up by unknown.
struct Slopes<'p> {
    entries: &'p [PartialEntry],
    values: Vec<f64>,
    of_unknown: Vec<Vec<usize>>,
}

impl<'p> Slopes<'p> {
    fn of(state: &mut State<'p>, function: Function, at: At<'_>) -> Self {
        let entries = state.program.partials(function);
        let mut of_unknown = vec![Vec::new(); at.y.len()];
        for (number, entry) in entries.iter().enumerate() {
            if let Wrt::Unknown(unknown) = entry.wrt {
                of_unknown[unknown].push(number);
            }
        }
        Self {
            entries,
            values: state.partials(function, at),
            of_unknown,
        }
    }

    /// The derivatives by a candidate: row and value.
    fn by(
        &self,
        state: &mut State<'_>,
        candidate: Column,
        function: Function,
        at: At<'_>,
    ) -> Vec<(usize, f64)> {
        match candidate {
            Column::State(position) => {
                let numbers = self.of_unknown[position].iter();
                let entry = |&number: &usize| (self.entries[number].row, self.values[number]);
                numbers.map(entry).collect()
            }
            Column::Parameter(place) => {
                let values = by_parameter(state, place, function, at);
                values.into_iter().enumerate().collect()
            }
        }
    }
}
