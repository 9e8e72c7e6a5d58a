//! Checksums of columns: the values of a file are those that were written, or the reader says that they are not.
//!
//! The format has checksums of pages, and the crate that writes it has none. So the CRC-32 of each column's values, as bytes in
//! their order, is a note of the file, `checksum:NAME`.

use crate::frame::Values;
use crc32fast::Hasher;

/// The beginning of the notes that hold them.
pub(super) const NOTE: &str = "checksum:";

/// Adds values to the checksum of their column; a missing number is the same one always.
pub(super) fn add(hasher: &mut Hasher, values: &Values) {
    match values {
        Values::Numbers(list) => list.iter().for_each(|&value| {
            let value = if value.is_nan() { f64::NAN } else { value };
            hasher.update(&value.to_bits().to_le_bytes());
        }),
        Values::Integers(list) => list
            .iter()
            .for_each(|value| hasher.update(&value.to_le_bytes())),
        Values::Texts(list) => list.iter().for_each(|text| {
            hasher.update(&(text.len() as u64).to_le_bytes());
            hasher.update(text.as_bytes());
        }),
    }
}

/// As the note has it.
pub(super) fn written(hasher: &Hasher) -> String {
    format!("{:08x}", hasher.clone().finalize())
}
