//! Records as Parquet: columns of numbers over time.

use super::error::ReadError;
use super::read::read_frame;
use super::write::Writer;
use crate::assemble::{AssembleError, Cells, Raw, assemble};
use crate::frame::{Field, Values};
use crate::heading::{Heading, Place};
use crate::{Column, Fault, Layout, Table};
use std::io;

/// Whether a file is of this format, by its first bytes.
#[must_use]
pub fn is_parquet(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PAR1")
}

/// Reads a record; the time is the column that the layout says, else the first one.
///
/// # Errors
/// If it is no record: see [`ReadError`].
pub fn read(bytes: &[u8], layout: &Layout) -> Result<Table, ReadError> {
    let frame = read_frame(bytes)?;
    let raw = frame
        .fields
        .into_iter()
        .zip(frame.values)
        .map(|(field, values)| Raw {
            cells: match values {
                Values::Numbers(values) => match not_finite(&field.name, &values) {
                    Some(missing) => Cells::Sparse(values, missing),
                    None => Cells::Numbers(values, None),
                },
                Values::Integers(values) => Cells::Integers(values),
                Values::Texts(values) => Cells::Texts(values),
            },
            heading: Heading {
                written: field.name.clone(),
                name: field.name,
                unit: field.unit.map(Ok),
                place: Place::Usual,
                meaning: None,
            },
        });
    let raw: Vec<Raw> = raw.collect();
    crate::declared::check(raw.iter(), &layout.columns).map_err(ReadError::Time)?;
    let place = |row: usize| format!("row {}", row + 1);
    assemble(raw, layout, Vec::new(), &place).map_err(|error| match error {
        AssembleError::Time(error) => ReadError::Time(error),
        AssembleError::Table(error) => ReadError::Table(error),
    })
}

fn not_finite(name: &str, values: &[f64]) -> Option<Fault> {
    let row = values.iter().position(|value| !value.is_finite())?;
    Some(Fault {
        message: format!("row {}, column `{name}`: not a finite number", row + 1),
        repair: "remove the row, or insert the correct value: Hyde does not guess values"
            .to_owned(),
    })
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
