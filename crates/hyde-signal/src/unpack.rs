//! [`unpacked`]: the bytes behind a decompressor, as far as they may be a record.

use std::io::Read;

/// What is packed becomes at most so long: more would be no record but a mistake.
const LONGEST: u64 = 4 << 30;

/// All bytes of a decompressor; why there are none if it fails or does not end.
pub(crate) fn unpacked(packed: impl Read) -> Result<Vec<u8>, String> {
    let mut out = Vec::new();
    match packed.take(LONGEST).read_to_end(&mut out) {
        Ok(length) if length as u64 == LONGEST => Err("it is longer than 4 GiB".to_owned()),
        Ok(_) => Ok(out),
        Err(error) => Err(error.to_string()),
    }
}
