//! [`Results`]: what was measured, a row of `tests/ablation.csv` for each change and suite.

use crate::root;
use std::fmt::Write as _;
use std::path::PathBuf;

/// What came of a suite with a change.
#[derive(Clone, Debug, PartialEq)]
pub struct Result {
    /// The change, as [`super::Change`] calls it.
    pub change: String,
    /// The suite, as [`super::Suite`] calls it.
    pub suite: String,
    /// Its cases.
    pub cases: usize,
    /// Right answers among them.
    pub right: usize,
    /// False alarms among them.
    pub false_alarms: usize,
    /// The time that they took processors, s.
    pub seconds: f64,
    /// The answers, case by case.
    pub answers: String,
}

/// All rows.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// In the order measured.
    pub rows: Vec<Result>,
}

const HEAD: &str = "change,suite,cases,right,false_alarms,seconds,answers";

impl Results {
    /// The file of the project.
    #[must_use]
    pub fn path() -> PathBuf {
        root().join("tests/ablation.csv")
    }

    /// What was measured so far; nothing if there is no file.
    ///
    /// # Errors
    /// A row of the file is broken.
    #[allow(clippy::disallowed_methods, reason = "a file of the tests is read")]
    pub fn read() -> std::result::Result<Self, String> {
        let Ok(text) = std::fs::read_to_string(Self::path()) else {
            return Ok(Self::default());
        };
        let row = |line: &str| -> Option<Result> {
            let mut cells = line.splitn(7, ',');
            Some(Result {
                change: cells.next()?.to_owned(),
                suite: cells.next()?.to_owned(),
                cases: cells.next()?.parse().ok()?,
                right: cells.next()?.parse().ok()?,
                false_alarms: cells.next()?.parse().ok()?,
                seconds: cells.next()?.parse().ok()?,
                answers: cells.next()?.to_owned(),
            })
        };
        let lines = text.lines().skip(1);
        let rows = lines.map(|line| row(line).ok_or_else(|| format!("not a result: {line}")));
        Ok(Self {
            rows: rows.collect::<std::result::Result<_, String>>()?,
        })
    }

    /// Adds a row, also to the file.
    ///
    /// # Errors
    /// The file cannot be written.
    #[allow(
        clippy::disallowed_methods,
        reason = "a result is recorded in the project"
    )]
    pub fn add(&mut self, row: Result) -> std::result::Result<(), String> {
        self.rows.push(row);
        let mut text = format!("{HEAD}\n");
        for row in &self.rows {
            let _ = writeln!(
                text,
                "{},{},{},{},{},{:.1},{}",
                row.change,
                row.suite,
                row.cases,
                row.right,
                row.false_alarms,
                row.seconds,
                row.answers
            );
        }
        let path = Self::path();
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// The row of a change and a suite.
    #[must_use]
    pub fn of(&self, change: &str, suite: &str) -> Option<&Result> {
        let mut rows = self.rows.iter();
        rows.find(|row| row.change == change && row.suite == suite)
    }
}
