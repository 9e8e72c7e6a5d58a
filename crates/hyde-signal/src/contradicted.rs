//! A period that is declared of a record whose file has a time as well: what that time says otherwise.

use crate::assemble::{Cells, Raw};
use crate::decimal::decimal;
use crate::gaps::seconds;
use crate::heading::{Temporal, is_time_unit, temporal};
use crate::statistics::median;
use crate::texts::Texts;
use crate::{Note, calendar};

/// So much may the step of a clock differ from the period: clocks drift.
const DRIFT: f64 = 0.01;

/// A step that differs from the period by more than this part of it lacks a row, or has one too many.
const ODD: f64 = 0.5;

/// So many places are named; the rest is counted.
const NAMED: usize = 3;

/// The column that would be the time if no period were declared.
pub(crate) fn passed_over<'r>(raw: impl Iterator<Item = &'r Raw>) -> Option<usize> {
    let is_time = |(at, column): (usize, &Raw)| {
        let timed = match (&column.heading.unit, temporal(&column.heading.name)) {
            (Some(Ok(unit)), _) => is_time_unit(unit),
            (Some(Err(_)), _) => false,
            (None, Temporal::In(unit)) => is_time_unit(&unit),
            (None, Temporal::Time) => true,
            (None, Temporal::No) => at == 0 && is_stamps(&column.cells),
            (None, Temporal::Frequency) => false,
        };
        timed.then_some(at)
    };
    raw.enumerate().find_map(is_time)
}

fn is_stamps(cells: &Cells) -> bool {
    match cells {
        Cells::Texts(texts) => texts.first().is_some_and(calendar::is_stamp),
        Cells::Numbers(..) | Cells::Sparse(..) | Cells::Integers(_) => false,
    }
}

/// What a file without lines says of that: see [`told`].
pub(crate) fn noted(
    raw: &[Raw],
    period_s: Option<f64>,
    place: &dyn Fn(usize) -> String,
) -> Option<Note> {
    let column = &raw[passed_over(raw.iter())?];
    told(column, period_s?, place)
}

/// What the instants of that column say otherwise than a period, in s; `place` names a row.
pub(crate) fn told(column: &Raw, period_s: f64, place: &dyn Fn(usize) -> String) -> Option<Note> {
    let clock = Clock::of(column, period_s)?;
    let steps: Vec<f64> = clock.at.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(&steps)?;
    // Of a count only how even it is can be compared.
    let expected = if clock.in_seconds { period_s } else { usual };
    // Rounding moves instants that are no whole number of last digits apart.
    let digits = expected / clock.last_digit;
    let digit = match (digits - digits.round()).abs() < 1e-6 {
        true => 0.0,
        false => clock.last_digit,
    };
    let slack = ODD * expected + digit;
    let is_odd = |step: f64| (step - expected).abs() > slack;
    let mean = (clock.at.last()? - clock.at.first()?) / steps.len() as f64;
    let drift = DRIFT * expected + clock.last_digit / steps.len() as f64;
    let none_odd = !steps.iter().any(|step| is_odd(*step));
    let forward = usual < 0.0 || steps.iter().all(|step| *step >= -digit);
    let found = if is_odd(usual) && forward {
        format!("its rows are {} apart", short(usual))
    } else if none_odd && (mean - expected).abs() > drift {
        format!("its rows are {} apart in the mean", short(mean))
    } else if none_odd {
        return None;
    } else {
        let list = |is: &dyn Fn(f64) -> bool| {
            let rows = (0..steps.len()).filter(|&row| is_odd(steps[row]) && is(steps[row]));
            let rows: Vec<usize> = rows.collect();
            let named: Vec<String> = (rows.iter().take(NAMED))
                .map(|row| place(row + 1))
                .collect();
            let more = match rows.len().saturating_sub(NAMED) {
                0 => String::new(),
                more => format!(" and {more} more"),
            };
            (!rows.is_empty()).then(|| named.join(", ") + &more)
        };
        let back = list(&|step| step < 0.0).map(|rows| format!("it runs back in {rows}"));
        let stands = list(&|step| (0.0..expected).contains(&step))
            .map(|rows| format!("it does not advance by a row in {rows}"));
        let gaps =
            list(&|step| step > expected).map(|rows| format!("rows are missing before {rows}"));
        [back, stands, gaps]
            .into_iter()
            .flatten()
            .collect::<Vec<String>>()
            .join(", ")
    };
    Some(Note::new(format!(
        "the time `{}` is not used, and contradicts `every`: {found}; `every` puts each row {} after the row before it",
        column.heading.name,
        seconds(period_s)
    )))
}

fn short(time_s: f64) -> String {
    format!("{} s", hyde_units::significant(time_s, 5))
}

/// The instants of a column as they stand.
struct Clock {
    at: Vec<f64>,
    /// One unit of the last digit that is written.
    last_digit: f64,
    /// Whether they are in s.
    in_seconds: bool,
}

impl Clock {
    fn of(column: &Raw, period_s: f64) -> Option<Self> {
        let said = match (&column.heading.unit, temporal(&column.heading.name)) {
            (Some(Ok(unit)), _) => Some(unit.unit().to_si(1.0)),
            (None, Temporal::In(unit)) => Some(unit.unit().to_si(1.0)),
            (None | Some(Err(_)), Temporal::No | Temporal::Time | Temporal::Frequency)
            | (Some(Err(_)), Temporal::In(_)) => None,
        };
        let numbers = |values: &[f64], last_digit: f64| {
            let factor = said.unwrap_or_else(|| unit_of(values, period_s));
            let finite = values.iter().all(|value| value.is_finite());
            // Whole numbers without a unit may count anything, others are seconds.
            let whole = values.iter().all(|value| value.fract() == 0.0);
            finite.then(|| Self {
                at: values.iter().map(|value| factor * value).collect(),
                last_digit: factor * last_digit,
                in_seconds: said.is_some() || !whole,
            })
        };
        match &column.cells {
            Cells::Texts(texts) => {
                let values: Option<Vec<f64>> = texts.iter().map(number).collect();
                match values {
                    Some(values) => numbers(&values, last_digit(texts)),
                    None => calendar::of_texts(texts).ok().map(|(at, _)| Self {
                        at,
                        last_digit: last_digit(texts),
                        in_seconds: true,
                    }),
                }
            }
            #[allow(clippy::cast_precision_loss, reason = "differences are of rows")]
            Cells::Integers(values) => {
                let values: Vec<f64> = values.iter().map(|value| *value as f64).collect();
                numbers(&values, 1.0)
            }
            Cells::Numbers(values, None) => numbers(values, 0.0),
            Cells::Numbers(_, Some(_)) | Cells::Sparse(..) => None,
        }
    }
}

/// The unit, in s, in which instants without one agree with the period; else a second.
fn unit_of(values: &[f64], period_s: f64) -> f64 {
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(&steps).unwrap_or(0.0);
    let agrees = |unit: &f64| (usual * unit - period_s).abs() <= DRIFT * period_s;
    [1.0, 1e-3, 1e-6].into_iter().find(agrees).unwrap_or(1.0)
}

fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    decimal(text)
        .map(|(value, _)| value)
        .or_else(|| text.parse().ok())
}

/// One unit of the last of the decimals that the cells have; 0 where they have exponents, as numbers of a double do.
fn last_digit(texts: &Texts) -> f64 {
    let decimals = |text: &str| {
        let number = text.rsplit(':').next().unwrap_or(text);
        let fraction = number.split_once(['.', ',']).map_or("", |(_, rest)| rest);
        fraction.bytes().take_while(u8::is_ascii_digit).count()
    };
    match texts.iter().any(|text| text.contains(['e', 'E'])) {
        true => 0.0,
        false => {
            let most = texts.iter().map(decimals).max().unwrap_or(0);
            10_f64.powi(-i32::try_from(most).unwrap_or(i32::MAX))
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Layout, read};

    fn told(header: &str, times: &[&str], every_s: f64) -> String {
        let rows: String = times.iter().map(|time| format!("{time},1\n")).collect();
        let text = format!("{header},x [mm]\n{rows}");
        let table = read(text.as_bytes(), &Layout::every(every_s)).unwrap();
        let mut notes = table.notes().iter().map(ToString::to_string);
        notes
            .find(|note| note.contains("contradicts"))
            .unwrap_or_default()
    }

    #[test]
    fn a_clock_that_agrees_is_passed_over_without_a_word() {
        for (header, times, every_s) in [
            ("t [s]", ["0", "0.001", "0.002", "0.003"], 1e-3),
            ("t [ms]", ["0", "1.002", "1.998", "3.001"], 1e-3),
            // Rounded to ms.
            ("t [s]", ["0", "0.001", "0.001", "0.002"], 5e-4),
            // In ms, which nobody says.
            ("t", ["0.5", "1.5", "2.5", "3.5"], 1e-3),
            // A count of samples.
            ("Time", ["7", "8", "9", "10"], 1e-3),
            ("x0 [mm]", ["7", "3", "9", "1"], 1e-3),
            (
                "time",
                [
                    "2024-03-05 10:00:00.000",
                    "2024-03-05 10:00:00.001",
                    "2024-03-05 10:00:00.002",
                    "2024-03-05 10:00:00.003",
                ],
                1e-3,
            ),
        ] {
            assert_eq!(told(header, &times, every_s), "", "{header}");
        }
    }

    #[test]
    fn a_clock_that_contradicts_the_period_is_told() {
        for (header, times, expected) in [
            (
                "t [s]",
                ["0", "0.002", "0.004", "0.006"],
                "its rows are 0.002 s apart;",
            ),
            (
                "t",
                ["0", "0.002", "0.004", "0.006"],
                "its rows are 0.002 s apart;",
            ),
            (
                "t [s]",
                ["0", "0.001", "0.007", "0.008"],
                "rows are missing before line 4;",
            ),
            (
                "t [s]",
                ["0", "0.001", "0.000", "0.001"],
                "it runs back in line 4;",
            ),
            (
                "t [s]",
                ["0", "0.002", "0.001", "0.003"],
                "it runs back in line 4, rows are missing before line 3, line 5;",
            ),
            (
                "Time",
                ["0", "1", "2", "9"],
                "rows are missing before line 5;",
            ),
            (
                "t [s]",
                ["0", "0.001", "0.001", "0.002"],
                "it does not advance by a row in line 4;",
            ),
            (
                "t [s]",
                ["0", "0.00105", "0.00210", "0.00315"],
                "its rows are 0.00105 s apart in the mean;",
            ),
            (
                "time",
                [
                    "2024-03-05 10:00:00.000",
                    "2024-03-05 10:00:00.001",
                    "2024-03-05 10:00:00.002",
                    "2024-03-05 10:00:01.003",
                ],
                "rows are missing before line 5;",
            ),
        ] {
            let note = told(header, &times, 1e-3);
            assert!(note.contains(expected), "{header} {times:?}: {note}");
        }
    }
}
