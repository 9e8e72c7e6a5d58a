//! A record in whichever form its file has.

use crate::foreign::{Foreign, foreign};
use crate::{Frame, Layout, Table, Unusable, csv, parquet};
use std::fmt;

/// Why a file is no record.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordError {
    /// It is a file of another kind.
    Foreign(Foreign),
    /// A mistake in a CSV text.
    Csv(csv::ReadError),
    /// A mistake in a Parquet file.
    Parquet(parquet::ReadError),
    /// A column cannot be used, where all of them are asked for.
    Column(Unusable),
}

/// Reads a record: Parquet if the file begins so, else CSV.
///
/// # Errors
/// If the file is no record.
pub fn read(bytes: &[u8], layout: &Layout) -> Result<Table, RecordError> {
    if let Some(foreign) = foreign(bytes) {
        return Err(RecordError::Foreign(foreign));
    }
    if parquet::is_parquet(bytes) {
        return parquet::read(bytes, layout).map_err(RecordError::Parquet);
    }
    csv::read(bytes, layout).map_err(RecordError::Csv)
}

/// The same for a file whose columns are all asked for.
///
/// # Errors
/// If the file is no record, or a column of it cannot be used.
pub fn read_whole(bytes: &[u8], layout: &Layout) -> Result<Table, RecordError> {
    let table = read(bytes, layout)?;
    match table.unusable().first() {
        Some(unusable) => Err(RecordError::Column(unusable.clone())),
        None => Ok(table),
    }
}

/// Reads a table that need not be over time and may have texts in it: Parquet if the file begins so, else CSV.
///
/// # Errors
/// If the file is no table.
pub fn read_frame(bytes: &[u8]) -> Result<Frame, RecordError> {
    if let Some(foreign) = foreign(bytes) {
        return Err(RecordError::Foreign(foreign));
    }
    if parquet::is_parquet(bytes) {
        return parquet::read_frame(bytes).map_err(RecordError::Parquet);
    }
    csv::read_frame(bytes).map_err(RecordError::Csv)
}

impl RecordError {
    /// What to change, in the file or in the experiment that calls it `record`.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Foreign(foreign) => foreign.repair().to_owned(),
            Self::Csv(error) => error.repair(record),
            Self::Parquet(error) => error.repair(record),
            Self::Column(unusable) => unusable.fault.repair.clone(),
        }
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Foreign(foreign) => foreign.fmt(f),
            Self::Csv(error) => error.fmt(f),
            Self::Parquet(error) => error.fmt(f),
            Self::Column(unusable) => unusable.fault.fmt(f),
        }
    }
}

impl std::error::Error for RecordError {}
