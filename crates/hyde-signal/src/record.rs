//! A record in whichever form its file has.

use crate::{Frame, Table, csv, parquet};
use std::fmt;

/// Why a file is no record.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordError {
    /// A mistake in a CSV text.
    Csv(csv::ReadError),
    /// A mistake in a Parquet file.
    Parquet(parquet::ReadError),
}

/// Reads a record: Parquet if the file begins so, else CSV. The first column is the time unless a period in s is declared.
///
/// # Errors
/// If the file is no record.
pub fn read(bytes: &[u8], every: Option<f64>) -> Result<Table, RecordError> {
    if parquet::is_parquet(bytes) {
        return parquet::read(bytes, every).map_err(RecordError::Parquet);
    }
    csv::read(bytes, every).map_err(RecordError::Csv)
}

/// Reads a table that need not be over time and may have texts in it: Parquet if the file begins so, else CSV.
///
/// # Errors
/// If the file is no table.
pub fn read_frame(bytes: &[u8]) -> Result<Frame, RecordError> {
    if parquet::is_parquet(bytes) {
        return parquet::read_frame(bytes).map_err(RecordError::Parquet);
    }
    csv::read_frame(bytes).map_err(RecordError::Csv)
}

impl RecordError {
    /// What to change in the file.
    #[must_use]
    pub fn repair(&self) -> String {
        match self {
            Self::Csv(error) => error.repair(),
            Self::Parquet(error) => error.repair(),
        }
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Csv(error) => error.fmt(f),
            Self::Parquet(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for RecordError {}
