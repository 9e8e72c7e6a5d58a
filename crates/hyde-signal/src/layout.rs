//! What is declared of a record's file beside what the file says itself.

use hyde_units::NamedUnit;

/// How a file is to be read; by default its first column is the time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Row k is at k times this period in s; no column is the time then.
    pub every_s: Option<f64>,
    /// The column that is the time.
    pub time: Option<TimeColumn>,
}

/// The column that is the time.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeColumn {
    /// Its name, with or without the unit behind it.
    pub name: String,
    /// Its unit, where the file does not say it.
    pub unit: Option<NamedUnit>,
}

impl Layout {
    /// Rows follow each other by a period in s.
    #[must_use]
    pub fn every(period_s: f64) -> Self {
        Self {
            every_s: Some(period_s),
            time: None,
        }
    }
}
