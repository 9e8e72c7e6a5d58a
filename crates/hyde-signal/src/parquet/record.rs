//! Records as Parquet: columns of numbers over time.

use super::error::ReadError;
use super::read::read_frame;
use super::write::Writer;
use crate::frame::{Field, Values};
use crate::table::may_be_first;
use crate::{Column, Table};
use std::io;

/// Whether a file is of this format, by its first bytes.
#[must_use]
pub fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1")
}

/// Reads a record; the first column is the time unless a period in s is declared.
///
/// # Errors
/// If it is no record: see [`ReadError`].
pub fn read(bytes: &[u8], every: Option<f64>) -> Result<Table, ReadError> {
    let frame = read_frame(bytes)?;
    let mut columns = Vec::new();
    for (field, values) in frame.fields.into_iter().zip(frame.values) {
        #[allow(clippy::cast_precision_loss, reason = "a record is of doubles")]
        let values = match values {
            Values::Numbers(values) => values,
            Values::Integers(values) => values.into_iter().map(|value| value as f64).collect(),
            Values::Texts(_) => return Err(ReadError::NotNumbers(field.name)),
        };
        if let Some(row) = values.iter().position(|value| !value.is_finite()) {
            return Err(ReadError::NotFinite(field.name, row + 1));
        }
        let raw = Column::raw(field.name, values);
        columns.push(match field.unit {
            Some(unit) => raw.converted(unit),
            None => raw,
        });
    }
    if let Some(period) = every {
        return Ok(Table::every(period, columns)?);
    }
    if let Some(time) = columns.first()
        && let Some(dimension) = time.dimension()
        && !may_be_first(dimension)
    {
        return Err(ReadError::NoTime(time.name().to_owned(), dimension));
    }
    Ok(Table::new(columns)?)
}

/// Writes columns, each in its unit; those of a table are `table.columns()`. They must be equally long.
///
/// # Errors
/// If they are not.
pub fn write<'a>(columns: impl IntoIterator<Item = &'a Column>) -> io::Result<Vec<u8>> {
    let columns: Vec<&Column> = columns.into_iter().collect();
    let fields: Vec<Field> = columns
        .iter()
        .map(|column| Field::number(column.name(), column.unit().cloned()))
        .collect();
    let values: Vec<Values> = columns
        .iter()
        .map(|column| Values::Numbers(column.in_unit().into_owned()))
        .collect();
    let mut writer = Writer::new(Vec::new(), &fields, &[])?;
    writer.rows(&values)?;
    writer.finish()
}
