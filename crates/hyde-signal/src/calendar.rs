//! Stamps that count from elsewhere: dates, times of day, and numbers of digits that doubles do not hold.

mod zone;

pub use zone::Zone;

use crate::texts::Texts;
use chrono::{DateTime, NaiveDate};

/// What the clock of a record showed at the instant from which its time counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Since what it counts.
    pub since: Since,
    /// What it showed, in ns since then; in UTC where its stamps say their offset.
    pub nanoseconds: i128,
    /// The same as text.
    pub text: String,
    /// The zone of its first stamp; no name where it counts in numbers.
    pub zone: Zone,
}

/// Since what a clock counts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Since {
    /// 1970 or whatever it began with, in numbers.
    Number,
    /// The calendar, in dates.
    Date,
    /// A day that its stamps name so that day and month cannot be told apart.
    Day(String),
    /// Midnight.
    Midnight,
}

impl Origin {
    /// The same, whose stamps are times of a zone that they do not name.
    pub(crate) fn in_zone(self, zone: &Zone) -> Self {
        let utc = self.nanoseconds - zone.nanoseconds();
        let nanoseconds = match self.since {
            Since::Number => self.nanoseconds,
            Since::Midnight => utc.rem_euclid(DAY),
            Since::Date | Since::Day(_) => utc,
        };
        Self {
            nanoseconds,
            zone: zone.clone(),
            ..self
        }
    }
}

const NANOSECONDS: i128 = 1_000_000_000;
const DAY: i128 = 86_400 * NANOSECONDS;

/// Dates or times of day as seconds from the first one, with what that one was; else the first cell that is neither. Stamps
/// with an offset from UTC are the instants that they mean, wherever the offset changes.
pub(crate) fn of_texts(cells: &Texts) -> Result<(Vec<f64>, Origin), usize> {
    let mut stamps = Vec::with_capacity(cells.len());
    let first = cells.first().and_then(Stamp::of).ok_or(0_usize)?;
    let mut days = 0;
    for (row, cell) in cells.iter().enumerate() {
        let stamp = Stamp::of(cell).filter(|stamp| stamp.zone.is_like(&first.zone));
        let stamp = stamp.ok_or(row)?;
        let day = match (first.date, stamp.date) {
            (None, None) => {
                // A clock that goes back by half a day and more has passed midnight.
                let at = days * DAY + stamp.since_midnight();
                let passed = stamps.last().is_some_and(|before| before - at > DAY / 2);
                days += i128::from(passed);
                days
            }
            (Some(first), Some(date)) if first == date => 0,
            (Some(first), Some(date)) => {
                let between = day(date).zip(day(first)).map(|(date, first)| date - first);
                i128::from(between.ok_or(row)?)
            }
            (Some(_), None) | (None, Some(_)) => return Err(row),
        };
        stamps.push(day * DAY + stamp.since_midnight());
    }
    let (since, epoch) = match (first.date, first.date.and_then(day)) {
        (None, _) => (Since::Midnight, 0),
        (Some(_), Some(number)) => (Since::Date, i128::from(number)),
        (Some(date), None) => (Since::Day(date.to_owned()), 0),
    };
    let origin = Origin {
        nanoseconds: match since {
            Since::Midnight => first.since_midnight().rem_euclid(DAY),
            Since::Date | Since::Day(_) | Since::Number => epoch * DAY + first.since_midnight(),
        },
        since,
        text: cells[0].trim().to_owned(),
        zone: first.zone.clone(),
    };
    let seconds = stamps.iter().map(|at| seconds(at - stamps[0])).collect();
    Ok((seconds, origin))
}

#[allow(
    clippy::cast_precision_loss,
    reason = "what a double holds of it is enough"
)]
pub(crate) fn seconds(nanoseconds: i128) -> f64 {
    nanoseconds as f64 / 1e9
}

/// Date, time of day in ns, and zone.
#[derive(Clone)]
struct Stamp<'a> {
    date: Option<&'a str>,
    of_day: i128,
    zone: Zone,
}

impl<'a> Stamp<'a> {
    /// The ns since midnight of its date, in UTC where its offset is known.
    fn since_midnight(&self) -> i128 {
        self.of_day - self.zone.nanoseconds()
    }

    /// `2024-03-05T14:07:01.25Z`, `05.03.2024 14:07:01,250`, `14:07:01.25`.
    fn of(cell: &'a str) -> Option<Self> {
        let cell = cell.trim();
        let colon = cell.find(':')?;
        let hours = cell[..colon].rfind(|c: char| !c.is_ascii_digit());
        let (date, rest) = match hours {
            None => (None, cell),
            Some(at) => {
                let next = at + cell[at..].chars().next()?.len_utf8();
                let date = cell[..at].trim_end_matches(',').trim();
                (Some(date).filter(|date| !date.is_empty()), &cell[next..])
            }
        };
        let end = rest.find(|c: char| !(c.is_ascii_digit() || matches!(c, ':' | '.' | ',')));
        let (time, zone) = rest.split_at(end.unwrap_or(rest.len()));
        let zone = zone.trim();
        let (afternoon, zone) = match zone.get(..2).map(str::to_ascii_uppercase).as_deref() {
            Some("AM") => (Some(false), zone[2..].trim()),
            Some("PM") => (Some(true), zone[2..].trim()),
            _ => (None, zone),
        };
        let mut parts = time.split(':');
        let mut whole = |limit: i128| {
            let part: i128 = parts.next()?.parse().ok()?;
            (0..limit).contains(&part).then_some(part)
        };
        let (hours, minutes) = (whole(24)?, whole(60)?);
        let (seconds, fraction) = match parts.next()?.split_once(['.', ',']) {
            Some((seconds, fraction)) => (seconds.parse::<i128>().ok()?, fraction),
            None => (time.rsplit(':').next()?.parse::<i128>().ok()?, ""),
        };
        if parts.next().is_some() || seconds > 60 || fraction.contains(['.', ',']) {
            return None;
        }
        let hours = match afternoon {
            Some(true) => hours % 12 + 12,
            Some(false) => hours % 12,
            None => hours,
        };
        let nanoseconds: i128 = format!("{:0<9.9}", fraction).parse().ok()?;
        let of_day = ((hours * 60 + minutes) * 60 + seconds) * NANOSECONDS + nanoseconds;
        Some(Self {
            date,
            of_day,
            zone: Zone::of(zone),
        })
    }
}

/// Whether a cell is a date with a time of day, or one of them alone.
pub(crate) fn is_stamp(cell: &str) -> bool {
    Stamp::of(cell).is_some() || day(cell.trim()).is_some()
}

/// The number of a day; a day and a month that cannot be told apart are none.
fn day(date: &str) -> Option<i32> {
    use chrono::Datelike as _;
    let formats = [
        "%Y-%m-%d", "%d.%m.%Y", "%Y/%m/%d", "%Y%m%d", "%d-%b-%Y", "%d %b %Y",
    ];
    // Blanks between digits separate other things than day and month.
    let blanks = date.contains(char::is_whitespace);
    let mut read = formats
        .iter()
        .filter(|format| format.contains(' ') == blanks)
        .map(|format| NaiveDate::parse_from_str(date, format));
    Some(read.find_map(Result::ok)?.num_days_from_ce())
}

/// Numbers as seconds from the first one: their digits are subtracted, for doubles do not hold them all.
pub(crate) fn of_digits(cells: &Texts, unit_s: f64) -> Option<(Vec<f64>, Origin)> {
    let first = decimal(cells.first()?)?;
    let each = cells.iter().map(|cell| {
        let (digits, places) = decimal(cell)?;
        let common = places.max(first.1);
        let scaled = |(digits, places): (i128, u32)| {
            digits.checked_mul(10_i128.checked_pow(common - places)?)
        };
        Some(difference(
            scaled((digits, places))?.checked_sub(scaled(first)?)?,
            common,
            unit_s,
        ))
    });
    let seconds: Option<Vec<f64>> = each.collect();
    let text = cells[0].trim();
    Some((seconds?, number(first.0, first.1, unit_s, text)))
}

/// Whole numbers as seconds from the first one.
pub(crate) fn of_integers(values: &[i64], unit_s: f64) -> Option<(Vec<f64>, Origin)> {
    let first = i128::from(*values.first()?);
    let each = values
        .iter()
        .map(|value| difference(i128::from(*value) - first, 0, unit_s));
    Some((each.collect(), number(first, 0, unit_s, &first.to_string())))
}

/// Doubles as seconds from the first one.
pub(crate) fn of_doubles(values: &[f64], unit_s: f64) -> Option<(Vec<f64>, Origin)> {
    let first = *values.first()?;
    let each = values.iter().map(|value| (value - first) * unit_s);
    #[allow(clippy::cast_possible_truncation, reason = "a number of ns")]
    let nanoseconds = (first * unit_s * 1e9) as i128;
    let origin = counted(nanoseconds, unit_s, &first.to_string());
    Some((each.collect(), origin))
}

#[allow(clippy::cast_precision_loss, reason = "differences are small")]
fn difference(digits: i128, places: u32, unit_s: f64) -> f64 {
    // The shortest decimal first: 0.01, not 10 times 0.001.
    let places = f64::from(places) - unit_s.log10();
    let exact = (places - places.round()).abs() < 1e-9;
    match exact {
        #[allow(clippy::cast_possible_truncation, reason = "a power of ten")]
        true => digits as f64 / 10_f64.powi(places.round() as i32),
        false => digits as f64 * 10_f64.powf(-places),
    }
}

#[allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "a number of ns"
)]
fn number(digits: i128, places: u32, unit_s: f64, text: &str) -> Origin {
    let factor = unit_s * 1e9 / 10_f64.powi(i32::try_from(places).unwrap_or(0));
    let nanoseconds = match factor >= 1.0 && factor.fract() == 0.0 {
        true => digits.saturating_mul(factor as i128),
        false => (digits as f64 * factor) as i128,
    };
    counted(nanoseconds, unit_s, text)
}

/// Days from the beginning of our calendar to that of a spreadsheet, 1899-12-30.
const SPREADSHEET: i128 = 693_594;

/// What a clock showed that counts in units of that many s: since a time of its own or 1970; in days as a spreadsheet, from 2000
/// to 2100, since 1899-12-30.
fn counted(nanoseconds: i128, unit_s: f64, text: &str) -> Origin {
    let is_date =
        (unit_s - 86_400.0).abs() < 1e-6 && (36_526 * DAY..73_050 * DAY).contains(&nanoseconds);
    let zone = Zone::Named(String::new());
    match is_date {
        true => Origin {
            since: Since::Date,
            nanoseconds: nanoseconds + SPREADSHEET * DAY,
            text: match date_of(nanoseconds - 25_569 * DAY) {
                Some(date) => format!(
                    "{text}, the date {} of a spreadsheet",
                    date.format("%Y-%m-%d %H:%M:%S%.3f")
                ),
                None => text.to_owned(),
            },
            zone,
        },
        false => Origin {
            since: Since::Number,
            nanoseconds,
            text: shown(nanoseconds, text),
            zone,
        },
    }
}

/// The date of a number of ns since 1970.
fn date_of(nanoseconds: i128) -> Option<DateTime<chrono::Utc>> {
    let nanoseconds = i64::try_from(nanoseconds).ok();
    nanoseconds.map(DateTime::from_timestamp_nanos)
}

/// A number of ns as the date that it means if it is Unix time, else as it was written.
fn shown(nanoseconds: i128, text: &str) -> String {
    // From 2001 to 2100.
    let is_unix = (NANOSECONDS * 1_000_000_000..NANOSECONDS * 4_102_444_800).contains(&nanoseconds);
    match date_of(nanoseconds).filter(|_| is_unix) {
        Some(date) => format!(
            "{text}, in Unix time {}",
            date.format("%Y-%m-%d %H:%M:%S%.f UTC")
        ),
        None => text.to_owned(),
    }
}

/// The digits of a number and how many of them stand behind the point.
fn decimal(cell: &str) -> Option<(i128, u32)> {
    let cell = cell.trim();
    let (whole, fraction) = cell.split_once('.').unwrap_or((cell, ""));
    let fraction = fraction.trim_end_matches('0');
    let all = fraction.chars().all(|c| c.is_ascii_digit());
    let places = u32::try_from(fraction.len()).ok().filter(|_| all)?;
    Some((format!("{whole}{fraction}").parse().ok()?, places))
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "digits are subtracted exactly")]
mod tests {
    use super::*;

    fn texts(cells: &[&str]) -> Texts {
        cells.iter().collect()
    }

    #[test]
    fn dates_and_times_of_day_count_from_the_first() {
        for (cells, expected) in [
            (
                ["2024-03-05 14:07:01.000", "2024-03-05 14:07:01.002"],
                0.002,
            ),
            (["2024-02-28T23:59:59.5Z", "2024-02-29T00:00:00.25Z"], 0.75),
            (["31.12.2023 23:59:59,9", "01.01.2024 00:00:00,1"], 0.2),
            (["03/05/2024 14:07:01", "03/05/2024 14:07:03"], 2.0),
            (["14:07:01.25", "14:07:01.5"], 0.25),
            (["23:59:59.0", "00:00:01.0"], 2.0),
            (["11:59:59 AM", "12:00:01 PM"], 2.0),
            (
                ["2024-03-05 14:07:01+01:00", "2024-03-05 14:07:02+01:00"],
                1.0,
            ),
        ] {
            let (seconds, origin) = of_texts(&texts(&cells)).unwrap();
            assert_eq!(seconds, [0.0, expected], "{cells:?}");
            assert_eq!(origin.text, cells[0]);
        }
        for cells in [
            ["2024-03-05", "2024-03-06"],
            ["14:07", "14:08"],
            ["25:00:00", "25:00:01"],
        ] {
            assert_eq!(of_texts(&texts(&cells)).unwrap_err(), 0, "{cells:?}");
        }
        // Day and month, or month and day: not said.
        let cells = texts(&["03/05/2024 23:59:59", "03/06/2024 00:00:00"]);
        assert_eq!(of_texts(&cells).unwrap_err(), 1);
        assert!(!is_stamp("0001\t111"));
        // One stamp with an offset and one without: not said.
        let cells = texts(&["2024-03-05 14:07:01+01:00", "2024-03-05 14:07:02"]);
        assert_eq!(of_texts(&cells).unwrap_err(), 1);
    }

    #[test]
    fn stamps_with_offsets_are_instants() {
        // Summer time ends: 02:59:59.9 in it is 0.3 s before 02:00:00.2 in winter time.
        let cells = [
            "2023-10-29T02:59:59.900+02:00",
            "2023-10-29T02:00:00.200+01:00",
        ];
        let (seconds, origin) = of_texts(&texts(&cells)).unwrap();
        assert_eq!(seconds, [0.0, 0.3]);
        let since = |cell| of_texts(&texts(&[cell])).unwrap().1.nanoseconds;
        assert_eq!(origin.nanoseconds, since("2023-10-29T00:59:59.900Z"));
        assert_eq!(since("04:04:05+01:00"), since("03:04:05Z"));
        assert_eq!(since("00:30:00+01:00"), since("23:30:00Z"));
        let (_, origin) = of_texts(&texts(&["03/05/2024 14:07:01"])).unwrap();
        assert_eq!(origin.since, Since::Day("03/05/2024".to_owned()));
    }

    #[test]
    fn digits_that_a_double_does_not_hold_are_subtracted() {
        let cells = texts(&["1709647621.250000", "1709647621.260000", "1709647621.2501"]);
        let (seconds, origin) = of_digits(&cells, 1.0).unwrap();
        assert_eq!(seconds, [0.0, 0.01, 0.0001]);
        assert_eq!(origin.nanoseconds, 1_709_647_621_250_000_000);
        assert!(
            origin.text.contains("2024-03-05 14:07:01.250 UTC"),
            "{}",
            origin.text
        );
        let cells = texts(&["1709647621250000001", "1709647621250000003"]);
        assert_eq!(of_digits(&cells, 1e-9).unwrap().0, [0.0, 2e-9]);
        let (seconds, _) = of_integers(&[1_709_647_621_250, 1_709_647_621_252], 1e-3).unwrap();
        assert_eq!(seconds, [0.0, 0.002]);
        assert!(of_digits(&texts(&["1e9", "2e9"]), 1.0).is_none());
    }

    #[test]
    fn days_of_a_spreadsheet_are_dates() {
        let cells = texts(&["45000.25", "45000.75"]);
        let (seconds, origin) = of_digits(&cells, 86_400.0).unwrap();
        assert!((seconds[1] - 43_200.0).abs() < 1e-6, "{seconds:?}");
        assert!(
            origin.text.contains("2023-03-15 06:00:00"),
            "{}",
            origin.text
        );
        let (_, same) = of_texts(&texts(&["2023-03-15 06:00:00"])).unwrap();
        assert_eq!(
            (origin.since, origin.nanoseconds),
            (same.since, same.nanoseconds)
        );
    }
}
