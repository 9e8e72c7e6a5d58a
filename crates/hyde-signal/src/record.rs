//! A record in whichever form its file has.

use crate::foreign::{Foreign, foreign};
use crate::unpack::unpacked;
use crate::{Frame, Layout, Note, Table, Unusable, arrays, csv, parquet, sinumerik, workbook};
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
    /// A mistake in a file of a Sinumerik control.
    Sinumerik(sinumerik::ReadError),
    /// A mistake in a file of arrays.
    Arrays(arrays::ReadError),
    /// A mistake in a workbook.
    Workbook(workbook::ReadError),
    /// A compressed file that cannot be unpacked.
    Unpack(String),
    /// A run is asked for in a file that cannot have several.
    Run,
    /// A column cannot be used, where all of them are asked for.
    Column(Unusable),
}

/// Reads a record: what its first bytes say that it is, else CSV. A file that is packed by gzip is unpacked.
///
/// # Errors
/// If the file is no record.
pub fn read(bytes: &[u8], layout: &Layout) -> Result<Table, RecordError> {
    if bytes.starts_with(GZIP) {
        let mut table = read(&plain(bytes)?, layout)?;
        table.tell(Note::new("the file was unpacked (gzip)"));
        return Ok(table);
    }
    if arrays::is_of_arrays(bytes) {
        return arrays::read(bytes, layout).map_err(RecordError::Arrays);
    }
    if workbook::is_workbook(bytes) {
        return workbook::read(bytes, layout).map_err(RecordError::Workbook);
    }
    if bytes.starts_with(b"<") || bytes.starts_with(b"\xef\xbb\xbf<") {
        let text = xml(bytes);
        if sinumerik::is_of_control(&text) {
            one_run(layout)?;
            return sinumerik::read(&text, layout).map_err(RecordError::Sinumerik);
        }
    }
    if let Some(foreign) = foreign(bytes) {
        return Err(RecordError::Foreign(foreign));
    }
    if parquet::is_parquet(bytes) {
        one_run(layout)?;
        return parquet::read(bytes, layout).map_err(RecordError::Parquet);
    }
    csv::read(bytes, layout).map_err(RecordError::Csv)
}

/// Runs are told apart in texts, sheets and arrays only.
fn one_run(layout: &Layout) -> Result<(), RecordError> {
    match layout.run {
        Some(_) => Err(RecordError::Run),
        None => Ok(()),
    }
}

const GZIP: &[u8] = b"\x1f\x8b";

fn plain(bytes: &[u8]) -> Result<Vec<u8>, RecordError> {
    match unpacked(flate2::read::MultiGzDecoder::new(bytes)) {
        Ok(out) if out.starts_with(GZIP) => {
            Err(RecordError::Unpack("it is packed twice".to_owned()))
        }
        unpacked => unpacked.map_err(RecordError::Unpack),
    }
}

/// The text of a document: UTF-8, else Latin-1, which controls write.
fn xml(bytes: &[u8]) -> String {
    str::from_utf8(bytes).map_or_else(
        |_| encoding_rs::WINDOWS_1252.decode(bytes).0.into_owned(),
        str::to_owned,
    )
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
            Self::Sinumerik(error) => error.repair(record),
            Self::Arrays(error) => error.repair(record),
            Self::Workbook(error) => error.repair(record),
            Self::Run => "leave `run` out, and write one file per run".to_owned(),
            Self::Unpack(_) => "unpack it, and give the file in it".to_owned(),
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
            Self::Sinumerik(error) => error.fmt(f),
            Self::Arrays(error) => error.fmt(f),
            Self::Workbook(error) => error.fmt(f),
            Self::Run => write!(
                f,
                "a run is chosen in texts, workbooks and files of arrays only, not in a file of this kind"
            ),
            Self::Unpack(reason) => write!(f, "the file cannot be unpacked: {reason}"),
            Self::Column(unusable) => unusable.fault.fmt(f),
        }
    }
}

impl std::error::Error for RecordError {}
