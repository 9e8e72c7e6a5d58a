//! What can be wrong with a CSV record, and where.

use crate::foreign::Foreign;
use crate::{TableError, TimeError};
use std::fmt;

/// A mistake in a CSV record. Lines count from 1.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is no text.
    Foreign(Foreign),
    /// There is no header, not even a line.
    Empty,
    /// The first line is a row of numbers.
    NoHeader {
        /// The line.
        line: u64,
    },
    /// The header stands once more between the rows.
    HeaderAgain {
        /// The line.
        line: u64,
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
            Self::Empty | Self::NoHeader { .. } => {
                "write a header of `name [unit]` columns as the first line, time in the first: `t [s],x [mm]`".to_owned()
            }
            Self::HeaderAgain { .. } => format!(
                "cut the file there into one file per run, and give them one by one: `--record {record}=PATH`"
            ),
            Self::NoRows => "write one row per sample below the header".to_owned(),
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

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign(foreign) => foreign.fmt(f),
            Self::Empty => write!(f, "the file is empty"),
            Self::NoHeader { line } => {
                write!(f, "line {line}: found a row of numbers instead of a header")
            }
            Self::HeaderAgain { line } => write!(
                f,
                "the file contains several runs: the header is repeated in line {line}"
            ),
            Self::NoRows => write!(f, "the file has a header but no samples"),
            Self::Ragged {
                line,
                found,
                expected,
            } => {
                let cells = if *found == 1 { "cell" } else { "cells" };
                write!(
                    f,
                    "line {line}: {found} {cells}, the header has {expected} columns"
                )
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
