//! The union sparsity of all modes, and how derivatives of the residual fall into it.

use std::ops::Range;

/// A derivative of the residual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JacobianEntry {
    /// Row of the residual.
    pub row: usize,
    /// Unknown.
    pub column: usize,
    /// By the derivative of the unknown rather than by the unknown.
    pub by_derivative: bool,
}

/// Positions of the residual's derivatives in a compressed-column matrix. Positions are data, not code: the kernel writes
/// its values in any order.
#[derive(Clone, Debug, Default)]
pub struct Jacobian {
    /// Position in `rows` where each column starts, and their end.
    pub column_starts: Vec<i64>,
    /// Row of each entry, ascending within a column.
    pub rows: Vec<i64>,
    /// Column of each entry.
    columns: Vec<u32>,
    /// The values of the kernel, stretch after stretch.
    stretches: Vec<Stretch>,
    /// Entry that each value of the kernel is added to.
    positions: Vec<u32>,
}

/// Successive values of the kernel.
#[derive(Clone, Debug)]
struct Stretch {
    /// The first value, and how many there are.
    first: usize,
    len: usize,
    by_derivative: bool,
    cells: Cells,
}

/// Where the values of a stretch stand.
#[derive(Clone, Debug)]
enum Cells {
    /// Each one row below and one column to the right of the one before, as an array of equations has them.
    Diagonal { row: usize, column: usize },
    /// Row and column of each.
    Any(Vec<(u32, u32)>),
}

/// So many values are a diagonal of their own; fewer are not worth its start.
const SHORTEST_DIAGONAL: usize = 8;

impl Jacobian {
    /// The pattern of `n` unknowns from the derivatives in the order the kernel writes them, with more cells (row, column)
    /// that some mode of the run fills. Every diagonal entry is part of the pattern, for in some mode it is the pivot.
    #[must_use]
    pub fn new(n: usize, entries: &[JacobianEntry], more: &[(usize, usize)]) -> Self {
        let mut cells: Vec<(usize, usize)> = entries
            .iter()
            .map(|entry| (entry.column, entry.row))
            .collect();
        cells.extend((0..n).map(|diagonal| (diagonal, diagonal)));
        cells.extend(more.iter().map(|&(row, column)| (column, row)));
        cells.sort_unstable();
        cells.dedup();
        let mut column_starts = vec![0_i64; n + 1];
        for &(column, _) in &cells {
            column_starts[column + 1] += 1;
        }
        for column in 0..n {
            column_starts[column + 1] += column_starts[column];
        }
        let to_i64 = |value: usize| i64::try_from(value).unwrap_or(i64::MAX);
        let rows = cells.iter().map(|&(_, row)| to_i64(row)).collect();
        let columns = cells
            .iter()
            .map(|&(column, _)| u32::try_from(column).unwrap_or(u32::MAX))
            .collect();
        let find =
            |entry: &JacobianEntry| cells.binary_search(&(entry.column, entry.row)).unwrap_or(0);
        let positions = entries
            .iter()
            .map(|entry| u32::try_from(find(entry)).unwrap_or(u32::MAX))
            .collect();
        Self {
            column_starts,
            rows,
            columns,
            stretches: stretches(entries),
            positions,
        }
    }

    /// Position of an entry of the matrix; `None` where the pattern has none.
    #[must_use]
    pub fn position(&self, row: usize, column: usize) -> Option<usize> {
        let at = |start: i64| usize::try_from(start).ok();
        let (first, end) = (
            at(*self.column_starts.get(column)?)?,
            at(*self.column_starts.get(column + 1)?)?,
        );
        let row = i64::try_from(row).ok()?;
        let inside = self.rows[first..end].binary_search(&row).ok()?;
        Some(first + inside)
    }

    /// The entries of a row: column and position.
    #[must_use]
    pub fn row(&self, row: usize) -> Vec<(usize, usize)> {
        let columns = 0..self.column_starts.len().saturating_sub(1);
        columns
            .filter_map(|column| Some((column, self.position(row, column)?)))
            .collect()
    }

    /// Number of entries of the matrix.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether the matrix has no entries.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// `alpha*dF/dy + cj*dF/dy'` from the kernel's values.
    pub fn assemble(&self, values: &[f64], alpha: f64, cj: f64, matrix: &mut [f64]) {
        matrix.iter_mut().for_each(|entry| *entry = 0.0);
        for stretch in &self.stretches {
            let factor = if stretch.by_derivative { cj } else { alpha };
            let run = stretch.range();
            for (&position, &value) in self.positions[run.clone()].iter().zip(&values[run]) {
                matrix[position as usize] += factor * value;
            }
        }
    }

    /// Adds up the products of each row: of the derivatives and the entries of a vector, or of its rate.
    pub fn products(
        &self,
        values: &[f64],
        (by_value, by_rate): (&[f64], &[f64]),
        rows: &mut [f64],
        add: impl Fn(&mut f64, f64),
    ) {
        for stretch in &self.stretches {
            let vector = match stretch.by_derivative {
                true => by_rate,
                false => by_value,
            };
            let values = &values[stretch.range()];
            match &stretch.cells {
                Cells::Diagonal { row, column } => {
                    let factors = values.iter().zip(&vector[*column..]);
                    for (row, (value, factor)) in rows[*row..].iter_mut().zip(factors) {
                        add(row, value * factor);
                    }
                }
                Cells::Any(cells) => {
                    for (&(row, column), &value) in cells.iter().zip(values) {
                        add(&mut rows[row as usize], value * vector[column as usize]);
                    }
                }
            }
        }
    }

    /// The matrix that consistent initial conditions solve with: columns of `dF/dy'` for differential unknowns, of
    /// `dF/dy` for the others.
    pub fn assemble_consistent(&self, values: &[f64], differential: &[bool], matrix: &mut [f64]) {
        matrix.iter_mut().for_each(|entry| *entry = 0.0);
        for stretch in &self.stretches {
            let run = stretch.range();
            for (&position, &value) in self.positions[run.clone()].iter().zip(&values[run]) {
                let position = position as usize;
                if differential[self.columns[position] as usize] == stretch.by_derivative {
                    matrix[position] += value;
                }
            }
        }
    }
}

impl Stretch {
    /// Its values among those of the kernel.
    fn range(&self) -> Range<usize> {
        self.first..self.first + self.len
    }
}

/// The entries in stretches: every diagonal is one, what stands between two of them another one.
fn stretches(entries: &[JacobianEntry]) -> Vec<Stretch> {
    let follows = |(one, next): (&JacobianEntry, &JacobianEntry)| {
        (next.row, next.column) == (one.row + 1, one.column + 1)
            && next.by_derivative == one.by_derivative
    };
    let to_u32 = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
    let mut found: Vec<Stretch> = Vec::new();
    let mut first = 0;
    while let Some(entry) = entries.get(first) {
        let rest = &entries[first..];
        let len = 1 + rest
            .iter()
            .zip(&rest[1..])
            .take_while(|&pair| follows(pair))
            .count();
        let JacobianEntry {
            row,
            column,
            by_derivative,
        } = *entry;
        let is_diagonal = len >= SHORTEST_DIAGONAL;
        let cells = rest[..len]
            .iter()
            .map(|own| (to_u32(own.row), to_u32(own.column)));
        match found.last_mut() {
            Some(Stretch {
                len: before,
                by_derivative: of_before,
                cells: Cells::Any(all),
                ..
            }) if !is_diagonal && *of_before == by_derivative => {
                *before += len;
                all.extend(cells);
            }
            _ => found.push(Stretch {
                first,
                len,
                by_derivative,
                cells: match is_diagonal {
                    true => Cells::Diagonal { row, column },
                    false => Cells::Any(cells.collect()),
                },
            }),
        }
        first += len;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_fall_where_they_belong() {
        let entry = |row, column, by_derivative| JacobianEntry {
            row,
            column,
            by_derivative,
        };
        let jacobian = Jacobian::new(
            2,
            &[
                entry(0, 1, false),
                entry(0, 0, true),
                entry(0, 0, false),
                entry(1, 0, false),
            ],
            &[(0, 1), (1, 1)],
        );
        assert_eq!(jacobian.column_starts, vec![0, 2, 4]);
        assert_eq!(jacobian.row(1), vec![(0, 1), (1, 3)]);
        assert_eq!(jacobian.position(0, 2), None);
        assert_eq!(jacobian.rows, vec![0, 1, 0, 1]);
        let mut matrix = vec![9.0; 4];
        jacobian.assemble(&[5.0, 2.0, 3.0, 7.0], 1.0, 10.0, &mut matrix);
        assert_eq!(matrix, vec![23.0, 7.0, 5.0, 0.0]);
        jacobian.assemble_consistent(&[5.0, 2.0, 3.0, 7.0], &[true, false], &mut matrix);
        assert_eq!(matrix, vec![2.0, 0.0, 5.0, 0.0]);
    }

    #[test]
    fn products_of_diagonals_are_those_of_their_entries() {
        // Three rows of single entries around two diagonals, one of them by derivatives.
        let mut cells = vec![(4, 2, false), (4, 5, true)];
        cells.extend((0..12).map(|k| (k, k + 1, false)));
        cells.extend((0..9).map(|k| (k + 3, k, true)));
        cells.push((12, 0, true));
        let entry = |&(row, column, by_derivative): &(usize, usize, bool)| JacobianEntry {
            row,
            column,
            by_derivative,
        };
        let entries: Vec<JacobianEntry> = cells.iter().map(entry).collect();
        let jacobian = Jacobian::new(13, &entries, &[]);
        let of_diagonals = jacobian
            .stretches
            .iter()
            .filter(|stretch| matches!(stretch.cells, Cells::Diagonal { .. }));
        assert_eq!(
            of_diagonals.map(|stretch| stretch.len).collect::<Vec<_>>(),
            [12, 9]
        );
        let numbered = |n: usize| -> Vec<f64> { (0..n).map(|k| (k as f64).sin()).collect() };
        let (values, y) = (numbered(cells.len()), numbered(13));
        let yp: Vec<f64> = y.iter().map(|value| 1.0 - value).collect();
        let mut expected = vec![0.0; 13];
        for (&(row, column, by_derivative), value) in cells.iter().zip(&values) {
            expected[row] += value * if by_derivative { yp[column] } else { y[column] };
        }
        let mut rows = vec![0.0; 13];
        jacobian.products(&values, (&y, &yp), &mut rows, |row, product| {
            *row += product
        });
        assert_eq!(rows, expected);
    }
}
