//! What can be wrong with a CSV record, and where.

use crate::foreign::Foreign;
use crate::layout::Kind;
use crate::{TableError, TimeError};
use std::fmt;

/// A mistake in a CSV record. Lines count from 1.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is no text.
    Foreign(Foreign),
    /// No encoding is called so.
    Encoding(String),
    /// There is no header, not even a line.
    Empty,
    /// The first line is a row of numbers.
    NoHeader {
        /// The line.
        line: u64,
        /// How many numbers it has.
        columns: usize,
        /// Whether the first of them counts the rows.
        counted: bool,
    },
    /// There is no line of that number to be the header.
    NoLine {
        /// The line.
        line: u64,
    },
    /// Names and columns are not equally many.
    Names {
        /// The line of the names, or of the first row.
        line: u64,
        /// How many names there are.
        found: usize,
        /// How many columns there are.
        expected: usize,
    },
    /// A line above the first row that can be read begins as one.
    OddRow {
        /// The line.
        line: u64,
    },
    /// A quote stands within a cell.
    Quotes {
        /// The line.
        line: u64,
    },
    /// The layout is not of the declared kind.
    OtherKind {
        /// What it is.
        found: Kind,
        /// What it should be.
        declared: Kind,
    },
    /// The header stands once more between the rows.
    HeaderAgain {
        /// The line.
        line: u64,
    },
    /// There are not so many runs.
    NoRun {
        /// Which one was asked for.
        asked: usize,
        /// How many there are.
        found: usize,
    },
    /// A header without a row below it.
    NoRows,
    /// A row has more or fewer cells than the header.
    Ragged {
        /// The line.
        line: u64,
        /// The cells of the row.
        found: usize,
        /// The columns of the header.
        expected: usize,
    },
    /// No column is the time, or the one that should be is not.
    Time(TimeError),
    /// The columns make no table: there is none that can be used, or the period is no number above 0.
    Table(TableError),
}

impl ReadError {
    /// What to change, in the file or in the experiment that calls it `record`.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Foreign(foreign) => foreign.repair().to_owned(),
            Self::Encoding(_) => {
                "write `encoding = \"utf-8\"`, `\"utf-16le\"`, `\"windows-1252\"` or another name of the WHATWG's list"
                    .to_owned()
            }
            Self::Empty => {
                "write a header of `name [unit]` columns as the first line, time in the first: `t [s],x [mm]`".to_owned()
            }
            Self::NoHeader {
                columns,
                counted: true,
                ..
            } => format!(
                "say what its columns are and how far its rows are apart, which its first column counts: `record {record}(columns = \
                 \"number, {}\") every 1 [ms]`",
                columns_of(columns.saturating_sub(1))
            ),
            Self::NoHeader { columns, .. } => format!(
                "say what its columns are and how far its rows are apart: `record {record}(columns = \"{}\") every 1 [ms]`; \
                 or, where a column is the time, `record {record}(columns = \"t [s], {}\")`",
                columns_of(*columns),
                columns_of(columns.saturating_sub(1))
            ),
            Self::NoLine { .. } => format!(
                "say in which line the names of the columns are: `record {record}(header = 5)`"
            ),
            Self::Names { expected, .. } => format!(
                "say in which line the names of the columns are, `record {record}(header = 5)`, or name all {expected} columns in their \
                 order, those of the time too: `record {record}(columns = \"t [s], {}\")`",
                columns_of(expected.saturating_sub(1))
            ),
            Self::OddRow { .. } => {
                "write numbers in all its cells, or take the line out".to_owned()
            }
            Self::Quotes { .. } => {
                "put quotes round whole cells, and write one within a cell twice".to_owned()
            }
            Self::OtherKind { .. } => {
                "leave `layout` out, and look at what the file is with `hyde look`".to_owned()
            }
            Self::HeaderAgain { .. } | Self::Time(TimeError::RunsBack { anew: true, .. }) => format!(
                "select a run, counted from 1: `record {record}(run = 1)`; a calibration reads each as a separate record: `fit EXPERIMENT(\"FILE (run = 1)\"), EXPERIMENT(\"FILE (run = 2)\");`"
            ),
            Self::NoRun { found, .. } => format!("its runs are 1 to {found}: `record {record}(run = {found})`"),
            Self::NoRows => "write one row per sample below the header".to_owned(),
            Self::Ragged { found, expected, .. } if found < expected => {
                "give every row one cell per column, and the header no cell more".to_owned()
            }
            Self::Ragged { .. } => {
                "give every row one cell per column; a comma inside a number splits it into two cells".to_owned()
            }
            Self::Time(error) => error.repair(record),
            Self::Table(TableError::NoneUsable(_)) => {
                "write numbers: a record needs at least one column of numbers".to_owned()
            }
            Self::Table(_) => "give every column a different name".to_owned(),
        }
    }
}

/// `x [mm], …` for so many columns.
fn columns_of(columns: usize) -> String {
    let units = ["[mm]", "[mm/s]", "[A]"];
    let shown = (0..columns.min(3)).map(|at| format!("NAME{} {}", at + 1, units[at]));
    let more = (columns > 3).then(|| "…".to_owned());
    shown.chain(more).collect::<Vec<String>>().join(", ")
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign(foreign) => foreign.fmt(f),
            Self::Encoding(label) => write!(f, "there is no encoding `{label}`"),
            Self::Empty => write!(f, "the file is empty"),
            Self::NoHeader { line, .. } => {
                write!(f, "line {line}: found a row of numbers instead of a header")
            }
            Self::NoLine { line } => write!(f, "line {line} cannot be the header"),
            Self::Names {
                line,
                found: 0,
                expected,
            } => write!(
                f,
                "rows of {expected} cells begin in line {line}, and no line above them names {expected} columns"
            ),
            Self::Names {
                line,
                found,
                expected,
            } => write!(
                f,
                "line {line}: {found} names, and the rows have {expected} columns"
            ),
            Self::OddRow { line } => write!(
                f,
                "line {line} stands where rows begin, and is not a row of numbers"
            ),
            Self::Quotes { line } => write!(
                f,
                "line {line}: a quote stands within a cell, or has no end"
            ),
            Self::OtherKind { found, declared } => {
                write!(f, "the layout is {found}, not {declared}")
            }
            Self::HeaderAgain { line } => write!(
                f,
                "the file contains several runs: the header is repeated in line {line}"
            ),
            Self::NoRun { asked, found } => write!(
                f,
                "the file contains {}, and run {asked} is asked for",
                hyde_units::counted(*found, "run")
            ),
            Self::NoRows => write!(f, "the file has a header but no samples"),
            Self::Ragged {
                line,
                found,
                expected,
            } => {
                let cells = hyde_units::counted(*found, "cell");
                let columns = hyde_units::counted(*expected, "column");
                write!(f, "line {line}: {cells}, the header has {columns}")
            }
            Self::Time(error) => error.fmt(f),
            Self::Table(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {}

impl From<TimeError> for ReadError {
    fn from(error: TimeError) -> Self {
        Self::Time(error)
    }
}

impl From<TableError> for ReadError {
    fn from(error: TableError) -> Self {
        Self::Table(error)
    }
}
