//! [`Elimination`]: the order in which the equations of a step are eliminated, one for all modes, so that few numbers become
//! other than zero and no pivot is small.
//!
//! The order is that of Markowitz: the pivot whose row and column have the fewest other numbers is next. It is chosen on
//! numbers of several combinations of modes at once, with the step and without it: a pivot must be large enough in all of
//! them. Where there is none, the one that serves the most of them is taken; in the others the step exchanges rows.

use crate::fixed_step::FixedStep;
use hyde_program::{Function, PartialEntry, Point, Program, Workspace, Wrt};
use std::collections::{BTreeMap, BTreeSet};

/// A pivot is at least this part of the largest number in its column.
const PIVOT: f64 = 0.1;
/// At most so many combinations of modes are looked at.
const COMBINATIONS: usize = 64;

/// An order of equations and unknowns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Elimination {
    /// The equations in their order.
    pub(crate) equations: Vec<usize>,
    /// The unknown that each of them is solved for.
    pub(crate) unknowns: Vec<usize>,
}

/// A row of a matrix: the columns that may have a number, with the number of each sample.
type Row = BTreeMap<usize, Vec<f64>>;

impl Elimination {
    /// The order for the equations of a program.
    pub(crate) fn of(model: &FixedStep<'_>) -> Self {
        Self::of_rows(sampled_rows(model))
    }

    /// The order for rows of a square matrix.
    fn of_rows(mut rows: Vec<Row>) -> Self {
        let n = rows.len();
        let samples = rows.iter().flat_map(Row::values).map(Vec::len).max();
        let mut remaining: Vec<usize> = (0..samples.unwrap_or(0)).collect();
        scale(&mut rows, &remaining);
        let mut columns = vec![BTreeSet::new(); n];
        for (row, own) in rows.iter().enumerate() {
            for &column in own.keys() {
                columns[column].insert(row);
            }
        }
        let mut found = Self {
            equations: Vec::with_capacity(n),
            unknowns: Vec::with_capacity(n),
        };
        while let Some((row, column)) = next_pivot(&rows, &columns, &remaining) {
            found.equations.push(row);
            found.unknowns.push(column);
            remaining.retain(|&sample| large(&rows, &columns, (row, column), sample));
            let own = std::mem::take(&mut rows[row]);
            for other in own.keys() {
                columns[*other].remove(&row);
            }
            for below in std::mem::take(&mut columns[column]) {
                let Some(factors) = rows[below].remove(&column) else {
                    continue;
                };
                for (&other, values) in own.iter().filter(|(other, _)| **other != column) {
                    let zeros = || vec![0.0; values.len()];
                    let target = rows[below].entry(other).or_insert_with(zeros);
                    for &sample in &remaining {
                        let factor = factors[sample] / own[&column][sample];
                        target[sample] -= factor * values[sample];
                    }
                    columns[other].insert(below);
                }
            }
        }
        // What no pivot is left for is singular, which the step finds.
        found.equations.extend(rest(&found.equations, n));
        found.unknowns.extend(rest(&found.unknowns, n));
        found
    }
}

/// Divides each row by its largest number, in each sample on its own.
fn scale(rows: &mut [Row], samples: &[usize]) {
    for row in rows {
        for &sample in samples {
            let most = row.values().map(|values| values[sample].abs());
            let most = most.fold(0.0, f64::max);
            if most > 0.0 {
                row.values_mut().for_each(|values| values[sample] /= most);
            }
        }
    }
}

/// The cheapest pivot that is large enough in all samples, or in the most of them.
fn next_pivot(
    rows: &[Row],
    columns: &[BTreeSet<usize>],
    samples: &[usize],
) -> Option<(usize, usize)> {
    let all = rows.iter().enumerate();
    let all = all.flat_map(|(row, own)| own.keys().map(move |&column| (row, column)));
    let mut candidates: Vec<(usize, usize)> = all.collect();
    candidates.sort_by_key(|&(row, column)| (rows[row].len() - 1) * (columns[column].len() - 1));
    let mut best = None;
    for pivot in candidates {
        let served = samples.iter();
        let served = served.filter(|&&sample| large(rows, columns, pivot, sample));
        let served = served.count();
        if served == samples.len() {
            return Some(pivot);
        }
        if best.is_none_or(|(most, _)| served > most) {
            best = Some((served, pivot));
        }
    }
    best.map(|(_, pivot)| pivot)
}

/// Whether a number is large enough for a pivot, in a sample.
fn large(
    rows: &[Row],
    columns: &[BTreeSet<usize>],
    (row, column): (usize, usize),
    sample: usize,
) -> bool {
    let size = |row: usize| rows[row][&column][sample].abs();
    let most = columns[column].iter().map(|&other| size(other));
    let most = most.fold(0.0, f64::max);
    most > 0.0 && size(row) >= PIVOT * most
}

/// The matrix of a step in some combinations of modes, with the step and without it.
fn sampled_rows(model: &FixedStep<'_>) -> Vec<Row> {
    let program = model.program;
    let entries = program.partials(Function::Residual);
    let differential = differential(program);
    let mut samples = Vec::new();
    let mut partials = vec![0.0; entries.len()];
    let mut workspace = Workspace::new(program.n_work);
    let u = vec![0.0; 2 * program.columns.len()];
    for z in combinations(program, &model.start.z) {
        let at = Point {
            t: model.start_s,
            y: &model.start.y,
            yp: &model.start.yp,
            z: &z,
            u: &u,
            p: model.parameters,
        };
        let kernels = &program.kernels;
        kernels.partials(Function::Residual, at, &mut workspace, &mut partials);
        if partials.iter().all(|value| value.is_finite()) {
            samples.extend([(model.step_s, partials.clone()), (0.0, partials.clone())]);
        }
    }
    let mut rows = vec![Row::new(); program.n_unknowns];
    for (number, entry) in entries.iter().enumerate() {
        let Some((column, by_state)) = column_of(entry, &differential) else {
            continue;
        };
        let zeros = || vec![0.0; samples.len()];
        let values = rows[entry.row].entry(column).or_insert_with(zeros);
        for (value, (step_s, partials)) in values.iter_mut().zip(&samples) {
            *value += if by_state { *step_s } else { 1.0 } * partials[number];
        }
    }
    rows
}

/// The memory in all combinations of the modes and the truths that the matrix depends on; of many, those in which one differs
/// from the start.
fn combinations(program: &Program, start: &[f64]) -> Vec<Vec<f64>> {
    let switches: Vec<(usize, usize)> = program
        .kernels
        .coefficients()
        .modes
        .into_iter()
        .map(|place| {
            let automaton = program.automata.iter().find(|own| own.place == place);
            (place, automaton.map_or(2, |own| own.modes.len()))
        })
        .collect();
    let with = |z: &[f64], place: usize, value: usize| {
        let mut z = z.to_vec();
        #[allow(clippy::cast_precision_loss, reason = "the number of a mode")]
        let value = value as f64;
        z[place] = value;
        z
    };
    let count = switches
        .iter()
        .try_fold(1_usize, |all, (_, values)| all.checked_mul(*values));
    let mut found = vec![start.to_vec()];
    if count.is_some_and(|count| count <= COMBINATIONS) {
        for (place, values) in switches {
            let each = found.iter();
            let each = each.flat_map(|z| (0..values).map(move |value| with(z, place, value)));
            found = each.collect();
        }
    } else {
        let each = switches.iter();
        let each = each.flat_map(|&(place, values)| (0..values).map(move |value| (place, value)));
        let each = each.map(|(place, value)| with(start, place, value));
        found.extend(each.take(COMBINATIONS));
    }
    found
}

/// The unknown that a derivative is by or by whose rate, and whether it is by a state: the matrix takes it times the step then.
pub(crate) fn column_of(entry: &PartialEntry, differential: &[bool]) -> Option<(usize, bool)> {
    match entry.wrt {
        Wrt::Unknown(column) => Some((column, differential[column])),
        Wrt::Derivative(column) => Some((column, false)),
        Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => None,
    }
}

/// Which unknowns are states.
pub(crate) fn differential(program: &Program) -> Vec<bool> {
    let mut found = vec![false; program.n_unknowns];
    for block in program.unknowns.iter().filter(|block| block.differential) {
        found[block.offset..block.offset + block.len].fill(true);
    }
    found
}

/// The numbers below `n` that are not in a list.
fn rest(list: &[usize], n: usize) -> Vec<usize> {
    let known: BTreeSet<usize> = list.iter().copied().collect();
    (0..n).filter(|number| !known.contains(number)).collect()
}

/// The place of each number in a list of all of them.
pub(crate) fn places(list: &[usize]) -> Vec<usize> {
    let mut found = vec![0; list.len()];
    for (place, &number) in list.iter().enumerate() {
        found[number] = place;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arrow_is_eliminated_from_its_thin_end() {
        // The first row and column are full: eliminated first, they would fill the matrix.
        let row = |columns: &[usize]| columns.iter().map(|&column| (column, vec![1.0])).collect();
        let mut rows: Vec<Row> = vec![(0..6).map(|column| (column, vec![3.0])).collect()];
        rows.extend((1..6).map(|k| row(&[0, k])));
        let order = Elimination::of_rows(rows);
        assert_eq!(order.equations[..4], order.unknowns[..4]);
        assert!(!order.equations[..4].contains(&0), "{order:?}");
        let mut all = order.unknowns.clone();
        all.sort_unstable();
        assert_eq!(all, (0..6).collect::<Vec<usize>>());
        let places = places(&order.equations);
        assert!(
            order
                .equations
                .iter()
                .enumerate()
                .all(|(k, &row)| places[row] == k)
        );
    }

    #[test]
    fn a_pivot_is_large_in_every_sample() {
        // The cheapest pivot of the first row is zero in the second sample.
        let rows = vec![
            Row::from([(0, vec![1.0, 0.0]), (1, vec![1.0, 1.0])]),
            Row::from([(0, vec![1.0, 1.0]), (1, vec![0.0, 1.0])]),
        ];
        let order = Elimination::of_rows(rows);
        let mut pairs: Vec<_> = order.equations.iter().zip(&order.unknowns).collect();
        pairs.sort_unstable();
        assert_eq!(pairs, [(&0, &1), (&1, &0)]);
    }

    #[test]
    fn a_singular_structure_still_has_every_number_once() {
        let order = Elimination::of_rows(vec![Row::from([(0, vec![1.0])]), Row::new()]);
        assert_eq!(order.equations, [0, 1]);
        assert_eq!(order.unknowns, [0, 1]);
    }
}
