//! The heading of a column: its name, and its unit where that is written.

use hyde_units::{Dimension, NamedUnit, UnitError, parse_spelled};

/// Name and unit of a column.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Heading {
    /// As the file has it.
    pub(crate) written: String,
    /// Without the unit.
    pub(crate) name: String,
    /// The unit, or why its text is none; nothing where there is no such text.
    pub(crate) unit: Option<Result<NamedUnit, UnitError>>,
    /// Where the unit stands.
    pub(crate) place: Place,
    /// How the file spells the unit, where a model spells it otherwise: `Nm`.
    pub(crate) spelled: Option<String>,
    /// What the file says in another row that the column shows.
    pub(crate) meaning: Option<String>,
}

/// Where a unit stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// Behind the name in brackets, `x [mm]`, as Hyde writes it; or nowhere.
    Usual,
    /// Behind the name in parentheses: `x (mm)`.
    Parentheses,
    /// In a row of its own below the names.
    Row,
}

impl Heading {
    /// A name without a unit, whatever signs are in it.
    pub(crate) fn plain(name: &str) -> Self {
        let name = name.trim().to_owned();
        Self {
            written: name.clone(),
            name,
            unit: None,
            place: Place::Usual,
            spelled: None,
            meaning: None,
        }
    }

    /// Splits `x [mm]` or `x (mm)`.
    ///
    /// Brackets that close the cell hold a unit, except an index that stands at the name: `x[1]` is an element. What is in
    /// parentheses belongs to the name unless it is a unit.
    pub(crate) fn of(cell: &str) -> Self {
        let written = cell.trim();
        let cell = unquoted(written);
        let heading = |name: &str, unit, place| Self {
            written: written.to_owned(),
            name: name.trim_end().to_owned(),
            unit,
            place,
            spelled: None,
            meaning: None,
        };
        let bracketed = cell
            .strip_suffix(']')
            .and_then(|rest| rest.rsplit_once('['));
        if let Some((name, inside)) = bracketed
            && !is_index(name, inside)
        {
            return heading(name, Some(unit(inside)), Place::Usual).spelled_as(inside);
        }
        if let Some((name, inside, unit)) = in_parentheses(cell) {
            return heading(name, Some(Ok(unit)), Place::Parentheses).spelled_as(inside);
        }
        heading(cell, None, Place::Usual)
    }

    /// The same with the cell of a row of units below the name.
    pub(crate) fn with_row(mut self, cell: &str) -> Self {
        if let Some(unit) = of_row(cell)
            && self.unit.is_none()
        {
            self.unit = Some(unit);
            self.place = Place::Row;
            return self.spelled_as(bare(cell.trim()));
        }
        self
    }

    /// The same, whose unit the file spells like this.
    fn spelled_as(mut self, text: &str) -> Self {
        let other = |unit: &&NamedUnit| unit.text() != text.trim();
        let is_other = self.known_unit().filter(other).is_some();
        self.spelled = is_other.then(|| text.trim().to_owned());
        self
    }

    /// The same with the cell of a row that says what the columns show, `Position (mm)`; a unit may stand alone in it.
    pub(crate) fn with_meaning(mut self, cell: &str) -> Self {
        let shown = Self::of(cell);
        match (shown.known_unit(), of_row(cell)) {
            (Some(unit), _) if !shown.name.is_empty() => {
                self.unit = Some(Ok(unit.clone()));
                self.place = Place::Row;
                self.meaning = Some(shown.name);
                self.spelled = shown.spelled;
            }
            (_, Some(Ok(unit))) => {
                self.unit = Some(Ok(unit));
                self.place = Place::Row;
                return self.spelled_as(bare(cell.trim()));
            }
            (_, Some(Err(error))) => {
                if cell.trim().ends_with(')') {
                    self.unit = Some(Err(error));
                }
                self.meaning = Some(cell.trim().to_owned());
            }
            (_, None) => {}
        }
        self
    }

    /// Name and unit; what is no unit in brackets belongs to the name.
    pub(crate) fn named(self) -> (String, Option<NamedUnit>) {
        match self.unit {
            Some(Ok(unit)) => (self.name, Some(unit)),
            Some(Err(_)) | None => (self.written, None),
        }
    }

    /// The unit, if it is known.
    pub(crate) fn known_unit(&self) -> Option<&NamedUnit> {
        self.unit.as_ref()?.as_ref().ok()
    }
}

/// A cell without the single quotes that some controls write round it.
fn unquoted(cell: &str) -> &str {
    let inside = cell.strip_prefix('\'').and_then(|c| c.strip_suffix('\''));
    let inside = inside
        .filter(|inside| !inside.contains('\''))
        .map(str::trim);
    inside.filter(|inside| !inside.is_empty()).unwrap_or(cell)
}

/// The unit in a cell of a row of units, with or without brackets round it; nothing where the cell is empty.
pub(crate) fn of_row(cell: &str) -> Option<Result<NamedUnit, UnitError>> {
    let inside = bare(cell.trim());
    let none = ["", "-", "none", "n/a", "null"];
    if none.iter().any(|word| inside.eq_ignore_ascii_case(word)) {
        return None;
    }
    // `V (Voltage)`
    let symbol = inside.split_once(" (").map_or(inside, |(symbol, _)| symbol);
    Some(unit(inside).or_else(|_| unit(symbol)))
}

/// Whether a cell can be one of a row of units: empty, a unit, or anything in brackets.
pub(crate) fn may_be_of_row(cell: &str) -> bool {
    let cell = cell.trim();
    bare(cell) != cell || of_row(cell).is_none_or(|unit| unit.is_ok())
}

/// A unit as Hyde writes it or as devices do, or a time as loggers do: `sec`, `msec`.
fn unit(text: &str) -> Result<NamedUnit, UnitError> {
    parse_spelled(text).or_else(|error| {
        let word = unit_word(&text.trim().to_lowercase());
        word.and_then(|word| NamedUnit::parse(word).ok())
            .ok_or(error)
    })
}

/// The unit in a text of a preamble: `ms`, `nSec`, `Hz`.
pub(crate) fn unit_of_word(text: &str) -> Option<NamedUnit> {
    unit(text.trim()).ok()
}

fn bare(cell: &str) -> &str {
    let within = |open, close| cell.strip_prefix(open)?.strip_suffix(close);
    within('(', ')')
        .or_else(|| within('[', ']'))
        .unwrap_or(cell)
        .trim()
}

fn in_parentheses(cell: &str) -> Option<(&str, &str, NamedUnit)> {
    let (name, inside) = cell.strip_suffix(')')?.rsplit_once('(')?;
    let of_a_name = name.trim().is_empty() || name.contains(['(', '/']);
    let number = inside.chars().all(|c| !c.is_alphabetic() && c != '%');
    if of_a_name || number {
        return None;
    }
    Some((name, inside, unit(inside.trim()).ok()?))
}

fn is_index(name: &str, inside: &str) -> bool {
    let digits = inside
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, ',' | ' '));
    digits && inside.contains(|c: char| c.is_ascii_digit()) && !name.ends_with(char::is_whitespace)
}

/// What the name of a column says of its being a time.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Temporal {
    /// It is no name of a time.
    No,
    /// It is one.
    Time,
    /// It is one, or that of a frequency, and has the unit in it: `time_ms`, `Time/us`, `millis`, `f_Hz`.
    In(NamedUnit),
    /// It is the name of a frequency.
    Frequency,
}

/// Reads the name of a column as that of a time.
pub(crate) fn temporal(name: &str) -> Temporal {
    if name.trim() == "T" {
        return Temporal::No; // A temperature, as a rule.
    }
    let words = words(name);
    let all: Vec<&str> = words.iter().map(String::as_str).collect();
    if let ["f" | "freq" | "frequency" | "frequenz", unit @ ..] = all.as_slice() {
        let unit = match unit {
            [] => return Temporal::Frequency,
            ["hz"] | ["in", "hz"] => NamedUnit::parse("Hz"),
            _ => return Temporal::No,
        };
        return unit.map_or(Temporal::No, Temporal::In);
    }
    let (time, unit) = match all.as_slice() {
        [] => return Temporal::No,
        [rest @ .., last] if unit_word(last).is_some() && is_time(rest) => (true, unit_word(last)),
        [only] if only.len() > 1 && unit_word(only).is_some() => (true, unit_word(only)),
        [
            first @ ("ms" | "us" | "µs" | "ns" | "sec" | "millis" | "micros"),
            ..,
        ] => (true, unit_word(first)),
        rest => (is_time(rest), None),
    };
    match unit.and_then(|unit| NamedUnit::parse(unit).ok()) {
        Some(unit) => Temporal::In(unit),
        None if time => Temporal::Time,
        None => Temporal::No,
    }
}

/// The small words of a name: `motorTime_ms` has `motor`, `time` and `ms`.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for c in name.chars() {
        let new = !c.is_alphanumeric() || (before.is_lowercase() && c.is_uppercase());
        if new && words.last().is_some_and(|word| !word.is_empty()) {
            words.push(String::new());
        }
        if c.is_alphanumeric()
            && let Some(word) = words.last_mut()
        {
            word.extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}

fn is_time(words: &[&str]) -> bool {
    if let ["t"] | ["t", "in"] = words {
        return true;
    }
    let is = |word: &&str| {
        let endings = ["time", "zeit", "stamp", "elapsed", "uptime", "clock"];
        let whole = ["tiempo", "tempo", "temps", "czas", "tid", "aika"];
        endings.iter().any(|ending| word.ends_with(ending)) || whole.contains(word)
    };
    words.iter().any(is)
}

/// The unit that a word means.
fn unit_word(word: &str) -> Option<&'static str> {
    Some(match word {
        "s" | "sec" | "secs" | "second" | "seconds" | "sekunden" => "s",
        "ms" | "msec" | "millis" | "millisecond" | "milliseconds" => "ms",
        "us" | "µs" | "μs" | "usec" | "micros" | "microsecond" | "microseconds" => "us",
        "ns" | "nsec" | "nanos" | "nanosecond" | "nanoseconds" => "ns",
        _ => return None,
    })
}

/// Whether a dimension is that of time.
pub(crate) fn is_time_unit(unit: &NamedUnit) -> bool {
    let own = unit.unit().dimension;
    own.agreement(Dimension::TIME) == hyde_units::Agreement::Same
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_in_closing_brackets_and_indices_at_the_name() {
        let split = |cell| {
            let heading = Heading::of(cell);
            let unit = heading.known_unit().map(|unit| unit.text().to_owned());
            (heading.name, unit)
        };
        let with = |name: &str, unit: &str| (name.to_owned(), Some(unit.to_owned()));
        let bare = |name: &str| (name.to_owned(), None);
        assert_eq!(split(" x [mm] "), with("x", "mm"));
        assert_eq!(split("x[mm]"), with("x", "mm"));
        assert_eq!(split("th[3] [rad]"), with("th[3]", "rad"));
        assert_eq!(split("Butterworth.x[1]"), bare("Butterworth.x[1]"));
        assert_eq!(split("a[1,2]"), bare("a[1,2]"));
        assert_eq!(split("slip [1]"), with("slip", "1"));
        assert_eq!(split("qg_m"), bare("qg_m"));
        assert_eq!(split("Reference Velocity"), bare("Reference Velocity"));
        assert_eq!(split("Time (ms)"), with("Time", "ms"));
        assert_eq!(split("'POSF(mm)'"), with("POSF", "mm"));
        assert_eq!(split("v (mm s^-1)"), with("v", "mm.s^-1"));
        assert_eq!(split("Time [msec]"), with("Time", "ms"));
        assert_eq!(split("Channel 1 (V)"), with("Channel 1", "V"));
        assert_eq!(split("speed (raw)"), bare("speed (raw)"));
        assert_eq!(split("d(s)/d(m)"), bare("d(s)/d(m)"));
        assert_eq!(split("axis (1)"), bare("axis (1)"));
    }

    #[test]
    fn a_unit_may_be_spelled_as_devices_do() {
        for (cell, name, unit, spelled) in [
            ("M [Nm]", "M", "N.m", Some("Nm")),
            ("n (U/min)", "n", "rpm", Some("U/min")),
            ("Weg (inch)", "Weg", "in", Some("inch")),
            ("x [mm]", "x", "mm", None),
        ] {
            let heading = Heading::of(cell);
            assert_eq!(heading.name, name);
            assert_eq!(heading.known_unit().unwrap().text(), unit);
            assert_eq!(heading.spelled.as_deref(), spelled);
        }
        let below = Heading::of("M").with_row("(Nm)");
        assert_eq!(below.known_unit().unwrap().text(), "N.m");
        assert_eq!(below.spelled.as_deref(), Some("Nm"));
    }

    #[test]
    fn names_say_whether_they_are_times() {
        let unit = |name| match temporal(name) {
            Temporal::In(unit) => unit.text().to_owned(),
            Temporal::Time => "time".to_owned(),
            Temporal::Frequency => "frequency".to_owned(),
            Temporal::No => "no".to_owned(),
        };
        for (name, expected) in [
            ("t", "time"),
            ("Time", "time"),
            ("Timestamp", "time"),
            ("Zeit", "time"),
            ("motor_time", "time"),
            ("timestamp_ms", "ms"),
            ("t_us", "us"),
            ("Time/ms", "ms"),
            ("time in ms", "ms"),
            ("timeMs", "ms"),
            ("ms_today", "ms"),
            ("millis", "ms"),
            ("t_s", "s"),
            ("seconds", "s"),
            ("freq", "frequency"),
            ("f_Hz", "Hz"),
            ("Frequency in Hz", "Hz"),
            ("Sample", "no"),
            ("Index", "no"),
            ("temp_1", "no"),
            ("T", "no"),
            ("s", "no"),
            ("x_ms", "no"),
            ("T_motor", "no"),
        ] {
            assert_eq!(unit(name), expected, "{name}");
        }
    }
}
