//! [`PlainRows`]: the rows of a text without quotes, as parts of it. A record has millions of rows: nothing is copied.

/// A line that begins with it is a comment.
pub(super) const COMMENT: u8 = b'#';

/// Goes through the rows of a text without quotes.
pub(super) struct PlainRows<'a> {
    text: &'a str,
    separator: u8,
    /// Where the search for the row began, and where it ends.
    begin: usize,
    end: usize,
    /// Without blanks round them.
    cells: Vec<&'a str>,
}

impl<'a> PlainRows<'a> {
    /// Before the first row.
    pub(super) fn new(text: &'a str, separator: u8) -> Self {
        Self {
            text,
            separator,
            begin: 0,
            end: if text.starts_with('\u{feff}') { 3 } else { 0 },
            cells: Vec::new(),
        }
    }

    /// Goes to the next row that is neither an empty line nor a comment; false if there is none.
    pub(super) fn advance(&mut self) -> bool {
        self.begin = self.end;
        self.cells.clear();
        let bytes = self.text.as_bytes();
        let mut at = self.begin;
        loop {
            match bytes.get(at) {
                None => {
                    self.end = at;
                    return false;
                }
                Some(b'\n' | b'\r') => at += 1,
                Some(&COMMENT) => {
                    let length = bytes[at..].iter().position(|byte| *byte == b'\n');
                    at = length.map_or(bytes.len(), |length| at + length + 1);
                }
                Some(_) => break,
            }
        }
        let mut cell = at;
        for (place, &byte) in bytes.iter().enumerate().skip(at) {
            if byte == self.separator {
                self.cells.push(trimmed(&self.text[cell..place]));
                cell = place + 1;
            } else if matches!(byte, b'\n' | b'\r') {
                self.cells.push(trimmed(&self.text[cell..place]));
                self.end = place + 1;
                return true;
            }
        }
        self.cells.push(trimmed(&self.text[cell..]));
        self.end = bytes.len();
        true
    }

    /// A cell of the row, without blanks round it; empty behind the last one.
    pub(super) fn cell(&self, at: usize) -> &'a str {
        self.cells.get(at).copied().unwrap_or("")
    }

    /// How many cells the row has.
    pub(super) fn count(&self) -> usize {
        self.cells.len()
    }

    /// Where the search for the row began: empty lines and comments may stand above it.
    pub(super) fn begin(&self) -> usize {
        self.begin
    }

    /// Where the row ends.
    pub(super) fn end(&self) -> usize {
        self.end
    }
}

/// Without blanks round it; most cells have none.
pub(super) fn trimmed(cell: &str) -> &str {
    match cell.as_bytes() {
        [b'!'..=b'~'] | [b'!'..=b'~', .., b'!'..=b'~'] => cell,
        _ => cell.trim(),
    }
}
