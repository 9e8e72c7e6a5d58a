//! [`Recording`]: a record as an observer reads it: evenly sampled, what drives the model beside what was measured.

use crate::begins_again::begins_again;
use crate::even_rows::{self, Resampled};
use hyde_experiment::{RowFault, check_columns};
use hyde_program::{Constant, Program, RecordValueKind};
use hyde_signal::{Cursor, Table, wrap};
use std::collections::BTreeMap;

/// Why a record cannot be observed.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordError {
    /// The experiment measures nothing.
    NoChannel,
    /// The record has no such column: record and column.
    NoColumn(String, String),
    /// It has no row for longer than what may be read between rows.
    Gap {
        /// The record, as the experiment calls it.
        record: String,
        /// The last row before it, s.
        from_s: f64,
        /// The first row after it, s.
        to_s: f64,
        /// How far apart rows usually are, s.
        usual_s: f64,
    },
    /// A row has a value that what it drives may not have.
    Row(Box<RowFault>),
    /// A channel begins again, and what the model has for it goes on: channel, how often, and what it jumps by.
    BeginsAgain(String, usize, f64),
    /// It has fewer rows than an observer needs to settle: record and rows.
    Short(String, usize),
    /// A channel has fewer readings than the record has rows: channel, time between its readings and between rows, s.
    Slow(String, f64, f64),
    /// A channel cannot be prepared as the experiment says: channel and cause.
    Preparation(String, String),
}

/// Record and column, none for the time, which number of it, and the number.
type RecordedValue = ((String, Option<String>), RecordValueKind, f64);

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
    /// The period with which each begins again, SI; infinite of most. Channels go on there.
    pub(crate) periods: Vec<f64>,
    /// That its own rows are not evenly spaced.
    pub resampled: Option<Resampled>,
    /// First values of columns, by record and column.
    record_values: Vec<RecordedValue>,
    /// Driving columns at the rows.
    pub(crate) columns: Vec<Vec<f64>>,
    /// The first row that counts.
    pub first_row: usize,
    /// States that the first rows show elsewhere than the model starts, by name, SI.
    pub beginning: Vec<(String, f64)>,
}

/// The rows after which an observer has settled: its start is that of the model, not of the axis.
const SETTLING_ROWS: usize = 150;

/// A channel is slow whose readings are so many rows apart.
const SLOW: f64 = 1.5;

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
        check_columns(program, &tables).map_err(RecordError::Row)?;
        let experiment = &program.experiment;
        let base = experiment.measured.first().ok_or(RecordError::NoChannel)?;
        let missing = |(record, column): &(String, String)| {
            RecordError::NoColumn(record.clone(), column.clone())
        };
        let table = tables
            .get(&base.source.0)
            .ok_or_else(|| missing(&base.source))?
            .holding(&base.source.1);
        if table.time().len() < 2 * SETTLING_ROWS {
            return Err(RecordError::Short(name.to_owned(), table.time().len()));
        }
        let (time, resampled) = match even_rows::evenly(&base.source.0, table)? {
            Some((time, resampled)) => (time, Some(resampled)),
            None => (table.time().to_vec(), None),
        };
        let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
        let record_values = record_values(program, &tables)?;
        let p = parameters(program, &record_values, &[]);
        let (mut channels, mut periods) = (Vec::new(), Vec::new());
        for (number, measured) in experiment.measured.iter().enumerate() {
            let table = tables
                .get(&measured.source.0)
                .ok_or_else(|| missing(&measured.source))?
                .holding(&measured.source.1);
            let column = table
                .column(&measured.source.1)
                .ok_or_else(|| missing(&measured.source))?;
            // A reading that is held until the next one would count as a new one in every row.
            let slow = table.usual_step().filter(|own| *own > SLOW * step_s);
            if let Some(own) = slow {
                return Err(RecordError::Slow(measured.name.clone(), own, step_s));
            }
            let period = program.kernels.constant(Constant::Wrap(number), &p);
            let again = period.is_none().then(|| begins_again(column.values()));
            if let Some((times, by)) = again.flatten() {
                let channel = measured.name.clone();
                return Err(RecordError::BeginsAgain(channel, times, by));
            }
            let values = hyde_experiment::unwrapped(measured, column.values(), period);
            let same = |base: &Table| base.time() == table.time();
            let own = resampled.is_some()
                && measured.source.0 == base.source.0
                && tables
                    .get(&base.source.0)
                    .is_some_and(|all| same(all.holding(&base.source.1)));
            let even = own.then(|| even_rows::resample(table, &values, &time));
            let even = even.flatten();
            let (table, values) = even
                .as_ref()
                .map_or((table, &values), |(table, values)| (table, values));
            let prepared = hyde_experiment::prepared(measured, table, values)
                .map_err(|cause| RecordError::Preparation(measured.name.clone(), cause))?;
            channels.push(at_rows(table, &prepared, &time, false));
            periods.push(period.unwrap_or(f64::INFINITY));
        }
        let mut columns = Vec::new();
        for column in &program.columns {
            let source = (column.record.clone(), column.column.clone());
            let table = tables.get(&column.record).ok_or_else(|| missing(&source))?;
            let table = table.holding(&column.column);
            let values = table
                .column(&column.column)
                .ok_or_else(|| missing(&source))?
                .values();
            columns.push(at_rows(table, values, &time, column.next));
        }
        let skip_s = program.kernels.constant(Constant::Skip, &p).unwrap_or(0.0);
        let first_row = time
            .partition_point(|&t| t < time[0] + skip_s - 1e-12)
            .max(SETTLING_ROWS);
        let mut found = Self {
            name: name.to_owned(),
            step_s,
            start_s: time[0],
            tables,
            channels,
            periods,
            resampled,
            record_values,
            columns,
            first_row,
            beginning: Vec::new(),
        };
        found.beginning = crate::beginning::shown(program, &found);
        Ok(found)
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// What a channel shows in a row beyond what a model has for it, but for whole periods.
    pub(crate) fn error(&self, channel: usize, row: usize, model: f64) -> f64 {
        let (error, period) = (self.channels[channel][row] - model, self.periods[channel]);
        if period.is_finite() {
            wrap::nearest(error, period)
        } else {
            error
        }
    }

    /// The whole parameter vector with some values set (position and value).
    pub(crate) fn parameters(&self, program: &Program, set: &[(usize, f64)]) -> Vec<f64> {
        parameters(program, &self.record_values, set)
    }
}

/// The values of columns that a program reads once.
fn record_values(
    program: &Program,
    tables: &BTreeMap<String, Table>,
) -> Result<Vec<RecordedValue>, RecordError> {
    let mut found = Vec::new();
    for known in &program.record_values {
        let table = tables.get(&known.record);
        let value = table.and_then(|table| hyde_experiment::record_value(known, table));
        let (record, column) = (known.record.clone(), known.column.clone());
        let Some(value) = value else {
            return Err(RecordError::NoColumn(record, column.unwrap_or_default()));
        };
        found.push(((record, column), known.kind, value));
    }
    Ok(found)
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
