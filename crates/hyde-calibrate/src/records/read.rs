//! [`Read`]: a measured channel with the times of its own readings, unwrapped and prepared.

use super::begins_again::begins_again;
use super::even_rows::{evenly, resample};
use super::readings::at_rows;
use super::recording::RecordError;
use hyde_program::{Measured, Preparation};
use hyde_signal::Table;
use std::collections::BTreeMap;

/// Readings of a channel.
pub(crate) struct Read {
    /// The record they are of, as the experiment calls it.
    pub(crate) record: String,
    /// Their times, s.
    pub(crate) time: Vec<f64>,
    /// How much earlier is what they show, s.
    late_s: f64,
    /// What the channel shows, SI.
    pub(crate) values: Vec<f64>,
    /// The period with which it begins again, SI.
    pub(crate) period: Option<f64>,
}

impl Read {
    /// Those of a channel whose model begins again with a period, if it does. A filter needs even rows: it gets them on
    /// straight lines between readings.
    pub(crate) fn of(
        measured: &Measured,
        tables: &BTreeMap<String, Table>,
        period: Option<f64>,
    ) -> Result<Self, RecordError> {
        let (record, column) = &measured.source;
        let missing = || RecordError::NoColumn(record.clone(), column.clone());
        let table = tables.get(record).ok_or_else(missing)?.reading(column);
        let values = table.column(column).ok_or_else(missing)?.values();
        if table.time().len() < 2 {
            return Err(RecordError::Short(record.clone(), table.time().len()));
        }
        let again = period.is_none().then(|| begins_again(values)).flatten();
        if let Some((times, by)) = again {
            return Err(RecordError::BeginsAgain(measured.name.clone(), times, by));
        }
        let values = hyde_experiment::unwrapped(measured, values, period);
        let prepare = |table: &Table, values: &[f64]| {
            let prepared = hyde_experiment::prepared(measured, table, values);
            prepared.map_err(|cause| RecordError::Preparation(measured.name.clone(), cause))
        };
        let own = |time: &[f64], values| Self {
            record: record.clone(),
            time: time.to_vec(),
            late_s: measured.late.as_ref().map_or(0.0, |(by_s, _)| *by_s),
            values,
            period,
        };
        let mut steps = measured.preparation.iter();
        let filtered = steps.any(|step| !matches!(step, Preparation::Scale(_)));
        if filtered && let (rows, Some(_)) = evenly(record, table.time(), |_, _| false)? {
            let even = resample(table, &values, &rows);
            if let Some((even, values)) = even {
                return Ok(own(even.time(), prepare(&even, &values)?));
            }
        }
        Ok(own(table.time(), prepare(table, &values)?))
    }

    /// Values at the rows of an observer, NaN where the channel has no reading.
    pub(crate) fn at_rows(&self, rows: &[f64]) -> Vec<f64> {
        let shown: Vec<f64> = self.time.iter().map(|t| t - self.late_s).collect();
        at_rows(&shown, &self.values, rows)
    }

    /// The mean time between its readings, s.
    pub(crate) fn step_s(&self) -> f64 {
        let last = self.time.len() - 1;
        (self.time[last] - self.time[0]) / last as f64
    }
}

/// The channel that is read most often, the first of equals.
pub(crate) fn fastest(read: &[Read]) -> &Read {
    let faster = |best: &'_ Read, own: &'_ Read| own.step_s() < 0.99 * best.step_s();
    let mut best = &read[0];
    for own in read {
        if faster(best, own) {
            best = own;
        }
    }
    best
}
