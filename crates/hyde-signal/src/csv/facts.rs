//! What lines above the rows say of the time between them.

use super::head::Line;
use super::number::any_number;
use super::separator::Separator;
use crate::heading::{Heading, unit_of_word};
use hyde_units::{Agreement, Dimension, NamedUnit};

/// A time between rows as a file says it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Period {
    /// The number.
    pub(super) value: f64,
    /// Its unit, where that is said.
    pub(super) unit: Option<NamedUnit>,
    /// The number as it stands.
    pub(super) text: String,
    /// How the file calls it.
    pub(super) key: String,
    /// The line.
    pub(super) line: u64,
}

/// What the key of a time between rows is called, blanks and signs left out.
const PERIODS: [&str; 21] = [
    "sampletime",
    "samplingtime",
    "samplingtimeinterval",
    "sampleinterval",
    "samplinginterval",
    "sampleperiod",
    "samplingperiod",
    "timeinterval",
    "interval",
    "xincrement",
    "xinc",
    "tincrement",
    "increment",
    "deltat",
    "deltax",
    "dt",
    "ts",
    "timestep",
    "scantime",
    "cycletime",
    "abtastzeit",
];

/// The same of a rate.
const RATES: [&str; 7] = [
    "samplerate",
    "samplingrate",
    "samplefrequency",
    "samplingfrequency",
    "rate",
    "fs",
    "abtastrate",
];

/// The letters and digits of a key, in small letters.
pub(super) fn key(text: &str) -> String {
    let letters = text.chars().filter(|c| c.is_alphanumeric());
    letters.flat_map(char::to_lowercase).collect()
}

/// Whether a key is that of a time between rows, and its unit: `SampleTime[ms]`, `Sampling time interval(ms)`.
pub(super) fn period_key(cell: &str) -> Option<Option<NamedUnit>> {
    let heading = Heading::of(cell.trim_end_matches(':'));
    let inside = cell.trim_end_matches(':').strip_suffix(')');
    let (name, unit) = match (
        heading.known_unit(),
        inside.and_then(|c| c.rsplit_once('(')),
    ) {
        (Some(unit), _) => (heading.name.clone(), Some(unit.clone())),
        (None, Some((name, unit))) => (name.to_owned(), unit_of_word(unit)),
        (None, None) => (heading.name, None),
    };
    PERIODS.contains(&key(&name).as_str()).then_some(unit)
}

/// The time between rows that one of these lines says; of several the last.
pub(super) fn period(lines: &[Line<'_>], separator: Separator) -> Option<Period> {
    lines.iter().rev().find_map(|line| of_line(line, separator))
}

fn of_line(line: &Line<'_>, separator: Separator) -> Option<Period> {
    let text = line.plain_text();
    let mut cells = separator.words(text);
    cells.retain(|cell| !cell.is_empty());
    let signs = [": ", "=", " is ", ":", "\t"];
    let pair = || signs.iter().find_map(|sign| text.split_once(sign));
    let (name, values) = match (cells.split_first(), pair()) {
        (Some((name, values)), _) if !values.is_empty() && is_key(name) => {
            (name.clone(), values.to_vec())
        }
        (_, Some((name, value))) if is_key(name) => {
            (name.trim().to_owned(), vec![value.trim().to_owned()])
        }
        _ => return None,
    };
    let (value, said, text) = values.iter().enumerate().find_map(|(at, cell)| {
        let (number, unit, text) = match any_number(cell) {
            Some(number) => (
                number,
                values.get(at + 1).and_then(|next| unit_of_word(next)),
                cell.trim(),
            ),
            None => {
                let (number, unit) = cell.trim().split_once(' ')?;
                (any_number(number)?, unit_of_word(unit), number)
            }
        };
        Some((number, unit, text.to_owned()))
    })?;
    let unit = period_key(&name).flatten().or(said);
    let is_rate = period_key(&name).is_none();
    let key = name.trim_end_matches(':').to_owned();
    let period = match is_rate {
        false => Period {
            value,
            unit,
            text,
            key,
            line: line.number,
        },
        true => Period {
            value: 1.0 / unit.map_or(value, |unit| unit.unit().to_si(value)),
            unit: Some(NamedUnit::usual(Dimension::TIME)),
            text,
            key,
            line: line.number,
        },
    };
    let of_time =
        |unit: &NamedUnit| unit.unit().dimension.agreement(Dimension::TIME) == Agreement::Same;
    (period.value > 0.0 && period.value.is_finite() && period.unit.as_ref().is_none_or(of_time))
        .then_some(period)
}

fn is_key(name: &str) -> bool {
    let heading = Heading::of(name.trim_end_matches(':'));
    period_key(name).is_some() || RATES.contains(&key(&heading.name).as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::csv::head::lines;

    #[test]
    fn preambles_say_their_period_in_many_words() {
        for (text, separator, seconds) in [
            ("Sampling period is 1000000 nSec", b';', 1e-3),
            ("SampleTime[ms]\t0,2", b'\t', 2e-4),
            ("Sampling time interval(ms),1.000", b',', 1e-3),
            ("Sample Interval,4.0e-04,s", b',', 4e-4),
            ("# Sampling rate: 2000 Hz", b',', 5e-4),
            ("dt = 5 ms", b',', 5e-3),
            ("XIncrement:;0.5;ms", b';', 5e-4),
        ] {
            let lines: Vec<Line> = lines(text, 0, 0).collect();
            let found = period(&lines, Separator::Byte(separator)).unwrap();
            let unit = found.unit.unwrap();
            assert!(
                (unit.unit().to_si(found.value) - seconds).abs() < 1e-12,
                "{text}: {} {unit}",
                found.value
            );
        }
        let none: Vec<Line> = lines("Interval,0.001", 0, 0).collect();
        assert_eq!(period(&none, Separator::Byte(b',')).unwrap().unit, None);
        let none: Vec<Line> = lines("Number of sampling data,400", 0, 0).collect();
        assert_eq!(period(&none, Separator::Byte(b',')), None);
    }
}
