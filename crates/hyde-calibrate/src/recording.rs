//! [`Recording`]: a record as an observer reads it: evenly sampled, what drives the model beside what was measured.

use hyde_program::{Constant, Program, RecordValueKind};
use hyde_signal::{Cursor, Table};
use std::collections::BTreeMap;

/// Why a record cannot be observed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RecordError {
    /// The experiment measures nothing.
    NoChannel,
    /// The record has no such column: record and column.
    NoColumn(String, String),
    /// Its rows are not evenly spaced: record.
    Uneven(String),
    /// It has fewer rows than an observer needs to settle: record and rows.
    Short(String, usize),
    /// A channel cannot be prepared as the experiment says: channel and cause.
    Preparation(String, String),
}

/// Record and column, which number of it, and the number.
type RecordedValue = ((String, String), RecordValueKind, f64);

/// A record, at the rows of the first measured channel's table.
#[derive(Clone, Debug)]
pub struct Recording {
    /// As messages call it.
    pub name: String,
    /// Time between rows in s.
    pub step_s: f64,
    /// Time of the first row in s.
    pub start_s: f64,
    /// The tables by the name the experiment gives them.
    pub tables: BTreeMap<String, Table>,
    /// Measured channels at the rows, SI.
    pub channels: Vec<Vec<f64>>,
    /// First values of columns, by record and column.
    record_values: Vec<RecordedValue>,
    /// Driving columns at the rows.
    pub(crate) columns: Vec<Vec<f64>>,
    /// The first row that counts.
    pub first_row: usize,
}

/// The rows after which an observer has settled: its start is that of the model, not of the axis.
const SETTLING_ROWS: usize = 150;

impl Recording {
    /// A record for a program in the observed form.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub fn new(
        name: &str,
        program: &Program,
        tables: BTreeMap<String, Table>,
    ) -> Result<Self, RecordError> {
        let experiment = &program.experiment;
        let base = experiment.measured.first().ok_or(RecordError::NoChannel)?;
        let missing = |(record, column): &(String, String)| {
            RecordError::NoColumn(record.clone(), column.clone())
        };
        let table = tables
            .get(&base.source.0)
            .ok_or_else(|| missing(&base.source))?;
        let time = table.time().to_vec();
        if time.len() < 2 * SETTLING_ROWS {
            return Err(RecordError::Short(name.to_owned(), time.len()));
        }
        let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
        let even = |table: &Table| {
            let pairs = table.time().windows(2);
            pairs
                .into_iter()
                .all(|pair| (pair[1] - pair[0] - step_s).abs() <= 0.01 * step_s)
        };
        if !even(table) {
            return Err(RecordError::Uneven(base.source.0.clone()));
        }
        let mut channels = Vec::new();
        for measured in &experiment.measured {
            let table = tables
                .get(&measured.source.0)
                .ok_or_else(|| missing(&measured.source))?;
            let column = table
                .column(&measured.source.1)
                .ok_or_else(|| missing(&measured.source))?;
            let prepared = hyde_experiment::prepared(measured, table, column.values())
                .map_err(|cause| RecordError::Preparation(measured.name.clone(), cause))?;
            channels.push(at_rows(table, &prepared, &time, false));
        }
        let mut columns = Vec::new();
        for column in &program.columns {
            let source = (column.record.clone(), column.column.clone());
            let table = tables.get(&column.record).ok_or_else(|| missing(&source))?;
            let values = table
                .column(&column.column)
                .ok_or_else(|| missing(&source))?
                .values();
            columns.push(at_rows(table, values, &time, column.next));
        }
        let mut record_values = Vec::new();
        for known in &program.record_values {
            let source = (known.record.clone(), known.column.clone());
            let table = tables.get(&known.record).ok_or_else(|| missing(&source))?;
            let column = table
                .column(&known.column)
                .ok_or_else(|| missing(&source))?;
            record_values.push((source, known.kind, known.kind.of(column.values())));
        }
        let p = parameters(program, &record_values, &[]);
        let skip_s = program.kernels.constant(Constant::Skip, &p).unwrap_or(0.0);
        let first_row = time
            .partition_point(|&t| t < skip_s - 1e-12)
            .max(SETTLING_ROWS);
        Ok(Self {
            name: name.to_owned(),
            step_s,
            start_s: time[0],
            tables,
            channels,
            record_values,
            columns,
            first_row,
        })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// The whole parameter vector with some values set (position and value).
    pub(crate) fn parameters(&self, program: &Program, set: &[(usize, f64)]) -> Vec<f64> {
        parameters(program, &self.record_values, set)
    }
}

/// The whole parameter vector of a program, with the values that records give and some values set.
fn parameters(
    program: &Program,
    record_values: &[RecordedValue],
    set: &[(usize, f64)],
) -> Vec<f64> {
    let mut all = Vec::new();
    for wanted in &program.record_values {
        let known = record_values.iter().find(|((record, column), kind, _)| {
            (record, column, kind) == (&wanted.record, &wanted.column, &wanted.kind)
        });
        all.extend(known.map(|(.., value)| (wanted.place, *value)));
    }
    all.extend_from_slice(set);
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&all, &mut p);
    p
}

/// A column at other instants: held, or one row ahead.
fn at_rows(table: &Table, values: &[f64], time: &[f64], next: bool) -> Vec<f64> {
    let Some(signal) = hyde_signal::Signal::new(table.time(), values) else {
        return vec![f64::NAN; time.len()];
    };
    let mut cursor = Cursor::default();
    let read = |&t: &f64| {
        let now = t + 1e-12 + 1e-13 * t.abs();
        match next {
            true => signal.next(now, &mut cursor),
            false => signal.held(now, &mut cursor),
        }
    };
    time.iter().map(read).collect()
}
