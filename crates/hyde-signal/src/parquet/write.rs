//! Writes frames, a group of rows at a time.

use super::checksum;
use crate::frame::{Field, Kind, Values};
use crc32fast::Hasher;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::{ParquetError, Result};
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type;
use std::io::{self, Write};
use std::sync::Arc;

/// Writes a frame to `sink`, one group of rows after the other: only the group under way is in memory.
pub struct Writer<W: Write + Send> {
    fields: Vec<Field>,
    checksums: Vec<Hasher>,
    inner: SerializedFileWriter<W>,
}

impl<W: Write + Send> Writer<W> {
    /// Begins a file with these columns and this metadata, to which the units are added.
    ///
    /// # Errors
    /// What the sink reports, or names that cannot be those of columns.
    pub fn new(sink: W, fields: &[Field], metadata: &[(String, String)]) -> io::Result<Self> {
        let columns: Result<Vec<_>> = fields.iter().map(column).collect();
        let schema = Type::group_type_builder("hyde")
            .with_fields(columns.map_err(plain)?)
            .build()
            .map_err(plain)?;
        let units = fields.iter().filter_map(|field| {
            let unit = field.unit.as_ref()?.text().to_owned();
            Some(KeyValue::new(format!("unit:{}", field.name), unit))
        });
        let notes = metadata
            .iter()
            .map(|(key, value)| KeyValue::new(key.clone(), value.clone()));
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .set_created_by(format!("hyde {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(notes.chain(units).collect()))
            .build();
        let inner = SerializedFileWriter::new(sink, Arc::new(schema), Arc::new(properties));
        Ok(Self {
            fields: fields.to_vec(),
            checksums: vec![Hasher::new(); fields.len()],
            inner: inner.map_err(plain)?,
        })
    }

    /// Appends a group of rows: the values of every field, equally many.
    ///
    /// # Errors
    /// What the sink reports, or values that do not fit the fields.
    pub fn rows(&mut self, values: &[Values]) -> io::Result<()> {
        let rows = values.first().map_or(0, Values::len);
        let fit = values.len() == self.fields.len()
            && values
                .iter()
                .zip(&self.fields)
                .all(|(v, f)| v.len() == rows && v.kind() == f.kind);
        if !fit {
            return Err(io::Error::new(
                io::ErrorKind::InvalidInput,
                "the columns are not as announced",
            ));
        }
        for (hasher, values) in self.checksums.iter_mut().zip(values) {
            checksum::add(hasher, values);
        }
        self.group(values).map_err(plain)
    }

    fn group(&mut self, values: &[Values]) -> Result<()> {
        let mut group = self.inner.next_row_group()?;
        for column in values {
            let Some(mut writer) = group.next_column()? else {
                break;
            };
            match (writer.untyped(), column) {
                (ColumnWriter::DoubleColumnWriter(out), Values::Numbers(numbers)) => {
                    let there: Vec<f64> = numbers.iter().copied().filter(|v| !v.is_nan()).collect();
                    let levels: Vec<i16> = numbers.iter().map(|v| i16::from(!v.is_nan())).collect();
                    out.write_batch(&there, Some(&levels), None)?;
                }
                (ColumnWriter::Int64ColumnWriter(out), Values::Integers(integers)) => {
                    out.write_batch(integers, None, None)?;
                }
                (ColumnWriter::ByteArrayColumnWriter(out), Values::Texts(texts)) => {
                    let bytes: Vec<ByteArray> =
                        texts.iter().map(|text| text.as_str().into()).collect();
                    out.write_batch(&bytes, None, None)?;
                }
                (_, Values::Numbers(_) | Values::Integers(_) | Values::Texts(_)) => {
                    return Err(ParquetError::General(
                        "a column is not of its kind".to_owned(),
                    ));
                }
            }
            writer.close()?;
        }
        group.close()?;
        Ok(())
    }

    /// Ends the file and gives the sink back, with everything written to it.
    ///
    /// # Errors
    /// What the sink reports.
    pub fn finish(mut self) -> io::Result<W> {
        for (field, hasher) in self.fields.iter().zip(&self.checksums) {
            let key = format!("{}{}", checksum::NOTE, field.name);
            let note = KeyValue::new(key, checksum::written(hasher));
            self.inner.append_key_value_metadata(note);
        }
        self.inner.into_inner().map_err(plain)
    }
}

fn column(field: &Field) -> Result<Arc<Type>> {
    let (physical, repetition, logical) = match field.kind {
        Kind::Number => (Physical::DOUBLE, Repetition::OPTIONAL, None),
        Kind::Integer => (Physical::INT64, Repetition::REQUIRED, None),
        Kind::Text => (
            Physical::BYTE_ARRAY,
            Repetition::REQUIRED,
            Some(LogicalType::String),
        ),
    };
    let column = Type::primitive_type_builder(&field.name, physical)
        .with_repetition(repetition)
        .with_logical_type(logical)
        .build()?;
    Ok(Arc::new(column))
}

/// What the sink reported, where it did.
fn plain(error: ParquetError) -> io::Error {
    let ParquetError::External(inner) = error else {
        return io::Error::other(error);
    };
    match inner.downcast::<io::Error>() {
        Ok(error) => *error,
        Err(other) => io::Error::other(other),
    }
}
