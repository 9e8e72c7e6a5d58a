//! The rows of a CSV text, without blank lines and comments, and the line each of them is on.

use super::ReadError;
use ::csv::{ByteRecord, Reader, ReaderBuilder, Trim};

/// Goes through the rows of a text.
pub(super) struct Rows<'a> {
    text: &'a [u8],
    reader: Reader<&'a [u8]>,
    record: ByteRecord,
}

impl<'a> Rows<'a> {
    /// Before the first row.
    pub(super) fn new(text: &'a [u8], separator: u8) -> Self {
        let reader = ReaderBuilder::new()
            .delimiter(separator)
            .comment(Some(COMMENT))
            .has_headers(false)
            .flexible(true)
            .trim(Trim::All)
            .from_reader(text);
        Self {
            text,
            reader,
            record: ByteRecord::new(),
        }
    }

    /// Goes to the next row that is not blank; false if there is none.
    pub(super) fn advance(&mut self) -> Result<bool, ReadError> {
        loop {
            // Bytes from memory, in rows of any length: the reader has nothing to refuse.
            let more = self.reader.read_byte_record(&mut self.record);
            if !more.map_err(|_| ReadError::Encoding { line: self.line() })? {
                return Ok(false);
            }
            if self.record.len() > 1 || self.record.iter().any(|cell| !cell.is_empty()) {
                return Ok(true);
            }
        }
    }

    /// The cells of the row, without blanks and quotes round them.
    pub(super) fn cells(&self) -> impl ExactSizeIterator<Item = &[u8]> {
        self.record.iter()
    }

    /// The line of the row, from 1.
    pub(super) fn line(&self) -> u64 {
        // The reader counts blank lines and comments above a row as part of it.
        let start = self.record.position().map_or(0, ::csv::Position::byte);
        let start = usize::try_from(start)
            .unwrap_or(usize::MAX)
            .min(self.text.len());
        let is_newline = |byte: &&u8| **byte == b'\n';
        let above = self.text[..start].iter().filter(is_newline).count();
        let lines = self.text[start..].split(|byte| *byte == b'\n');
        let skipped = lines
            .take_while(|line| matches!(line, [] | [b'\r'] | [COMMENT, ..]))
            .count();
        (above + skipped + 1) as u64
    }
}

const COMMENT: u8 = b'#';
