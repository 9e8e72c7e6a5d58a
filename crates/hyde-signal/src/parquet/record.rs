//! Records as Parquet: columns of numbers over time.

use super::error::ReadError;
use super::read::read_frame;
use super::write::Writer;
use crate::assemble::{AssembleError, Cells, Raw, assemble};
use crate::column::Written;
use crate::frame::{Field, Values};
use crate::heading::{Heading, Place};
use crate::{Column, Fault, Layout, Table, contradicted};
use std::io;

/// So many rows are in memory twice.
const ROWS_OF_A_GROUP: usize = 65_536;

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
                Values::Texts(values) => Cells::Texts(values.into_iter().collect()),
            },
            heading: Heading {
                written: field.name.clone(),
                name: field.name,
                unit: field.unit.map(Ok),
                place: Place::Usual,
                spelled: None,
                meaning: None,
            },
        });
    let raw: Vec<Raw> = raw.collect();
    crate::declared::check(raw.iter(), &layout.columns).map_err(ReadError::Time)?;
    let place = |row: usize| format!("row {}", row + 1);
    let notes = contradicted::noted(&raw, layout.every_s, &place);
    assemble(raw, layout, notes.into_iter().collect(), &place).map_err(|error| match error {
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
    let columns: Vec<Written<'_>> = columns.into_iter().map(Column::written).collect();
    write_to(Vec::new(), &columns)
}

/// The same to a file, a group of rows at a time; gives the file back.
///
/// # Errors
/// What the file reports, or columns that are not equally long.
pub fn write_to<W: io::Write + Send>(file: W, columns: &[Written<'_>]) -> io::Result<W> {
    let fields = columns.iter();
    let fields: Vec<Field> = fields
        .map(|column| Field::number(column.name.as_ref(), column.unit.as_deref().cloned()))
        .collect();
    let mut writer = Writer::new(file, &fields, &[])?;
    let longest = columns.iter().map(|column| column.values.len()).max();
    let mut cells: Vec<_> = columns.iter().map(Written::in_unit).collect();
    // A file without rows has a group without rows.
    for _ in (0..longest.unwrap_or(0).max(1)).step_by(ROWS_OF_A_GROUP) {
        let groups = cells.iter_mut();
        let group: Vec<Values> = groups
            .map(|values| Values::Numbers(values.take(ROWS_OF_A_GROUP).collect()))
            .collect();
        writer.rows(&group)?;
    }
    writer.finish()
}
