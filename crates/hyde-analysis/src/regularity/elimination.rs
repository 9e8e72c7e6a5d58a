//! Which rows of a sparse matrix depend on each other, by exact elimination.

use super::residue::{Generic, Residue};
use std::collections::{BTreeMap, BTreeSet};

/// A sparse row: column and entry.
pub(crate) type Row = BTreeMap<usize, Residue>;

/// The rows of a basis of all combinations that give zero, each as few as the others allow: a set that depends on each
/// other, and would not without any one of it.
pub(crate) fn dependent_sets(rows: &[Row]) -> Vec<Vec<usize>> {
    let found = combinations(rows).into_iter();
    found.map(|set| set.into_keys().collect()).collect()
}

/// The same with their factors, by the numbers of the rows. The last row of each is in none of the others.
pub(crate) fn combinations(rows: &[Row]) -> Vec<Row> {
    if eliminate(rows, false).vanished.is_empty() {
        return Vec::new();
    }
    let mut found = eliminate(rows, true).vanished;
    // Each set keeps a row of its own: the others are freed of it.
    for number in 0..found.len() {
        let Some((&pivot, &entry)) = found[number].iter().next_back() else {
            continue;
        };
        let Some(inverse) = entry.inverse() else {
            continue;
        };
        let own = found[number].clone();
        for (other, row) in found.iter_mut().enumerate() {
            if let (true, Some(&value)) = (other != number, row.get(&pivot)) {
                subtract(row, &own, value.times(inverse));
            }
        }
    }
    found
}

/// The columns whose combination gives zero: the same of the transposed matrix.
pub(crate) fn dependent_columns(rows: &[Row], columns: usize) -> Vec<Vec<usize>> {
    dependent_sets(&transposed(rows, columns))
}

/// The columns that are in any combination of columns that gives zero: those that are not zero in a generic one, from
/// which the pivots' rows are solved backward.
pub(crate) fn free_columns(rows: &[Row], columns: usize) -> BTreeSet<usize> {
    let pivots = eliminate(rows, false).pivots;
    let mut generic = Generic::new();
    let mut values: Vec<Residue> = (0..columns).map(|_| generic.next()).collect();
    for (column, row) in pivots.iter().rev() {
        let inverse = row.get(column).and_then(|entry| entry.inverse());
        let others = row.iter().filter(|(other, _)| *other != column);
        let sum = others.fold(Residue::ZERO, |sum, (&other, &entry)| {
            sum.plus(entry.times(values[other]))
        });
        values[*column] = Residue::ZERO.minus(sum.times(inverse.unwrap_or(Residue::ZERO)));
    }
    let columns = values.iter().enumerate();
    let free = columns.filter(|(_, value)| **value != Residue::ZERO);
    free.map(|(column, _)| column).collect()
}

fn transposed(rows: &[Row], columns: usize) -> Vec<Row> {
    let mut transposed = vec![Row::new(); columns];
    for (number, row) in rows.iter().enumerate() {
        for (&column, &entry) in row {
            transposed[column].insert(number, entry);
        }
    }
    transposed
}

/// What an elimination leaves.
struct Eliminated {
    /// A combination of rows for each row that vanishes, an empty one where they are not asked for.
    vanished: Vec<Row>,
    /// In the order of the elimination: the column of each pivot and its row, without the columns eliminated before.
    pivots: Vec<(usize, Row)>,
}

/// Gauss's elimination in the order of Markowitz (Duff, Erisman and Reid, Direct Methods for Sparse Matrices, §7.2): a
/// column with one row first, else the shortest row and in it the shortest column.
fn eliminate(rows: &[Row], combinations: bool) -> Eliminated {
    let mut rows: Vec<Row> = rows.to_vec();
    let mut made_of: Vec<Row> = (0..rows.len())
        .map(|number| match combinations {
            true => Row::from([(number, Residue::ONE)]),
            false => Row::new(),
        })
        .collect();
    let mut readers: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for (number, row) in rows.iter().enumerate() {
        for &column in row.keys() {
            readers.entry(column).or_default().insert(number);
        }
    }
    let alone = |readers: &BTreeMap<usize, BTreeSet<usize>>| -> Vec<usize> {
        let single = readers.iter().filter(|(_, list)| list.len() == 1);
        single.map(|(&column, _)| column).collect()
    };
    let mut single: Vec<usize> = alone(&readers);
    let mut by_length: BTreeSet<(usize, usize)> = rows
        .iter()
        .enumerate()
        .map(|(number, row)| (row.len(), number))
        .collect();
    let (mut vanished, mut pivots) = (Vec::new(), Vec::new());
    loop {
        let free = single.pop().and_then(|column| {
            let list = readers.get(&column)?;
            (list.len() == 1).then(|| list.first().map(|&row| (row, column)))?
        });
        let (pivot, column) = match free {
            Some(found) => found,
            None if !single.is_empty() => continue,
            None => {
                let Some(&(length, number)) = by_length.first() else {
                    return Eliminated { vanished, pivots };
                };
                if length == 0 {
                    by_length.pop_first();
                    vanished.push(std::mem::take(&mut made_of[number]));
                    continue;
                }
                let shortest = rows[number].keys().min_by_key(|&column| {
                    let readers = readers.get(column).map_or(0, BTreeSet::len);
                    (readers, *column)
                });
                let Some(&column) = shortest else { continue };
                (number, column)
            }
        };
        by_length.remove(&(rows[pivot].len(), pivot));
        let own = std::mem::take(&mut rows[pivot]);
        for column in own.keys() {
            if let Some(list) = readers.get_mut(column) {
                list.remove(&pivot);
                if list.len() == 1 {
                    single.push(*column);
                }
            }
        }
        let others = readers.remove(&column).unwrap_or_default();
        let Some(inverse) = own.get(&column).and_then(|entry| entry.inverse()) else {
            continue;
        };
        for other in others {
            let factor = rows[other]
                .get(&column)
                .map_or(Residue::ZERO, |entry| entry.times(inverse));
            by_length.remove(&(rows[other].len(), other));
            subtract(&mut rows[other], &own, factor);
            rows[other].remove(&column);
            for changed in own.keys().filter(|&&changed| changed != column) {
                let list = readers.entry(*changed).or_default();
                match rows[other].contains_key(changed) {
                    true => list.insert(other),
                    false => list.remove(&other),
                };
                if list.len() == 1 {
                    single.push(*changed);
                }
            }
            by_length.insert((rows[other].len(), other));
            if combinations {
                let combination = made_of[pivot].clone();
                subtract(&mut made_of[other], &combination, factor);
            }
        }
        pivots.push((column, own));
    }
}

/// `row - factor*other`, without the entries that vanish.
fn subtract(row: &mut Row, other: &Row, factor: Residue) {
    for (&column, &entry) in other {
        let before = row.get(&column).copied().unwrap_or(Residue::ZERO);
        let after = before.minus(entry.times(factor));
        if after == Residue::ZERO {
            row.remove(&column);
        } else {
            row.insert(column, after);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(list: &[&[(usize, f64)]]) -> Vec<Row> {
        let of = |&(column, value): &(usize, f64)| (column, Residue::of(value).unwrap());
        list.iter()
            .map(|row| row.iter().map(of).collect())
            .collect()
    }

    #[test]
    fn the_rows_that_depend_on_each_other_are_found_and_no_others() {
        // Rows 0 and 3 are proportional; row 1 is alone with column 2; row 2 is apart.
        let matrix = rows(&[
            &[(0, 1.0), (1, -2.0)],
            &[(1, 3.0), (2, 0.1)],
            &[(3, 1.0)],
            &[(0, -0.5), (1, 1.0)],
        ]);
        assert_eq!(dependent_sets(&matrix), [vec![0, 3]]);
        // Its columns 0, 1 and 2 can move together: 2, 1, -30.
        assert_eq!(dependent_columns(&matrix, 4), [vec![0, 1, 2]]);
        assert_eq!(free_columns(&matrix, 4), BTreeSet::from([0, 1, 2]));
        let regular = rows(&[&[(0, 1.0), (1, 1.0)], &[(0, 1.0), (1, 1.000_000_000_1)]]);
        assert!(dependent_sets(&regular).is_empty());
    }

    #[test]
    fn a_ring_of_sums_depends_as_a_whole() {
        // x0 - x1, x1 - x2, x2 - x0: their sum vanishes, and all columns may move by the same.
        let ring = rows(&[
            &[(0, 1.0), (1, -1.0)],
            &[(1, 1.0), (2, -1.0)],
            &[(2, 1.0), (0, -1.0)],
        ]);
        assert_eq!(dependent_sets(&ring), [vec![0, 1, 2]]);
        assert_eq!(dependent_columns(&ring, 3), [vec![0, 1, 2]]);
    }
}
