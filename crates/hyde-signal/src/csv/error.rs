//! What can be wrong with a CSV record, and where.

use crate::TableError;
use hyde_units::UnitError;
use std::fmt;

/// A mistake in a CSV record. Lines and columns count from 1; a column is a cell of the row, not a character.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// There is no header, not even a line.
    Empty,
    /// The first line is a row of numbers.
    NoHeader {
        /// The line.
        line: u64,
    },
    /// A header without a row below it.
    NoRows,
    /// The text is not UTF-8 here.
    Encoding {
        /// The line.
        line: u64,
    },
    /// A column of the header has no name.
    NoName {
        /// The column.
        column: usize,
    },
    /// The unit of a column of the header cannot be read.
    Unit {
        /// The column.
        column: usize,
        /// Its name.
        name: String,
        /// What is wrong with it.
        error: UnitError,
    },
    /// The first column is no time, and no period was declared.
    NoTime {
        /// The name of the first column.
        name: String,
        /// Its unit.
        unit: String,
    },
    /// A row has more or fewer cells than the header.
    Ragged {
        /// The line.
        line: u64,
        /// The cells of the row.
        found: usize,
        /// The columns of the header.
        expected: usize,
    },
    /// A cell is no number.
    NotANumber {
        /// The line.
        line: u64,
        /// The column.
        column: usize,
        /// The name of the column.
        name: String,
        /// The cell.
        text: String,
    },
    /// A cell is infinite or not-a-number.
    NotFinite {
        /// The line.
        line: u64,
        /// The column.
        column: usize,
        /// The name of the column.
        name: String,
        /// The cell.
        text: String,
    },
    /// The time of a row is before that of the row above it.
    TimeRunsBack {
        /// The line.
        line: u64,
        /// Its time, in the unit of the file.
        time: f64,
        /// The time above it.
        before: f64,
    },
    /// The columns make no table: a name is there twice, or the period is no number above 0.
    Table(TableError),
}

impl ReadError {
    /// What to change in the file.
    #[must_use]
    pub fn repair(&self) -> String {
        match self {
            Self::Empty | Self::NoHeader { .. } => {
                "write a header of `name [unit]` columns as the first line, time in the first: `t [s],x [mm]`".to_owned()
            }
            Self::NoRows => "write a row for every instant below the header".to_owned(),
            Self::Encoding { .. } => "save the file as UTF-8".to_owned(),
            Self::NoName { .. } => "give every column of the header a name".to_owned(),
            Self::Unit { .. } => "write the unit as in a model, `F [N]`, `x [mm]`".to_owned(),
            Self::NoTime { .. } => {
                "put a column of time first, or declare the time between rows: `record file every 1 [ms]`".to_owned()
            }
            Self::Ragged { .. } => {
                "give every row a cell for each column; a comma in a number splits it in two".to_owned()
            }
            Self::NotANumber { .. } => {
                "write numbers with a point, `0.5`; take rows that were not measured out".to_owned()
            }
            Self::NotFinite { .. } => {
                "take the row out, or put the value in that belongs there: it cannot be guessed".to_owned()
            }
            Self::TimeRunsBack { .. } => {
                "sort the rows by time, or declare the time between rows: `record file every 1 [ms]`".to_owned()
            }
            Self::Table(_) => "give every column a name of its own".to_owned(),
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "the file is empty"),
            Self::NoHeader { line } => {
                write!(
                    f,
                    "line {line}: a row of numbers stands where the header belongs"
                )
            }
            Self::NoRows => write!(f, "there is a header but no row"),
            Self::Encoding { line } => write!(f, "line {line}: not UTF-8 text"),
            Self::NoName { column } => write!(f, "column {column} has no name"),
            Self::Unit {
                column,
                name,
                error,
            } => {
                write!(f, "column {column} (`{name}`): {error}")
            }
            Self::NoTime { name, unit } => {
                write!(
                    f,
                    "the first column, `{name} [{unit}]`, is no time and no period is declared"
                )
            }
            Self::Ragged {
                line,
                found,
                expected,
            } => {
                write!(
                    f,
                    "line {line}: {found} cells, the header has {expected} columns"
                )
            }
            Self::NotANumber {
                line,
                column,
                name,
                text,
            } if text.is_empty() => {
                write!(
                    f,
                    "line {line}, column {column} (`{name}`): the cell is empty"
                )
            }
            Self::NotANumber {
                line,
                column,
                name,
                text,
            } => {
                write!(
                    f,
                    "line {line}, column {column} (`{name}`): `{text}` is no number"
                )?;
                let with_point = text.replacen(',', ".", 1);
                let comma = with_point != *text && with_point.parse::<f64>().is_ok();
                if comma {
                    write!(f, ": write `{with_point}`")
                } else {
                    Ok(())
                }
            }
            Self::NotFinite {
                line,
                column,
                name,
                text,
            } => {
                write!(
                    f,
                    "line {line}, column {column} (`{name}`): `{text}` is not finite"
                )
            }
            Self::TimeRunsBack { line, time, before } => {
                write!(f, "line {line}: time runs back from {before} to {time}")
            }
            Self::Table(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {}

impl From<TableError> for ReadError {
    fn from(error: TableError) -> Self {
        Self::Table(error)
    }
}
