//! Reads a CSV record into a table.

use super::ReadError;
use super::header::{name_and_unit, separator};
use super::rows::Rows;
use crate::table::may_be_first;
use crate::{Column, Table};
use hyde_units::NamedUnit;

/// Reads a record. Columns with a unit become SI; those without keep their values, see [`Column::with_unit`].
///
/// The first column is the time; without a unit it is in s. In a measured response it is the frequency. With `every`, a period in s, row k is at `k * every`
/// instead and all columns are ordinary ones. Several rows may have the same time.
///
/// # Errors
/// The first mistake in the file, with its line and column.
pub fn read(text: &[u8], every: Option<f64>) -> Result<Table, ReadError> {
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text);
    let mut rows = Rows::new(text, separator(text));
    if !rows.advance()? {
        return Err(ReadError::Empty);
    }
    if rows.cells().all(|cell| number(cell).is_some()) {
        return Err(ReadError::NoHeader { line: rows.line() });
    }
    let header = read_header(&rows)?;
    if every.is_none() {
        check_time_unit(&header[0])?;
    }
    let values = read_values(&mut rows, &header, every.is_none())?;
    let columns = header
        .into_iter()
        .zip(values)
        .map(|((name, unit), values)| {
            let raw = Column::raw(name, values);
            match unit {
                Some(unit) => raw.converted(unit),
                None => raw,
            }
        });
    let columns = columns.collect();
    Ok(match every {
        Some(period) => Table::every(period, columns)?,
        None => Table::new(columns)?,
    })
}

pub(super) type Header = Vec<(String, Option<NamedUnit>)>;

pub(super) fn read_header(rows: &Rows<'_>) -> Result<Header, ReadError> {
    let mut header = Header::new();
    for (cell, column) in rows.cells().zip(1..) {
        let cell = str::from_utf8(cell).map_err(|_| ReadError::Encoding { line: rows.line() })?;
        header.push(name_and_unit(cell, column)?);
    }
    Ok(header)
}

fn check_time_unit((name, unit): &(String, Option<NamedUnit>)) -> Result<(), ReadError> {
    match unit {
        Some(unit) if !may_be_first(unit.unit().dimension) => {
            let (name, unit) = (name.clone(), unit.text().to_owned());
            Err(ReadError::NoTime { name, unit })
        }
        Some(_) | None => Ok(()),
    }
}

/// All cells below the header, by column.
fn read_values(
    rows: &mut Rows<'_>,
    header: &Header,
    has_time: bool,
) -> Result<Vec<Vec<f64>>, ReadError> {
    let mut values = vec![Vec::new(); header.len()];
    while rows.advance()? {
        let (found, expected) = (rows.cells().len(), header.len());
        if found != expected {
            let line = rows.line();
            return Err(ReadError::Ragged {
                line,
                found,
                expected,
            });
        }
        for (at, (cell, column)) in rows.cells().zip(&mut values).enumerate() {
            column.push(number(cell).ok_or_else(|| bad_number(rows, at, cell, header))?);
        }
        if has_time {
            check_time(&values[0], rows)?;
        }
    }
    if values[0].is_empty() {
        return Err(ReadError::NoRows);
    }
    Ok(values)
}

fn number(cell: &[u8]) -> Option<f64> {
    let value: f64 = str::from_utf8(cell).ok()?.parse().ok()?;
    value.is_finite().then_some(value)
}

fn bad_number(rows: &Rows<'_>, at: usize, cell: &[u8], header: &Header) -> ReadError {
    let (line, column, name) = (rows.line(), at + 1, header[at].0.clone());
    let text = String::from_utf8_lossy(cell).into_owned();
    if text.parse::<f64>().is_ok() {
        ReadError::NotFinite {
            line,
            column,
            name,
            text,
        }
    } else {
        ReadError::NotANumber {
            line,
            column,
            name,
            text,
        }
    }
}

fn check_time(time: &[f64], rows: &Rows<'_>) -> Result<(), ReadError> {
    match time {
        [.., before, now] if now < before => {
            let (line, before, time) = (rows.line(), *before, *now);
            Err(ReadError::TimeRunsBack { line, time, before })
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests;
