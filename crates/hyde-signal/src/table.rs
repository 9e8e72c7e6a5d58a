//! Equally long columns over one time.

use crate::{Column, Signal};
use hyde_units::{Agreement, Dimension};
use std::collections::BTreeMap;
use std::fmt;

/// A record: columns of equal length, and the instants of their rows.
///
/// A measured frequency response is a table too: what is said of time is frequency then.
///
/// The instants are the first column, or `k * period` if a period was declared; then all columns are ordinary ones.
/// Time never runs back; an instant may have several rows, as results have two at an event.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
    declared: Option<Declared>,
}

#[derive(Clone, Debug, PartialEq)]
struct Declared {
    period_s: f64,
    instants_s: Vec<f64>,
}

/// Why columns do not make a table.
#[derive(Clone, Debug, PartialEq)]
pub enum TableError {
    /// There is no column, or there are no rows.
    Empty,
    /// A column has another number of rows than the first.
    UnequalLength {
        /// The column.
        name: String,
        /// Its rows.
        rows: usize,
        /// The rows of the first column.
        expected: usize,
    },
    /// Two columns have one name.
    DuplicateName {
        /// The name.
        name: String,
        /// The two columns, from 1.
        columns: (usize, usize),
    },
    /// The time of a row is before that of the row above it, or not a number.
    TimeRunsBack {
        /// The row, from 1.
        row: usize,
        /// Its time in s.
        time_s: f64,
    },
    /// The declared period is not a positive number.
    Period {
        /// The period in s.
        period_s: f64,
    },
}

impl Table {
    /// A table whose first column is the time in s.
    ///
    /// # Errors
    /// If the columns do not make a table.
    pub fn new(columns: Vec<Column>) -> Result<Self, TableError> {
        check_columns(&columns)?;
        let time = columns[0].values();
        let not_a_number = time.iter().position(|instant| instant.is_nan());
        let back = || (1..time.len()).find(|&row| time[row] < time[row - 1]);
        if let Some(row) = not_a_number.or_else(back) {
            return Err(TableError::TimeRunsBack {
                row: row + 1,
                time_s: time[row],
            });
        }
        Ok(Self {
            columns,
            declared: None,
        })
    }

    /// A table whose row k, from 0, is at `k * period_s`; all columns are ordinary ones.
    ///
    /// # Errors
    /// If the columns do not make a table or the period is not a positive number of seconds.
    pub fn every(period_s: f64, columns: Vec<Column>) -> Result<Self, TableError> {
        check_columns(&columns)?;
        if !(period_s > 0.0 && period_s.is_finite()) {
            return Err(TableError::Period { period_s });
        }
        let rows = columns[0].values().len();
        let instants_s = (0..rows).map(|k| k as f64 * period_s).collect();
        Ok(Self {
            columns,
            declared: Some(Declared {
                period_s,
                instants_s,
            }),
        })
    }

    /// How many rows there are; at least one.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns[0].values().len()
    }

    /// The instants of the rows in s, never running back.
    #[must_use]
    pub fn time(&self) -> &[f64] {
        match &self.declared {
            Some(declared) => &declared.instants_s,
            None => self.columns[0].values(),
        }
    }

    /// The declared period in s, if time is not a column.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        self.declared.as_ref().map(|declared| declared.period_s)
    }

    /// The mean distance of rows in s: the sampling period of a record whose clock drifts. None for a single instant.
    #[must_use]
    pub fn mean_step(&self) -> Option<f64> {
        let time = self.time();
        let span = time[time.len() - 1] - time[0];
        let steps = (time.len() - 1) as f64;
        (span > 0.0).then(|| self.period().unwrap_or(span / steps))
    }

    /// All columns in order; the time is the first of them unless a period was declared.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The column of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name() == name)
    }

    /// The column of that name over the time.
    #[must_use]
    pub fn signal(&self, name: &str) -> Option<Signal<'_>> {
        Signal::new(self.time(), self.column(name)?.values())
    }
}

/// Whether a first column of that dimension can be what rows are over: time, or the frequency of a measured response.
pub(crate) fn may_be_first(dimension: Dimension) -> bool {
    let same = |other: Dimension| dimension.agreement(other) == Agreement::Same;
    same(Dimension::TIME) || same(Dimension::FREQUENCY)
}

impl fmt::Display for TableError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the table has no rows"),
            Self::UnequalLength {
                name,
                rows,
                expected,
            } => {
                write!(
                    f,
                    "column `{name}` has {rows} rows, the first column has {expected}"
                )
            }
            Self::DuplicateName {
                name,
                columns: (first, second),
            } => {
                write!(f, "columns {first} and {second} are both named `{name}`")
            }
            Self::TimeRunsBack { row, time_s } => {
                write!(f, "time runs back to {time_s} s in row {row}")
            }
            Self::Period { period_s } => write!(f, "a period of {period_s} s is not positive"),
        }
    }
}

impl std::error::Error for TableError {}

fn check_columns(columns: &[Column]) -> Result<(), TableError> {
    let expected = columns.first().map_or(0, |column| column.values().len());
    if expected == 0 {
        return Err(TableError::Empty);
    }
    let mut names = BTreeMap::new();
    for (at, column) in columns.iter().enumerate() {
        let (name, rows) = (column.name(), column.values().len());
        if rows != expected {
            return Err(TableError::UnequalLength {
                name: name.to_owned(),
                rows,
                expected,
            });
        }
        if let Some(first) = names.insert(name, at + 1) {
            let columns = (first, at + 1);
            return Err(TableError::DuplicateName {
                name: name.to_owned(),
                columns,
            });
        }
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "tables keep values as they are")]
mod tests {
    use super::*;

    fn column(name: &str, values: &[f64]) -> Column {
        Column::raw(name, values.to_vec())
    }

    #[test]
    fn the_first_column_is_the_time() {
        let table = Table::new(vec![
            column("t", &[0.0, 0.5, 0.5, 1.5]),
            column("x", &[1.0; 4]),
        ])
        .unwrap();
        assert_eq!(table.time(), [0.0, 0.5, 0.5, 1.5]);
        assert_eq!(table.rows(), 4);
        assert_eq!(table.mean_step(), Some(0.5));
        assert_eq!(table.period(), None);
        assert!(table.column("y").is_none());
    }

    #[test]
    fn a_declared_period_makes_the_instants() {
        let table = Table::every(0.001, vec![column("t", &[7.0, 3.0, 5.0])]).unwrap();
        assert_eq!(table.time(), [0.0, 0.001, 0.002]);
        assert_eq!(table.column("t").unwrap().values(), [7.0, 3.0, 5.0]);
        assert_eq!(table.mean_step(), Some(0.001));
    }

    #[test]
    fn what_is_no_table_is_refused() {
        let t = column("t", &[0.0, 1.0]);
        let message = |columns| Table::new(columns).unwrap_err().to_string();
        assert_eq!(message(vec![]), "the table has no rows");
        assert_eq!(message(vec![column("t", &[])]), "the table has no rows");
        assert_eq!(
            message(vec![t.clone(), column("x", &[1.0])]),
            "column `x` has 1 rows, the first column has 2"
        );
        assert_eq!(
            message(vec![t.clone(), t.clone()]),
            "columns 1 and 2 are both named `t`"
        );
        assert_eq!(
            message(vec![column("t", &[1.0, 0.5])]),
            "time runs back to 0.5 s in row 2"
        );
        assert_eq!(
            message(vec![column("t", &[f64::NAN])]),
            "time runs back to NaN s in row 1"
        );
        let error = Table::every(0.0, vec![t]).unwrap_err();
        assert_eq!(error.to_string(), "a period of 0 s is not positive");
    }
}
