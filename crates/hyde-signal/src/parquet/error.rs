//! What can be wrong with a Parquet file.

use crate::{TableError, TimeError};
use hyde_units::UnitError;
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
    /// No column is the time, or the one that should be is not.
    Time(TimeError),
    /// The columns make no table.
    Table(TableError),
}

impl ReadError {
    /// What to change, in the file or in the experiment that calls it `record`.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Damaged(_) => "write the file again, with Snappy compression or none".to_owned(),
            Self::Kind(..) => "remove the column, or write it as doubles".to_owned(),
            Self::Unit(..) => "write the unit as in a model: `N`, `mm`".to_owned(),
            Self::Time(error) => error.repair(record),
            Self::Table(_) => {
                "give every column a different name, and sort the samples by time".to_owned()
            }
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Damaged(reason) => write!(f, "the Parquet file cannot be read: {reason}"),
            Self::Kind(name, kind) => write!(f, "column `{name}` holds {kind}"),
            Self::Unit(name, error) => write!(f, "column `{name}`: {error}"),
            Self::Time(error) => error.fmt(f),
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
