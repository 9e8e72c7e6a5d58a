//! The union sparsity of all modes, and how derivatives of the residual fall into it.

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
    /// For each run of values of the kernel: first value, number, whether by derivatives.
    runs: Vec<(usize, usize, bool)>,
    /// Entry that each value of the kernel is added to.
    positions: Vec<u32>,
    /// Row and column of each value of the kernel.
    cells: Vec<(u32, u32)>,
}

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
        let mut runs: Vec<(usize, usize, bool)> = Vec::new();
        for (number, entry) in entries.iter().enumerate() {
            match runs.last_mut() {
                Some((_, len, by_derivative)) if *by_derivative == entry.by_derivative => *len += 1,
                _ => runs.push((number, 1, entry.by_derivative)),
            }
        }
        let to_u32 = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
        let cell = |entry: &JacobianEntry| (to_u32(entry.row), to_u32(entry.column));
        Self {
            column_starts,
            rows,
            columns,
            runs,
            positions,
            cells: entries.iter().map(cell).collect(),
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
        for &(first, len, by_derivative) in &self.runs {
            let factor = if by_derivative { cj } else { alpha };
            let run = first..first + len;
            for (&position, &value) in self.positions[run.clone()].iter().zip(&values[run]) {
                matrix[position as usize] += factor * value;
            }
        }
    }

    /// Each derivative times what it is by: gives the row and the product of an entry of a vector or of its rate.
    pub fn products(
        &self,
        values: &[f64],
        (by_value, by_rate): (&[f64], &[f64]),
        mut give: impl FnMut(usize, f64),
    ) {
        for &(first, len, by_derivative) in &self.runs {
            let vector = if by_derivative { by_rate } else { by_value };
            let run = first..first + len;
            for (&(row, column), &value) in self.cells[run.clone()].iter().zip(&values[run]) {
                give(row as usize, value * vector[column as usize]);
            }
        }
    }

    /// The matrix that consistent initial conditions solve with: columns of `dF/dy'` for differential unknowns, of
    /// `dF/dy` for the others.
    pub fn assemble_consistent(&self, values: &[f64], differential: &[bool], matrix: &mut [f64]) {
        matrix.iter_mut().for_each(|entry| *entry = 0.0);
        for &(first, len, by_derivative) in &self.runs {
            let run = first..first + len;
            for (&position, &value) in self.positions[run.clone()].iter().zip(&values[run]) {
                let position = position as usize;
                if differential[self.columns[position] as usize] == by_derivative {
                    matrix[position] += value;
                }
            }
        }
    }
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
}
