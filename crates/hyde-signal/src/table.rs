//! Equally long columns over one time.

mod parts;

use crate::layout::Kind;
use crate::{Column, Note, Origin, Signal, Unusable};
use hyde_units::{Agreement, Dimension};
use std::collections::BTreeMap;
use std::fmt;

/// A record: columns of equal length, and the instants of their rows.
///
/// A measured frequency response is a table too: what is said of time is frequency then.
///
/// The instants are one of the columns, as a rule the first, or `k * period` if a period was declared; then all columns are
/// ordinary ones. Time never runs back; an instant may have several rows, as results have two at an event.
///
/// Channels of one file may have other rates: these are tables of their own, [`others`](Self::others), and
/// [`holding`](Self::holding) finds the one that has a column.
///
/// What a reader found out about the file goes with it: [`notes`](Self::notes), and the columns that nobody can use.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    columns: Vec<Column>,
    time: Time,
    notes: Vec<Note>,
    unusable: Vec<Unusable>,
    origin: Option<Origin>,
    others: Vec<Table>,
    layout: Option<Kind>,
}

#[derive(Clone, Debug, PartialEq)]
enum Time {
    /// The column of that number, from 0.
    Column(usize),
    /// A declared period, with the instants of all rows.
    Every(f64, Vec<f64>),
}

/// Why columns do not make a table.
#[derive(Clone, Debug, PartialEq)]
pub enum TableError {
    /// There is no column, or there are no rows.
    Empty,
    /// None of the columns can be used: what is wrong with the first.
    NoneUsable(String),
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
        Self::with_time(columns, 0)
    }

    /// A table whose column `time` (from 0) is the time in s.
    pub(crate) fn with_time(columns: Vec<Column>, at: usize) -> Result<Self, TableError> {
        check_columns(&columns)?;
        let time = columns[at].values();
        let not_a_number = time.iter().position(|instant| instant.is_nan());
        let back = || (1..time.len()).find(|&row| time[row] < time[row - 1]);
        if let Some(row) = not_a_number.or_else(back) {
            return Err(TableError::TimeRunsBack {
                row: row + 1,
                time_s: time[row],
            });
        }
        Ok(Self::of(columns, Time::Column(at)))
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
        Ok(Self::of(columns, Time::Every(period_s, instants_s)))
    }

    fn of(columns: Vec<Column>, time: Time) -> Self {
        Self {
            columns,
            time,
            notes: Vec::new(),
            unusable: Vec::new(),
            origin: None,
            others: Vec::new(),
            layout: None,
        }
    }

    /// The kind of layout that its file had, unless it was Parquet.
    #[must_use]
    pub fn layout(&self) -> Option<Kind> {
        self.layout
    }

    /// The same with the layout of its text.
    pub(crate) fn laid_out(self, kind: Kind) -> Self {
        Self {
            layout: Some(kind),
            ..self
        }
    }

    /// The same with what its reader found out.
    pub(crate) fn with_findings(
        self,
        notes: Vec<Note>,
        unusable: Vec<Unusable>,
        origin: Option<Origin>,
    ) -> Self {
        Self {
            notes,
            unusable,
            origin,
            ..self
        }
    }

    /// What its user should know of the file.
    #[must_use]
    pub fn notes(&self) -> &[Note] {
        &self.notes
    }

    /// The columns of the file that cannot be used, with the reason; they are none of [`columns`](Self::columns).
    #[must_use]
    pub fn unusable(&self) -> &[Unusable] {
        &self.unusable
    }

    /// What the clock of the file showed where the time of the table is 0, if it counts from there.
    #[must_use]
    pub fn origin(&self) -> Option<&Origin> {
        self.origin.as_ref()
    }

    /// Adds to what its user should know.
    pub fn tell(&mut self, note: Note) {
        self.notes.push(note);
    }

    /// Sets what the clock of the file showed where the time of the table is 0.
    pub(crate) fn count_from(&mut self, origin: Origin) {
        self.origin = Some(origin);
    }

    /// Counts the time from an instant `later_s` before, where the clock showed `origin`.
    pub(crate) fn begin_later(&mut self, later_s: f64, origin: &Origin) {
        self.origin = Some(origin.clone());
        if let Time::Column(at) = self.time {
            let column = self.columns.remove(at).raised(later_s);
            self.columns.insert(at, column);
            self.notes.push(Note::new(format!(
                "it begins {} after the first of the records",
                crate::gaps::seconds(later_s)
            )));
        }
        let sparse = self.unusable.iter_mut();
        let sparse = sparse.filter_map(|own| own.readings.as_deref_mut());
        for part in self.others.iter_mut().chain(sparse) {
            if let Time::Column(at) = part.time {
                let column = part.columns.remove(at).raised(later_s);
                part.columns.insert(at, column);
            }
        }
    }

    /// Other columns over the same time, which stands among them where it stood.
    ///
    /// # Errors
    /// If the columns do not make a table.
    pub fn with_columns(&self, columns: Vec<Column>) -> Result<Self, TableError> {
        match self.time {
            Time::Every(period_s, _) => Self::every(period_s, columns),
            Time::Column(at) => Self::with_time(columns, at),
        }
    }

    /// How many rows there are; at least one.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns[0].values().len()
    }

    /// The instants of the rows in s, never running back.
    #[must_use]
    pub fn time(&self) -> &[f64] {
        match &self.time {
            Time::Every(_, instants_s) => instants_s,
            Time::Column(at) => self.columns[*at].values(),
        }
    }

    /// The usual time between two rows, s: half of all distances are longer.
    #[must_use]
    pub fn usual_step(&self) -> Option<f64> {
        let pairs = self.time().windows(2).map(|pair| pair[1] - pair[0]);
        let steps: Vec<f64> = pairs.filter(|step| *step > 0.0).collect();
        crate::statistics::median(&steps)
    }

    /// The declared period in s, if time is not a column.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        match &self.time {
            Time::Every(period_s, _) => Some(*period_s),
            Time::Column(_) => None,
        }
    }

    /// The mean distance of rows in s: the sampling period of a record whose clock drifts. None for a single instant.
    #[must_use]
    pub fn mean_step(&self) -> Option<f64> {
        let time = self.time();
        let span = time[time.len() - 1] - time[0];
        let steps = (time.len() - 1) as f64;
        (span > 0.0).then(|| self.period().unwrap_or(span / steps))
    }

    /// All columns in order, the time among them unless a period was declared.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The column of that name, in whichever part it is, or the one that shows what is called so.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.holding(name).own(name)
    }

    fn own(&self, name: &str) -> Option<&Column> {
        let named = self.columns.iter().find(|column| column.name() == name);
        named.or_else(|| {
            let mut shown = self.columns.iter().filter(|c| c.meaning() == Some(name));
            shown.next().filter(|_| shown.next().is_none())
        })
    }

    /// The column of that name over its time.
    #[must_use]
    pub fn signal(&self, name: &str) -> Option<Signal<'_>> {
        let part = self.holding(name);
        Signal::new(part.time(), part.own(name)?.values())
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
            Self::NoneUsable(first) => write!(f, "none of its columns can be used: {first}"),
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
