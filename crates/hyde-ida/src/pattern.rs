//! The sparsity pattern of the Jacobian, in compressed columns.

/// Where a square matrix may have entries: compressed columns with ascending rows.
///
/// Column `j` has the rows `rows[column_starts[j] .. column_starts[j + 1]]`; the values of a matrix with this pattern
/// are a slice in the order of `rows`. One pattern serves all modes of a model: it is the union of theirs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pattern {
    column_starts: Vec<i64>,
    rows: Vec<i64>,
}

/// Why a pattern was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatternError {
    /// There are no unknowns; IDA has nothing to solve for.
    NoUnknowns,
    /// `column_starts` is not `n + 1` numbers that begin with 0, never fall, and end with the number of rows given.
    ColumnStarts,
    /// A row index in this column is not in `0 .. n`.
    RowOutside {
        /// The column.
        column: usize,
    },
    /// The rows of this column do not ascend strictly.
    RowsNotAscending {
        /// The column.
        column: usize,
    },
}

impl Pattern {
    /// A pattern of `n` unknowns from its compressed columns.
    ///
    /// An empty row or column is accepted: the matrix is then singular, and said to be when it is factored.
    ///
    /// # Errors
    /// [`PatternError`] if there are no unknowns or the arrays are not well-formed.
    pub fn new(n: usize, column_starts: Vec<i64>, rows: Vec<i64>) -> Result<Self, PatternError> {
        if n == 0 {
            return Err(PatternError::NoUnknowns);
        }
        let ends_fit = column_starts.first() == Some(&0)
            && column_starts
                .last()
                .is_some_and(|&end| usize::try_from(end) == Ok(rows.len()));
        if column_starts.len() != n + 1 || !ends_fit || !column_starts.is_sorted() {
            return Err(PatternError::ColumnStarts);
        }
        let pattern = Self {
            column_starts,
            rows,
        };
        for column in 0..n {
            let rows = &pattern.rows[pattern.entries_of(column)];
            if rows
                .iter()
                .any(|&row| usize::try_from(row).map_or(true, |row| row >= n))
            {
                return Err(PatternError::RowOutside { column });
            }
            if !rows.is_sorted_by(|a, b| a < b) {
                return Err(PatternError::RowsNotAscending { column });
            }
        }
        Ok(pattern)
    }

    /// The full pattern of `n` unknowns; its values are a matrix by columns.
    ///
    /// # Errors
    /// [`PatternError::NoUnknowns`] if `n` is 0.
    pub fn dense(n: usize) -> Result<Self, PatternError> {
        let rows = (0..n).flat_map(|_| (0..n).map(|row| row as i64)).collect();
        Self::new(n, (0..=n).map(|column| (column * n) as i64).collect(), rows)
    }

    /// The number of unknowns, and of equations.
    #[must_use]
    pub fn n(&self) -> usize {
        self.column_starts.len() - 1
    }

    /// The number of entries, which is the length of a slice of values.
    #[must_use]
    pub fn n_entries(&self) -> usize {
        self.rows.len()
    }

    /// Where each column starts in [`rows`](Self::rows), and the number of entries at the end.
    #[must_use]
    pub fn column_starts(&self) -> &[i64] {
        &self.column_starts
    }

    /// The row of each entry.
    #[must_use]
    pub fn rows(&self) -> &[i64] {
        &self.rows
    }

    /// The entries as (row, column, position in the values), by columns.
    pub fn entries(&self) -> impl Iterator<Item = (usize, usize, usize)> + '_ {
        (0..self.n()).flat_map(move |column| {
            self.entries_of(column)
                .map(move |entry| (self.rows[entry] as usize, column, entry))
        })
    }

    fn entries_of(&self, column: usize) -> std::ops::Range<usize> {
        self.column_starts[column] as usize..self.column_starts[column + 1] as usize
    }
}

impl std::fmt::Display for PatternError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoUnknowns => write!(
                f,
                "the system has no unknowns: there is nothing for IDA to solve"
            ),
            Self::ColumnStarts => {
                write!(
                    f,
                    "the column starts do not run from 0 to the number of entries, one for each unknown and one more"
                )
            }
            Self::RowOutside { column } => {
                write!(f, "column {column} has a row index outside the matrix")
            }
            Self::RowsNotAscending { column } => {
                write!(f, "the rows of column {column} do not ascend strictly")
            }
        }
    }
}

impl std::error::Error for PatternError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn well_formed_patterns_are_taken_apart_by_columns() {
        let pattern = Pattern::new(3, vec![0, 2, 2, 3], vec![0, 2, 1]).unwrap();
        assert_eq!((pattern.n(), pattern.n_entries()), (3, 3));
        let entries: Vec<_> = pattern.entries().collect();
        assert_eq!(entries, [(0, 0, 0), (2, 0, 1), (1, 2, 2)]);
        let dense = Pattern::dense(2).unwrap();
        assert_eq!(
            dense,
            Pattern::new(2, vec![0, 2, 4], vec![0, 1, 0, 1]).unwrap()
        );
    }

    #[test]
    fn others_are_refused() {
        let refused = |n, starts: &[i64], rows: &[i64]| {
            Pattern::new(n, starts.to_vec(), rows.to_vec()).unwrap_err()
        };
        assert_eq!(refused(0, &[0], &[]), PatternError::NoUnknowns);
        assert_eq!(Pattern::dense(0).unwrap_err(), PatternError::NoUnknowns);
        for starts in [&[0, 1][..], &[1, 1, 2], &[0, 1, 3], &[0, 3, 2], &[]] {
            assert_eq!(
                refused(2, starts, &[0, 1]),
                PatternError::ColumnStarts,
                "{starts:?}"
            );
        }
        for row in [-1, 2] {
            let error = refused(2, &[0, 1, 2], &[0, row]);
            assert_eq!(error, PatternError::RowOutside { column: 1 });
        }
        for rows in [[0, 1, 0], [0, 1, 1]] {
            let error = refused(2, &[0, 1, 3], &rows);
            assert_eq!(error, PatternError::RowsNotAscending { column: 1 });
        }
    }
}
