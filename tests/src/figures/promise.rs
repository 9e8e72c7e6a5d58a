//! [`Figure`]: a promise with the way it is measured, and the line it prints.

use std::cell::OnceCell;
use std::fmt;
use std::path::PathBuf;

/// What was promised of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// This number.
    Exactly(f64),
    /// This number or less.
    AtMost(f64),
    /// This number or more.
    AtLeast(f64),
    /// Less than this number.
    Below(f64),
    /// Between two numbers or one of them.
    Within(f64, f64),
}

impl Promise {
    /// Whether a number keeps the promise.
    #[must_use]
    #[allow(clippy::float_cmp, reason = "an exact number is promised")]
    pub fn holds(self, value: f64) -> bool {
        match self {
            Self::Exactly(bound) => value == bound,
            Self::AtMost(bound) => value <= bound,
            Self::AtLeast(bound) => value >= bound,
            Self::Below(bound) => value < bound,
            Self::Within(low, high) => (low..=high).contains(&value),
        }
    }
}

impl fmt::Display for Promise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Exactly(bound) => write!(f, "= {bound}"),
            Self::AtMost(bound) => write!(f, "<= {}", hyde_units::significant(*bound, 4)),
            Self::AtLeast(bound) => write!(f, ">= {bound}"),
            Self::Below(bound) => write!(f, "< {bound}"),
            Self::Within(low, high) => write!(f, "within {low}..{high}"),
        }
    }
}

/// What came of a measurement.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// The number, in the figure's unit.
    Value(f64),
    /// The number from less than it should be measured on, and what that was.
    Partly(f64, &'static str),
    /// Its data are not on this machine: what, and where it comes from.
    Absent(String),
}

/// A promise of the project.
#[derive(Clone, Copy)]
pub struct Figure {
    /// What it is called.
    pub name: &'static str,
    /// The unit of its number.
    pub unit: &'static str,
    /// What was promised.
    pub promise: Promise,
    /// Measures it.
    pub measure: fn(&Session) -> Result<Measured, String>,
}

impl Figure {
    /// The line of a measurement, and whether it falls short.
    #[must_use]
    pub fn line(&self, measured: &Result<Measured, String>) -> (String, bool) {
        let Self {
            name,
            unit,
            promise,
            ..
        } = self;
        let with = |value: f64, remark: &str| {
            let holds = promise.holds(value);
            let word = if holds { "ok" } else { "short" };
            let number = hyde_units::significant(value, 4);
            let line = format!("{name} {number} {unit} promised {promise} {word}{remark}");
            (line, !holds)
        };
        match measured {
            Ok(Measured::Value(value)) => with(*value, ""),
            Ok(Measured::Partly(value, what)) => with(*value, &format!(" ({what})")),
            Ok(Measured::Absent(what)) => (
                format!("{name} - {unit} promised {promise} absent: {what}"),
                false,
            ),
            Err(reason) => (
                format!("{name} - {unit} promised {promise} short: {reason}"),
                true,
            ),
        }
    }
}

/// What several figures share: where the data are, and runs that give more than one number.
pub struct Session {
    /// The folder with the measured records that are not shipped.
    pub data: PathBuf,
    /// What random numbers of long studies begin with.
    pub seed: u64,
    /// Whether what is sampled otherwise is measured in full.
    pub whole: bool,
    pub(crate) emps: OnceCell<Result<Vec<Measured>, String>>,
    pub(crate) bench: OnceCell<Result<Vec<Measured>, String>>,
    pub(crate) diagnoses: OnceCell<Result<Vec<super::diagnosis::SetResult>, String>>,
    pub(crate) two_mass: OnceCell<Result<Vec<Measured>, String>>,
    pub(crate) ivp: OnceCell<Result<Option<Vec<f64>>, String>>,
    pub(crate) waits: OnceCell<Result<super::lsp::Waits, String>>,
    pub(crate) fmus: OnceCell<Result<Vec<crate::fmu::Agreement>, String>>,
}

impl Session {
    /// Nothing measured yet.
    #[must_use]
    pub fn new(data: PathBuf) -> Self {
        Self {
            data,
            seed: 1,
            whole: false,
            emps: OnceCell::new(),
            bench: OnceCell::new(),
            diagnoses: OnceCell::new(),
            two_mass: OnceCell::new(),
            ivp: OnceCell::new(),
            waits: OnceCell::new(),
            fmus: OnceCell::new(),
        }
    }
}

/// How many of the first seeds have something wrong.
pub(super) fn count(
    seeds: u64,
    wrong: impl Fn(u64) -> Result<Option<String>, String>,
) -> Result<Measured, String> {
    let mut sum = 0_u32;
    for seed in 0..seeds {
        if let Some(reason) = wrong(seed)? {
            tell(seed, &reason);
            sum += 1;
        }
    }
    Ok(Measured::Value(f64::from(sum)))
}

#[allow(clippy::print_stderr, reason = "a figure that falls short says where")]
pub(super) fn tell(seed: u64, reason: &str) {
    eprintln!("seed {seed}: {reason}");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_number_promise_and_whether_it_is_kept() {
        let figure = Figure {
            name: "speed",
            unit: "m/s",
            promise: Promise::AtMost(2.0),
            measure: |_| Ok(Measured::Value(0.0)),
        };
        let line = |measured| figure.line(&Ok(measured));
        assert_eq!(
            line(Measured::Value(0.79)),
            ("speed 0.79 m/s promised <= 2 ok".to_owned(), false)
        );
        assert_eq!(
            line(Measured::Partly(2.5, "one record")),
            (
                "speed 2.5 m/s promised <= 2 short (one record)".to_owned(),
                true
            )
        );
        assert_eq!(
            line(Measured::Absent("no record".to_owned())).0,
            "speed - m/s promised <= 2 absent: no record"
        );
        // No number is no kept promise.
        assert!(line(Measured::Value(f64::NAN)).1);
        assert!(figure.line(&Err("it fails".to_owned())).1);
        assert_eq!(Promise::AtMost(1e-6).to_string(), "<= 1e-6");
        assert_eq!(Promise::Within(5.8, 5.9).to_string(), "within 5.8..5.9");
    }
}
