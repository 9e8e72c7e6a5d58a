//! The files in a zip archive, by its directory at the end: stored or deflated, as NumPy writes them.

use super::ReadError;
use std::io::Read as _;

/// A file of an archive becomes at most so long.
const LONGEST: u64 = 4 << 30;

/// An entry of the directory.
pub(super) struct Entry<'a> {
    /// Name of the file.
    pub name: String,
    method: u16,
    length: usize,
    packed: &'a [u8],
}

/// The entries of an archive; none if it has no directory.
pub(super) fn entries(bytes: &[u8]) -> Option<Vec<Entry<'_>>> {
    let end = end_of_directory(bytes)?;
    let number = usize::from(u16_at(bytes, end + 10)?);
    let mut at = u32_at(bytes, end + 16)?;
    let mut entries = Vec::new();
    for _ in 0..number {
        if bytes.get(at..at + 4)? != b"PK\x01\x02" {
            return None;
        }
        let length = |place: usize| u16_at(bytes, at + place).map(usize::from);
        let (name, extra, comment) = (length(28)?, length(30)?, length(32)?);
        let text = bytes.get(at + 46..at + 46 + name)?;
        let local = u32_at(bytes, at + 42)?;
        let own_name = usize::from(u16_at(bytes, local + 26)?);
        let own_extra = usize::from(u16_at(bytes, local + 28)?);
        let begin = local + 30 + own_name + own_extra;
        entries.push(Entry {
            name: String::from_utf8_lossy(text).into_owned(),
            method: u16_at(bytes, at + 10)?,
            length: u32_at(bytes, at + 24)?,
            packed: bytes.get(begin..begin.checked_add(u32_at(bytes, at + 20)?)?)?,
        });
        at += 46 + name + extra + comment;
    }
    Some(entries)
}

/// The record at the end of an archive is 22 bytes and a comment of at most 65 535.
fn end_of_directory(bytes: &[u8]) -> Option<usize> {
    let last = bytes.len().checked_sub(22)?;
    let first = last.saturating_sub(usize::from(u16::MAX));
    (first..=last)
        .rev()
        .find(|&at| bytes[at..].starts_with(b"PK\x05\x06"))
}

impl Entry<'_> {
    /// What is in the file.
    pub(super) fn unpacked(&self) -> Result<Vec<u8>, ReadError> {
        let wrong = |reason: &str| ReadError::Damaged(format!("`{}`: {reason}", self.name));
        let mut out = Vec::new();
        match self.method {
            0 => out.extend(self.packed),
            8 => {
                let mut packed = flate2::read::DeflateDecoder::new(self.packed).take(LONGEST);
                packed
                    .read_to_end(&mut out)
                    .map_err(|error| wrong(&error.to_string()))?;
            }
            _ => return Err(wrong("it is packed in an unknown way")),
        }
        match out.len() == self.length {
            true => Ok(out),
            false => Err(wrong("it is not as long as the directory says")),
        }
    }
}

fn u16_at(bytes: &[u8], at: usize) -> Option<u16> {
    let bytes = bytes.get(at..at.checked_add(2)?)?;
    Some(u16::from_le_bytes(bytes.try_into().ok()?))
}

fn u32_at(bytes: &[u8], at: usize) -> Option<usize> {
    let bytes = bytes.get(at..at.checked_add(4)?)?;
    usize::try_from(u32::from_le_bytes(bytes.try_into().ok()?)).ok()
}
