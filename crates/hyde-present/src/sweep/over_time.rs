//! Trajectories of a batch: whose rows are where, and all cases as envelopes.

use hyde_experiment::batch::envelope;
use hyde_report::Envelope;
use hyde_signal::{Field, Frame, Values};
use hyde_units::{NamedUnit, Unit};
use hyde_units::{drawn_in, shown};
use std::ops::Range;

/// Instants of an envelope: one for about three pixels.
const INSTANTS: usize = 200;

/// What was kept of a batch over time.
pub struct OverTime {
    frame: Frame,
    time: Vec<f64>,
    cases: Vec<(usize, Range<usize>)>,
}

impl OverTime {
    /// The trajectories of a table, if it is one of them: `case`, `t` and the variables.
    pub fn of(frame: Frame) -> Option<Self> {
        let named = |at: usize, name: &str| frame.fields.get(at).is_some_and(|f| f.name == name);
        if !named(0, "case") || !named(1, "t") {
            return None;
        }
        let numbers = whole_numbers(&frame.values[0]);
        let time = in_si(&frame.fields[1], &frame.values[1])?;
        let mut cases = Vec::new();
        let mut at = 0;
        for run in numbers.chunk_by(|a, b| a == b) {
            cases.push((run[0], at..at + run.len()));
            at += run.len();
        }
        Some(Self { frame, time, cases })
    }

    /// The cases that have rows, with these.
    pub fn cases(&self) -> &[(usize, Range<usize>)] {
        &self.cases
    }

    /// The instants of all rows in s.
    pub fn time(&self) -> &[f64] {
        &self.time
    }

    /// The variables, each with its values in all rows, SI.
    pub fn variables(&self) -> impl Iterator<Item = (&Field, Vec<f64>)> {
        let columns = self.frame.fields.iter().zip(&self.frame.values).skip(2);
        columns.filter_map(|(field, values)| Some((field, in_si(field, values)?)))
    }

    /// Each variable over all cases, or one of them.
    pub fn envelopes(&self, only: Option<&str>) -> Vec<Envelope> {
        let mut found = Vec::new();
        for (field, values) in self.variables() {
            if only.is_some_and(|name| name != field.name) {
                continue;
            }
            let (unit, of) = drawn(field);
            let values: Vec<f64> = values.iter().map(|si| of.from_si(*si)).collect();
            let rows = self.cases.iter();
            let rows = rows.map(|(_, rows)| (&self.time[rows.clone()], &values[rows.clone()]));
            let rows: Vec<(&[f64], &[f64])> = rows.collect();
            let enveloped = envelope(&rows, INSTANTS);
            if !enveloped.time.is_empty() {
                found.push(Envelope {
                    name: field.name.clone(),
                    unit,
                    time: enveloped.time,
                    quantiles: enveloped.quantiles,
                });
            }
        }
        found
    }
}

/// Numbers of cases, which CSV has as doubles.
pub fn whole_numbers(values: &Values) -> Vec<usize> {
    match values {
        Values::Integers(values) => values
            .iter()
            .map(|value| usize::try_from(*value).unwrap_or(0))
            .collect(),
        Values::Numbers(values) => values.iter().map(|value| *value as usize).collect(),
        Values::Texts(_) => Vec::new(),
    }
}

/// The numbers of a column, SI; none of texts.
pub fn in_si(field: &Field, values: &Values) -> Option<Vec<f64>> {
    let unit = field.unit.as_ref().map(NamedUnit::unit);
    let to_si = |value: f64| unit.map_or(value, |unit| unit.to_si(value));
    match values {
        Values::Numbers(values) => Some(values.iter().map(|value| to_si(*value)).collect()),
        Values::Integers(values) => Some(values.iter().map(|value| to_si(*value as f64)).collect()),
        Values::Texts(_) => None,
    }
}

/// The unit that the values of a column are drawn in; none of a bare number.
pub fn drawn(field: &Field) -> (String, Unit) {
    let (name, unit) = field
        .unit
        .as_ref()
        .map_or((String::new(), Unit::ONE), drawn_in);
    (shown(&name).to_owned(), unit)
}
