//! The rows of a CSV text, without blank lines and comments, and the line each of them is on.

use super::ReadError;
use crate::heading::Heading;
use ::csv::{ReaderBuilder, StringRecord};

/// Goes through the rows of a text.
pub(super) struct Rows<'a> {
    text: &'a str,
    lines_above: u64,
    separator: u8,
    /// Whether there is a quote anywhere.
    quoted: bool,
    reader: ::csv::Reader<&'a [u8]>,
    record: StringRecord,
}

impl<'a> Rows<'a> {
    /// Before the first row of a text that has so many lines above it.
    pub(super) fn new(text: &'a str, separator: u8, lines_above: u64) -> Self {
        Self {
            text,
            lines_above,
            separator,
            quoted: text.contains('"'),
            reader: reader(text, separator),
            record: StringRecord::new(),
        }
    }

    /// Goes to the next row that is not blank; false if there is none.
    pub(super) fn advance(&mut self) -> Result<bool, ReadError> {
        loop {
            let start = self.reader.position().byte();
            // Text from memory, in rows of any length: the reader has nothing to refuse.
            let more = self.reader.read_record(&mut self.record);
            if !more.map_err(|_| ReadError::Empty)? {
                return Ok(false);
            }
            if self.quoted && !self.is_well_quoted(start) {
                return Err(ReadError::Quotes { line: self.line() });
            }
            let comment = self
                .cells()
                .next()
                .is_some_and(|cell| cell.starts_with('%'));
            if !comment && self.cells().any(|cell| !cell.is_empty()) {
                return Ok(true);
            }
        }
    }

    /// Whether quotes stand round whole cells in what was read from there on.
    fn is_well_quoted(&self, start: u64) -> bool {
        let place = |byte: u64| {
            usize::try_from(byte)
                .unwrap_or(usize::MAX)
                .min(self.text.len())
        };
        let read = &self.text.as_bytes()[place(start)..place(self.reader.position().byte())];
        let (mut quoted, mut before) = (false, self.separator);
        let mut bytes = read.iter().copied().peekable();
        let is_border =
            |byte: u8| byte == self.separator || matches!(byte, b' ' | b'\t' | b'\r' | b'\n');
        while let Some(byte) = bytes.next() {
            match (byte, quoted) {
                (b'"', true) if bytes.peek() == Some(&b'"') => {
                    bytes.next();
                }
                (b'"', true) if bytes.peek().is_none_or(|next| is_border(*next)) => quoted = false,
                (b'"', false) if is_border(before) => quoted = true,
                (b'"', _) => return false,
                _ => {}
            }
            before = byte;
        }
        !quoted
    }

    /// The cells of the row, without blanks and quotes round them.
    pub(super) fn cells(&self) -> impl Iterator<Item = &str> {
        self.record.iter().map(str::trim)
    }

    /// Whether the row only says that the file ends, as TwinCAT's does.
    pub(super) fn is_end_mark(&self) -> bool {
        let mut cells = self.cells();
        cells.next() == Some("EOF") && cells.all(str::is_empty)
    }

    /// Whether the row is the header once more.
    pub(super) fn is_header(&self, headings: &[Heading]) -> bool {
        let again = |(cell, heading): (&str, &Heading)| cell == heading.written;
        self.cells().zip(headings).all(again)
    }

    /// The last cell of the row that begins there.
    pub(super) fn last_cell_at(&self, start: u64) -> Option<String> {
        let from = self.text.get(usize::try_from(start).ok()?..)?;
        let line = from
            .lines()
            .find(|line| !line.trim().is_empty() && !line.starts_with('#'))?;
        cells_of(line, self.separator).pop()
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.record.len()
    }

    /// Where the row begins.
    pub(super) fn position(&self) -> u64 {
        self.record.position().map_or(0, ::csv::Position::byte)
    }

    /// Whether the text ends within this row.
    pub(super) fn is_cut_off(&self) -> bool {
        let end = self.reader.position().byte();
        usize::try_from(end).is_ok_and(|end| end >= self.text.len())
            && !self.text.ends_with(['\n', '\r'])
    }

    /// The line of the row.
    pub(super) fn line(&self) -> u64 {
        self.line_at(self.position())
    }

    /// The line of a row by where it begins, from 1.
    pub(super) fn line_at(&self, start: u64) -> u64 {
        // The reader counts blank lines and comments above a row as part of it.
        let start = usize::try_from(start)
            .unwrap_or(usize::MAX)
            .min(self.text.len());
        let (before, from) = (
            &self.text.as_bytes()[..start],
            &self.text.as_bytes()[start..],
        );
        let above = before.iter().filter(|byte| **byte == b'\n').count();
        let lines = from.split(|byte| *byte == b'\n');
        let skipped = lines
            .take_while(|line| matches!(line, [] | [b'\r'] | [COMMENT, ..]))
            .count();
        self.lines_above + (above + skipped + 1) as u64
    }
}

/// The cells of one line.
pub(super) fn cells_of(line: &str, separator: u8) -> Vec<String> {
    let mut record = StringRecord::new();
    match reader(line, separator).read_record(&mut record) {
        Ok(true) => record.iter().map(|cell| cell.trim().to_owned()).collect(),
        Ok(false) | Err(_) => Vec::new(),
    }
}

fn reader(text: &str, separator: u8) -> ::csv::Reader<&[u8]> {
    ReaderBuilder::new()
        .delimiter(separator)
        .comment(Some(COMMENT))
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes())
}

const COMMENT: u8 = b'#';
