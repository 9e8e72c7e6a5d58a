//! Tables as Parquet: records and results, and data sets with text in them.
//!
//! The [format](https://parquet.apache.org/docs/file-format/) has names and types of columns, no units. Hyde keeps the
//! unit of the column `x` in the key-value metadata of the file, as `unit:x`; the values are in that unit, as in CSV.
//! What other programs wrote may say the unit in the name, `x [mm]`, as a CSV header does.
//!
//! A [`Frame`] is what a file holds: columns of numbers, integers or texts. A record is one whose columns are numbers over
//! time: [`read`] and [`write()`]. A number that is not there (NaN) is a null. Equal frames give equal bytes.
//! The values of what Hyde wrote are checked against their checksums.

mod checksum;
mod error;
mod read;
mod record;
mod write;

pub use crate::frame::{Field, Frame, Kind, Values};
pub use error::ReadError;
pub use read::{READER, read_frame};
pub use record::{is_parquet, read, write, write_to};
pub use write::Writer;

#[cfg(test)]
mod tests;
