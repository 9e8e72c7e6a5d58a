//! [`Recording`]: a record as an observer reads it: evenly sampled, what drives the model beside what was measured.

use super::even_rows::{self, Uneven};
use super::read::{Read, fastest};
use super::readings::{self, Readings};
use hyde_experiment::{RowFault, check_columns};
use hyde_program::{Column, Constant, Program, RecordValueKind};
use hyde_signal::{Cursor, Table, wrap};
use std::collections::BTreeMap;
use std::sync::Arc;

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
    /// A channel cannot be prepared as the experiment says: channel and cause.
    Preparation(String, String),
}

/// Record and column, none for the time, which number of it, and the number.
type RecordedValue = ((String, Option<String>), RecordValueKind, f64);

/// A record at even rows, as close as the readings of its fastest channel, or as the rows of a column that drives the model.
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
    /// Measured channels at the rows, SI; NaN in rows without a reading.
    pub channels: Vec<Vec<f64>>,
    /// The kinds of rows by which channels have a reading, that with all of them first; and that of each row.
    pub(crate) kinds: Vec<Readings>,
    of_rows: Vec<usize>,
    /// The rows without a reading of each channel, counted from the first that counts.
    pub(crate) absent: Vec<Arc<[usize]>>,
    /// The mean time between the readings of each, s.
    pub spacings_s: Vec<f64>,
    /// The period with which each begins again, SI; infinite of most. Channels go on there.
    pub(crate) periods: Vec<f64>,
    /// That its own rows are not evenly spaced.
    pub uneven: Option<Uneven>,
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
/// The readings of a slow channel after which it has.
const SETTLING_READINGS: usize = 20;

impl Recording {
    /// A record for a program in the observed form; nothing is known yet of where it begins.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub(crate) fn read(
        name: &str,
        program: &Program,
        tables: BTreeMap<String, Table>,
    ) -> Result<Self, RecordError> {
        check_columns(program, &tables).map_err(RecordError::Row)?;
        let experiment = &program.experiment;
        if experiment.measured.is_empty() {
            return Err(RecordError::NoChannel);
        }
        let record_values = record_values(program, &tables)?;
        let p = parameters(program, &record_values, &[]);
        let read = experiment.measured.iter().enumerate();
        let read = read.map(|(number, measured)| {
            let period = program.kernels.constant(Constant::Wrap(number), &p);
            Read::of(measured, &tables, period)
        });
        let read: Vec<Read> = read.collect::<Result<_, RecordError>>()?;
        let base = fastest(&read);
        if base.time.len() < 2 * SETTLING_ROWS {
            return Err(RecordError::Short(name.to_owned(), base.time.len()));
        }
        let (record, time) = closest_rows(program, &tables, base);
        let (time, uneven) = even_rows::evenly(record, &time, |from_s, to_s| {
            is_driven(program, &tables, from_s, to_s)
        })?;
        let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
        let channels = read.iter().map(|own| own.at_rows(&time));
        let channels: Vec<Vec<f64>> = channels.collect();
        let periods = read.iter().map(|own| own.period.unwrap_or(f64::INFINITY));
        let periods = periods.collect();
        let mut columns = Vec::new();
        for column in &program.columns {
            let source = (column.record.clone(), column.column.clone());
            let missing = || RecordError::NoColumn(source.0.clone(), source.1.clone());
            let table = tables.get(&column.record).ok_or_else(missing)?;
            let table = table.reading(&column.column);
            let values = table.column(&column.column).ok_or_else(missing)?.values();
            columns.push(driving(table, values, &time, column));
        }
        let skip_s = program.kernels.constant(Constant::Skip, &p).unwrap_or(0.0);
        let first_row = time
            .partition_point(|&t| t < time[0] + skip_s - 1e-12)
            .max(SETTLING_ROWS)
            .max(settled(&channels));
        let (kinds, of_rows) = readings::kinds(&channels);
        Ok(Self {
            name: name.to_owned(),
            step_s,
            start_s: time[0],
            tables,
            absent: readings::absent(&channels, first_row),
            channels,
            spacings_s: read.iter().map(Read::step_s).collect(),
            kinds,
            of_rows,
            periods,
            uneven,
            record_values,
            columns,
            first_row,
            beginning: Vec::new(),
        })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.channels.first().map_or(0, Vec::len)
    }

    /// How many readings of a channel there are.
    #[must_use]
    pub fn readings_of(&self, channel: usize) -> usize {
        let list = self.channels[channel].iter();
        list.filter(|value| !value.is_nan()).count()
    }

    /// Which channels have a reading in a row.
    pub(crate) fn readings(&self, row: usize) -> &Readings {
        &self.kinds[self.kind_of(row)]
    }

    /// The number of the kind of a row, by which channels have a reading.
    pub(crate) fn kind_of(&self, row: usize) -> usize {
        self.of_rows.get(row).copied().unwrap_or(0)
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

    /// When the experiment stops and when the record ends, both in s, where the record goes on: an observer uses all of it.
    #[must_use]
    pub fn behind_stop(&self, program: &Program, set: &[(usize, f64)]) -> Option<(f64, f64)> {
        let p = self.parameters(program, set);
        let stop_s = program.kernels.constant(Constant::Stop, &p)?;
        let end_s = self.start_s + self.step_s * self.rows().saturating_sub(1) as f64;
        (end_s > stop_s + self.step_s).then_some((stop_s, end_s))
    }

    /// Gives a driving column in each row the value that it has some rows later; ends go on.
    pub(crate) fn move_column(&mut self, column: usize, rows: i64) {
        let own = &self.columns[column];
        let last = own.len().saturating_sub(1) as i64;
        let at = |row: usize| own[usize::try_from((row as i64 + rows).clamp(0, last)).unwrap_or(0)];
        self.columns[column] = (0..own.len()).map(at).collect();
    }

    /// The whole parameter vector with some values set (position and value).
    pub(crate) fn parameters(&self, program: &Program, set: &[(usize, f64)]) -> Vec<f64> {
        parameters(program, &self.record_values, set)
    }
}

/// The closest rows of a record: the readings of its fastest channel, or the rows of a column that drives the model where these
/// are closer, as far as there are readings. What drives the model between two readings moves it.
fn closest_rows<'r>(
    program: &'r Program,
    tables: &'r BTreeMap<String, Table>,
    base: &'r Read,
) -> (&'r str, Vec<f64>) {
    let (first, last) = (base.time[0], base.time[base.time.len() - 1]);
    let within = |column: &'r Column| {
        let table = tables.get(&column.record)?.reading(&column.column);
        let rows = table.time().iter().copied();
        let rows: Vec<f64> = rows.filter(|t| (first..=last).contains(t)).collect();
        Some((column.record.as_str(), rows))
    };
    let driving = program.columns.iter().filter(|column| column.continuous);
    let driving = driving.filter_map(within);
    let closest = driving.max_by_key(|(_, rows)| rows.len());
    // A few more rows are those in which a reading was lost.
    let closer = |rows: &[f64]| rows.len() as f64 > 1.5 * base.time.len() as f64;
    closest
        .filter(|(_, rows)| closer(rows))
        .unwrap_or_else(|| (&base.record, base.time.clone()))
}

/// Whether every column that drives a model has rows in a stretch of time in which a channel has no reading.
fn is_driven(program: &Program, tables: &BTreeMap<String, Table>, from_s: f64, to_s: f64) -> bool {
    let mut driving = program.columns.iter().filter(|column| column.continuous);
    driving.all(|column| {
        let time = tables
            .get(&column.record)
            .map(|table| table.reading(&column.column).time());
        let time = time.unwrap_or_default();
        let rows = time.partition_point(|t| *t <= from_s)..time.partition_point(|t| *t < to_s);
        !rows.is_empty()
    })
}

/// The row before which every channel has settled an observer, within the first quarter of a record.
fn settled(channels: &[Vec<f64>]) -> usize {
    let of = |list: &Vec<f64>| {
        let mut readings = (0..list.len()).filter(|&row| !list[row].is_nan());
        let last = readings.nth(SETTLING_READINGS);
        last.unwrap_or(0).min(list.len() / 4)
    };
    channels.iter().map(of).max().unwrap_or(0)
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

/// What drives the model at the rows of an observer: as a run reads it there, held or on straight lines.
fn driving(table: &Table, values: &[f64], rows: &[f64], column: &Column) -> Vec<f64> {
    let own = table.time();
    let Some(signal) = hyde_signal::Signal::new(own, values) else {
        return vec![f64::NAN; rows.len()];
    };
    let linear = column.continuous && !column.stepped;
    let mut cursor = Cursor::default();
    let read = |&t: &f64| {
        let now = t + 1e-12 + 1e-13 * t.abs();
        let before = own.partition_point(|own| *own <= now).checked_sub(1);
        let between = before.is_some_and(|row| now - own[row] > 2.0 * (now - t));
        match (column.next, linear && between) {
            (true, _) => signal.next(now, &mut cursor),
            (false, true) => signal.linear(t, &mut cursor),
            (false, false) => signal.held(now, &mut cursor),
        }
    };
    rows.iter().map(read).collect()
}
