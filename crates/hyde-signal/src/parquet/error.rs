//! What can be wrong with a Parquet file.

use crate::TableError;
use hyde_units::{Dimension, UnitError};
use std::fmt;

/// A mistake in a Parquet file.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is no Parquet file, or a damaged one: what its reader says.
    Damaged(String),
    /// A column holds what is neither number nor text: its name and type.
    Kind(String, String),
    /// The unit of a column cannot be read.
    Unit(String, UnitError),
    /// A column of a record is no column of numbers.
    NotNumbers(String),
    /// A number of a record is not there or not finite: the column, and the row from 1.
    NotFinite(String, usize),
    /// The first column is no time, and no period was declared: its name and dimension.
    NoTime(String, Dimension),
    /// The columns make no table.
    Table(TableError),
}

impl ReadError {
    /// What to change in the file.
    #[must_use]
    pub fn repair(&self) -> String {
        match self {
            Self::Damaged(_) => {
                "write the file anew; compressed columns must be so by Snappy, or not at all".to_owned()
            }
            Self::Kind(..) => "leave the column out, or write it as doubles".to_owned(),
            Self::Unit(..) => "write the unit as in a model: `N`, `mm`".to_owned(),
            Self::NotNumbers(_) => "leave the column out: a record has numbers only".to_owned(),
            Self::NotFinite(..) => {
                "take the row out, or put the value in that belongs there: it cannot be guessed".to_owned()
            }
            Self::NoTime(..) => {
                "put a column of time first, or declare the time between rows: `record file every 1 [ms]`".to_owned()
            }
            Self::Table(_) => "give every column a name of its own, and sort the rows by time".to_owned(),
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Damaged(reason) => write!(f, "the Parquet file cannot be read: {reason}"),
            Self::Kind(name, kind) => write!(f, "column `{name}` holds {kind}"),
            Self::Unit(name, error) => write!(f, "column `{name}`: {error}"),
            Self::NotNumbers(name) => write!(f, "column `{name}` holds no numbers"),
            Self::NotFinite(name, row) => write!(f, "row {row}, column `{name}`: no finite number"),
            Self::NoTime(name, dimension) => {
                let unit = dimension.usual_unit();
                write!(
                    f,
                    "the first column, `{name} [{unit}]`, is no time and no period is declared"
                )
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

impl From<parquet::errors::ParquetError> for ReadError {
    fn from(error: parquet::errors::ParquetError) -> Self {
        Self::Damaged(error.to_string())
    }
}
