//! Which column of a record is its time, and the instants in it.

use crate::assemble::{Cells, Raw};
use crate::calendar::{self, Origin};
use crate::decimal::decimal;
use crate::heading::{Temporal, is_time_unit, temporal};
use crate::layout::DeclaredColumn;
use crate::statistics::median;
use crate::table::may_be_first;
use crate::texts::Texts;
use crate::time_error::{Candidate, TimeError};
use crate::{Fault, Note, declared, gaps, wrap};
use hyde_units::{Dimension, NamedUnit};

/// A clock that began to count longer ago, in s, counts from the first row: doubles resolve a run near 0 best.
const LONG_AGO_S: f64 = 86_400.0;

/// The time of a record.
#[derive(Debug)]
pub(crate) struct Instants {
    pub(crate) unit: NamedUnit,
    pub(crate) seconds: Vec<f64>,
    pub(crate) origin: Option<Origin>,
    pub(crate) notes: Vec<Note>,
}

/// Where the time is among the columns: as declared, else in front.
pub(crate) fn place(raw: &[Raw], declared: Option<&DeclaredColumn>) -> Result<usize, TimeError> {
    let Some(declared) = declared else {
        return Ok(0);
    };
    let named = |column: &Raw| declared::means(declared, column);
    let names = || {
        raw.iter()
            .map(|column| column.heading.name.clone())
            .collect()
    };
    raw.iter()
        .position(named)
        .ok_or_else(|| TimeError::NoColumn(declared.name.clone(), names()))
}

/// Reads the column at `at` as the time; `place` names a row in messages.
pub(crate) fn read(
    raw: &[Raw],
    at: usize,
    declared: Option<&DeclaredColumn>,
    place: &dyn Fn(usize) -> String,
) -> Result<Instants, TimeError> {
    let Unit {
        unit,
        count,
        said,
        mut notes,
    } = unit(raw, at, declared)?;
    let name = &raw[at].heading.name;
    let factor = count * unit.unit().to_si(1.0);
    let si = |value: f64| unit.unit().to_si(count * value);
    let over_frequency = !is_time_unit(&unit);
    let no_time = |row: usize, text: &str| TimeError::NoTime {
        place: place(row),
        name: name.clone(),
        text: text.to_owned(),
        instead: candidate(raw, at),
    };
    let is_far = |first: f64| first.abs() * factor > LONG_AGO_S && !over_frequency;
    let (seconds, origin) = match &raw[at].cells {
        Cells::Texts(texts) => match numbers(texts) {
            Ok(values) if wraps(&values, declared).is_some() => {
                let period = wraps(&values, declared).unwrap_or(f64::INFINITY);
                notes.push(Note::new(format!(
                    "the counter `{name}` overflows after {period}: the time is continued"
                )));
                let mut values = values;
                wrap::unwrap(&mut values, period);
                shifted(values, &si, None)
            }
            Ok(values) if !said && are_days(&values) => {
                return Err(TimeError::Doubtful(in_days(name, &values)));
            }
            Ok(values) => {
                let far = values.first().is_some_and(|first| is_far(*first));
                let exact = far.then(|| {
                    calendar::of_digits(texts, factor)
                        .or_else(|| calendar::of_doubles(&values, factor))
                });
                shifted(values, &si, exact.flatten())
            }
            Err(row) => {
                let dates = calendar::of_texts(texts)
                    .map_err(|wrong| no_time(wrong.max(row), &texts[wrong.max(row)]));
                let (seconds, origin) = dates?;
                (seconds, Some(origin))
            }
        },
        Cells::Integers(values) => {
            #[allow(clippy::cast_precision_loss, reason = "far ones are subtracted first")]
            let doubles: Vec<f64> = values.iter().map(|value| *value as f64).collect();
            let far = doubles.first().is_some_and(|first| is_far(*first));
            let exact = far.then(|| calendar::of_integers(values, factor));
            shifted(doubles, &si, exact.flatten())
        }
        Cells::Numbers(values, _) | Cells::Sparse(values, _) => {
            if let Some(row) = values.iter().position(|value| !value.is_finite()) {
                return Err(no_time(row, ""));
            }
            let far = values.first().is_some_and(|first| is_far(*first));
            let exact = far.then(|| calendar::of_doubles(values, factor));
            shifted(values.clone(), &si, exact.flatten())
        }
    };
    let shown = |row: usize| match (&raw[at].cells, &origin) {
        (Cells::Texts(texts), _) => texts[row].trim().to_owned(),
        (_, None) => hyde_units::significant(seconds[row] / factor, 12),
        (_, Some(_)) => gaps::seconds(seconds[row]),
    };
    advances(&seconds, raw, at, place, &shown)?;
    if !said
        && origin
            .as_ref()
            .is_none_or(|origin| origin.since == calendar::Since::Number)
    {
        let whole = match &raw[at].cells {
            Cells::Texts(texts) => texts.iter().all(|text| text.trim().parse::<i64>().is_ok()),
            Cells::Integers(_) => true,
            Cells::Numbers(values, _) | Cells::Sparse(values, _) => {
                values.iter().all(|value| value.fract() == 0.0)
            }
        };
        if whole && seconds.len() > 2 {
            let step = (seconds[seconds.len() - 1] - seconds[0]) / (seconds.len() - 1) as f64;
            return Err(TimeError::NoUnit(
                name.clone(),
                hyde_units::significant(step, 4),
            ));
        }
        notes.push(Note::new(format!(
            "the time `{name}` has no unit: it is read in s"
        )));
    }
    if let Some(origin) = &origin {
        notes.push(Note::new(format!(
            "its clock reads {} at the first sample: `time` counts from there, and is 0 at this sample",
            origin.text
        )));
    }
    if !over_frequency {
        notes.extend(gaps::told(&seconds));
        notes.extend(other_clocks(raw, at, &seconds));
    }
    Ok(Instants {
        unit,
        seconds,
        origin,
        notes,
    })
}

fn shifted(
    mut values: Vec<f64>,
    si: &dyn Fn(f64) -> f64,
    exact: Option<(Vec<f64>, Origin)>,
) -> (Vec<f64>, Option<Origin>) {
    match exact {
        Some((seconds, origin)) => (seconds, Some(origin)),
        None => {
            values.iter_mut().for_each(|value| *value = si(*value));
            (values, None)
        }
    }
}

/// Whether numbers without a unit may be the days of a spreadsheet, from 2000 to 2100: as seconds of a clock, most rows
/// would be less than 20 us apart.
fn are_days(values: &[f64]) -> bool {
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let first = values.first().copied().unwrap_or_default();
    (36_526.0..73_050.0).contains(&first) && median(&steps).is_some_and(|step| step < 2e-5)
}

fn in_days(name: &str, values: &[f64]) -> Fault {
    let first = hyde_units::significant(values[0], 8);
    Fault {
        message: format!(
            "the time `{name}` has no unit and begins at {first}: does it count days, as the dates of a spreadsheet do, or seconds?"
        ),
        repair: format!(
            "say which: `record log(time = {name:?} in 24 [h])` for days, `in [s]` for seconds"
        ),
    }
}

/// The number of values after which a counter begins again: as declared, else as the only step back shows that goes on by a
/// usual step if it is taken for a counter of 16 or 32 bits.
pub(crate) fn wraps(values: &[f64], declared: Option<&DeclaredColumn>) -> Option<f64> {
    if let Some(period) = declared.and_then(|declared| declared.wraps) {
        return Some(period);
    }
    let back = values.windows(2).any(|pair| pair[1] < pair[0]);
    if !back || values.iter().any(|value| value.fract() != 0.0) {
        return None;
    }
    let steps = values.windows(2).map(|pair| pair[1] - pair[0]);
    let forward: Vec<f64> = steps.clone().filter(|step| *step > 0.0).collect();
    let usual = median(&forward)?;
    let (least, most) = values
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| {
            (a.min(*value), b.max(*value))
        });
    [65_536.0, 4_294_967_296.0].into_iter().find(|period| {
        let within =
            (least >= 0.0 && most < *period) || (least >= -period / 2.0 && most < period / 2.0);
        let goes_on =
            |step: f64| step >= 0.0 || (step + period - usual).abs() <= (0.02 * usual).max(1.0);
        within && steps.clone().all(goes_on)
    })
}

/// The numbers of cells; else the first that is none.
fn numbers(texts: &Texts) -> Result<Vec<f64>, usize> {
    let mut numbers = Vec::with_capacity(texts.len());
    for (row, text) in texts.iter().enumerate() {
        let text = text.trim();
        let value = decimal(text).map(|(value, _)| value);
        let value = value.or_else(|| text.parse::<f64>().ok());
        numbers.push(value.filter(|value| value.is_finite()).ok_or(row)?);
    }
    Ok(numbers)
}

/// The unit of the time, whether the file or the declaration says it, and what was taken for granted.
struct Unit {
    unit: NamedUnit,
    /// How many of the unit one count is.
    count: f64,
    said: bool,
    notes: Vec<Note>,
}

fn unit(raw: &[Raw], at: usize, declared: Option<&DeclaredColumn>) -> Result<Unit, TimeError> {
    let heading = &raw[at].heading;
    let name = heading.name.clone();
    let asked = declared.and_then(|declared| declared.unit.clone());
    let other = |unit: &str| TimeError::OtherUnit {
        name: name.clone(),
        unit: unit.to_owned(),
        instead: candidate(raw, at),
    };
    let said = |unit: NamedUnit, note: Option<String>| Unit {
        unit,
        count: 1.0,
        said: true,
        notes: note.into_iter().map(Note::new).collect(),
    };
    match (&heading.unit, asked) {
        (Some(Ok(own)), Some(asked)) if !asked.is(own.unit()) => Err(TimeError::TwoUnits(
            name,
            own.text().to_owned(),
            asked.to_string(),
        )),
        (_, Some(asked)) if is_time_unit(&asked.unit) => Ok(Unit {
            count: asked.factor,
            ..said(asked.unit, None)
        }),
        (_, Some(asked)) => Err(other(asked.unit.text())),
        (Some(Ok(own)), None) if may_be_first(own.unit().dimension) => Ok(said(own.clone(), None)),
        (Some(Ok(own)), None) => Err(other(own.text())),
        (Some(Err(_)), None) => Err(other(&unit_text(&heading.written))),
        (None, None) => match (temporal(&name), unix_unit(&raw[at].cells)) {
            (Temporal::In(unit), _) => {
                let note = format!("`{name}` is read in {unit}, as its name says");
                Ok(said(unit, Some(note)))
            }
            (Temporal::Frequency, _) => {
                let note = format!("the frequency `{name}` has no unit: it is read in Hz");
                Ok(said(NamedUnit::usual(Dimension::FREQUENCY), Some(note)))
            }
            (Temporal::No, _) if declared.is_none() && !is_dates(&raw[at].cells) => {
                Err(TimeError::NotSaid {
                    name: name.clone(),
                    instead: candidate(raw, at),
                })
            }
            (Temporal::No | Temporal::Time, Some(unit)) => {
                let note = format!("the time `{name}` has no unit: it is Unix time in {unit}");
                Ok(said(unit, Some(note)))
            }
            (Temporal::No | Temporal::Time, None) => Ok(Unit {
                unit: NamedUnit::usual(Dimension::TIME),
                count: 1.0,
                said: false,
                notes: Vec::new(),
            }),
        },
    }
}

/// The unit in which whole numbers are Unix time, from 2001 to 2100; each unit has a range of its own.
fn unix_unit(cells: &Cells) -> Option<NamedUnit> {
    let first = match cells {
        Cells::Texts(texts) => texts.first()?.trim().parse().ok()?,
        Cells::Integers(values) => *values.first()?,
        Cells::Numbers(..) | Cells::Sparse(..) => return None,
    };
    let units = [
        ("s", 1),
        ("ms", 1_000),
        ("us", 1_000_000),
        ("ns", 1_000_000_000),
    ];
    let is =
        |(_, factor): &&(&str, i64)| (1_000_000_000..4_102_444_800).contains(&(first / factor));
    let (unit, _) = units.iter().find(is)?;
    NamedUnit::parse(unit).ok()
}

fn unit_text(written: &str) -> String {
    let inside = written.rsplit_once('[').map_or("", |(_, inside)| inside);
    inside.trim_end_matches(']').to_owned()
}

fn is_dates(cells: &Cells) -> bool {
    match cells {
        Cells::Texts(texts) => {
            let first: Texts = texts.first().into_iter().collect();
            !first.is_empty() && numbers(&first).is_err() && calendar::of_texts(&first).is_ok()
        }
        Cells::Numbers(..) | Cells::Sparse(..) | Cells::Integers(_) => false,
    }
}

/// Columns in a unit of time that run along with the time: other channels may have been sampled at their instants.
fn other_clocks(raw: &[Raw], at: usize, seconds: &[f64]) -> Option<Note> {
    let span = |values: &[f64]| Some(values.last()? - values.first()?);
    let whole = span(seconds).filter(|span| *span > 0.0)?;
    let runs_along = |column: &&Raw| {
        let unit = column
            .heading
            .known_unit()
            .filter(|unit| is_time_unit(unit));
        let (Some(unit), Cells::Numbers(values, None)) = (unit, &column.cells) else {
            return false;
        };
        let own = span(values).map_or(0.0, |span| unit.unit().to_si(span));
        (own - whole).abs() <= 0.01 * whole && values.windows(2).all(|pair| pair[1] >= pair[0])
    };
    let others = raw.iter().enumerate().filter(|(other, _)| *other != at);
    let other = others.map(|(_, column)| column).find(runs_along)?;
    let (time, other) = (&raw[at].heading.name, &other.heading.name);
    Some(Note::new(format!(
        "`{other}` runs along with the time `{time}`, at which all channels are read: make those that were sampled at `{other}` a record of their own, \
         `record other = \"FILE\" (time = {other:?})`"
    )))
}

/// Another column that looks like the time.
fn candidate(raw: &[Raw], but: usize) -> Option<Candidate> {
    let others = raw.iter().enumerate().filter(|(at, _)| *at != but);
    let mut timed = others.filter_map(|(_, column)| {
        let name = &column.heading.name;
        let in_unit = column.heading.known_unit().is_some_and(is_time_unit);
        let has_unit = match (in_unit, &column.heading.unit, temporal(name)) {
            (true, _, _) | (_, None, Temporal::In(_)) => true,
            (_, None, Temporal::Time) => false,
            _ => return None,
        };
        let name = name.clone();
        Some(Candidate { name, has_unit })
    });
    timed.next()
}

/// Whether a clock that read `before` has returned: it is nearer to the first time of the run.
pub(crate) fn is_anew(first: f64, before: f64, now: f64) -> bool {
    now < before && now - first < 0.5 * (before - first)
}

/// Time goes forward: not back, not anew, and not nowhere.
fn advances(
    seconds: &[f64],
    raw: &[Raw],
    at: usize,
    place: &dyn Fn(usize) -> String,
    shown: &dyn Fn(usize) -> String,
) -> Result<(), TimeError> {
    if let Some(row) = (1..seconds.len()).find(|&row| seconds[row] < seconds[row - 1]) {
        let (first, before, now) = (seconds[0], seconds[row - 1], seconds[row]);
        return Err(TimeError::RunsBack {
            place: place(row),
            times: (shown(row - 1), shown(row)),
            anew: is_anew(first, before, now),
        });
    }
    let (first, last) = (seconds.first(), seconds.last());
    if seconds.len() > 1 && first == last {
        return Err(TimeError::Stands {
            name: raw[at].heading.name.clone(),
            value: shown(0),
            instead: candidate(raw, at),
        });
    }
    Ok(())
}
