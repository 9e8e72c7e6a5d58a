//! Reads a Parquet file whole.

use super::checksum;
use super::error::ReadError;
use crate::frame::{Field, Frame, Kind, Values};
use crate::heading::Heading;
use crc32fast::Hasher;
use hyde_units::{NamedUnit, parse_spelled};
use parquet::basic::Type as Physical;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use std::collections::BTreeMap;

/// The name of the thread that reads: what panics there is a damaged file.
pub const READER: &str = "reader of a Parquet file";

/// Reads the bytes of a file. Numbers of every width and truths become doubles, 64-bit integers stay integers.
///
/// # Errors
/// If they are no Parquet file of plain columns of numbers and texts.
pub fn read_frame(bytes: &[u8]) -> Result<Frame, ReadError> {
    // Of a damaged file the crate asserts what it should check: that is a mistake of the file, no end of the program. A thread
    // of its own keeps it, by whose name a program may pass over what it says.
    let damaged = || ReadError::Damaged("its parts are inconsistent".to_owned());
    std::thread::scope(|scope| {
        let reader = std::thread::Builder::new().name(READER.to_owned());
        let read = reader.spawn_scoped(scope, || frame(bytes));
        let read = read.map_err(|error| ReadError::Damaged(error.to_string()))?;
        read.join().unwrap_or_else(|_| Err(damaged()))
    })
}

fn frame(bytes: &[u8]) -> Result<Frame, ReadError> {
    let reader = SerializedFileReader::new(bytes::Bytes::copy_from_slice(bytes))?;
    let file = reader.metadata().file_metadata();
    // Other programs may write changed values with the notes of the file that they read.
    let own = file.created_by().is_some_and(|by| by.starts_with("hyde "));
    let (mut units, mut checksums) = (BTreeMap::new(), BTreeMap::new());
    let mut metadata = Vec::new();
    for note in file.key_value_metadata().into_iter().flatten() {
        let value = note.value.clone().unwrap_or_default();
        if let Some(column) = note.key.strip_prefix("unit:") {
            units.insert(column.to_owned(), value);
        } else if let Some(column) = note.key.strip_prefix(checksum::NOTE) {
            checksums.insert(column.to_owned(), value);
        } else {
            metadata.push((note.key.clone(), value));
        }
    }
    let mut fields = Vec::new();
    let mut values = Vec::new();
    for (at, column) in file.schema_descr().columns().iter().enumerate() {
        let (name, unit) = named(column, &units)?;
        if column.max_rep_level() > 0 || column.path().parts().len() > 1 {
            return Err(ReadError::Kind(name, "lists or groups".to_owned()));
        }
        let mut all: Option<Values> = None;
        for group in 0..reader.num_row_groups() {
            let group = reader.get_row_group(group)?;
            append(&mut all, of_group(group.as_ref(), at, &name)?);
        }
        let kind = match column.physical_type() {
            Physical::BYTE_ARRAY => Kind::Text,
            Physical::INT64 => Kind::Integer,
            Physical::BOOLEAN
            | Physical::INT32
            | Physical::INT96
            | Physical::FLOAT
            | Physical::DOUBLE
            | Physical::FIXED_LEN_BYTE_ARRAY => Kind::Number,
        };
        let all = all.unwrap_or(Values::empty(kind));
        if let Some(known) = checksums.get(column.name()).filter(|_| own) {
            let mut hasher = Hasher::new();
            checksum::add(&mut hasher, &all);
            if checksum::written(&hasher) != *known {
                return Err(ReadError::Damaged(format!(
                    "the values of `{name}` do not match their checksum"
                )));
            }
        }
        fields.push(Field {
            name,
            kind: all.kind(),
            unit,
        });
        values.push(all);
    }
    Ok(Frame {
        fields,
        values,
        metadata,
    })
}

/// Name and unit: by the metadata, else by the name, as in a CSV header.
fn named(
    column: &ColumnDescriptor,
    units: &BTreeMap<String, String>,
) -> Result<(String, Option<NamedUnit>), ReadError> {
    let name = column.name().to_owned();
    if let Some(unit) = units.get(&name) {
        let unit = parse_spelled(unit).map_err(|error| ReadError::Unit(name.clone(), error))?;
        return Ok((name, Some(unit)));
    }
    Ok(Heading::of(&name).named())
}

fn of_group(group: &dyn RowGroupReader, at: usize, name: &str) -> Result<Values, ReadError> {
    let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    let optional = group.metadata().column(at).column_descr().max_def_level() > 0;
    let numbers = |values: Vec<Option<f64>>| {
        Values::Numbers(values.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect())
    };
    let other = |kind: &str| Err(ReadError::Kind(name.to_owned(), kind.to_owned()));
    Ok(match group.get_column_reader(at)? {
        ColumnReader::DoubleColumnReader(mut column) => {
            numbers(cells(&mut column, rows, optional, |v| *v)?)
        }
        ColumnReader::FloatColumnReader(mut column) => {
            numbers(cells(&mut column, rows, optional, |v| f64::from(*v))?)
        }
        ColumnReader::Int32ColumnReader(mut column) => {
            numbers(cells(&mut column, rows, optional, |v| f64::from(*v))?)
        }
        ColumnReader::BoolColumnReader(mut column) => {
            numbers(cells(&mut column, rows, optional, |v| {
                f64::from(u8::from(*v))
            })?)
        }
        ColumnReader::Int64ColumnReader(mut column) => {
            let found = cells(&mut column, rows, optional, |v| *v)?;
            match found.iter().copied().collect::<Option<Vec<i64>>>() {
                Some(all) => Values::Integers(all),
                #[allow(clippy::cast_precision_loss, reason = "a record is of doubles")]
                None => numbers(found.into_iter().map(|v| v.map(|v| v as f64)).collect()),
            }
        }
        ColumnReader::ByteArrayColumnReader(mut column) => {
            let text = |v: &ByteArray| v.as_utf8().map(str::to_owned);
            let found = cells(&mut column, rows, optional, text)?;
            let found: Result<Vec<String>, _> = found
                .into_iter()
                .map(|v| v.unwrap_or(Ok(String::new())))
                .collect();
            Values::Texts(found?)
        }
        ColumnReader::Int96ColumnReader(_) => return other("old dates"),
        ColumnReader::FixedLenByteArrayColumnReader(_) => return other("bytes of fixed length"),
    })
}

/// The values of a column of a group of rows, with nulls.
fn cells<T: DataType, V>(
    column: &mut ColumnReaderImpl<T>,
    rows: usize,
    optional: bool,
    value: impl Fn(&T::T) -> V,
) -> Result<Vec<Option<V>>, ReadError> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    loop {
        let there = optional.then_some(&mut levels);
        let (read, _, _) = column.read_records(rows, there, None, &mut values)?;
        if read == 0 {
            break;
        }
    }
    let mut values = values.iter();
    let mut next = || values.next().map(&value);
    let cells: Vec<Option<V>> = if optional {
        levels
            .iter()
            .map(|&level| if level > 0 { next() } else { None })
            .collect()
    } else {
        std::iter::from_fn(next).map(Some).collect()
    };
    if cells.len() == rows {
        Ok(cells)
    } else {
        Err(ReadError::Damaged(
            "a column is shorter than the file says".to_owned(),
        ))
    }
}

/// Puts the values of the next group behind those before; integers with nulls have become numbers.
fn append(all: &mut Option<Values>, next: Values) {
    let Some(before) = all.take() else {
        *all = Some(next);
        return;
    };
    *all = Some(match (before, next) {
        (Values::Texts(mut texts), Values::Texts(more)) => {
            texts.extend(more);
            Values::Texts(texts)
        }
        (Values::Integers(mut integers), Values::Integers(more)) => {
            integers.extend(more);
            Values::Integers(integers)
        }
        (before, next) => {
            let mut numbers = doubles(before);
            numbers.extend(doubles(next));
            Values::Numbers(numbers)
        }
    });
}

#[allow(clippy::cast_precision_loss, reason = "a record is of doubles")]
fn doubles(values: Values) -> Vec<f64> {
    match values {
        Values::Numbers(values) => values,
        Values::Integers(values) => values.into_iter().map(|v| v as f64).collect(),
        Values::Texts(values) => vec![f64::NAN; values.len()],
    }
}
