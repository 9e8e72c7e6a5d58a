//! [`Level4`]: matrices one behind the other, each with a header of five whole numbers and a name.

/// Numbers of 8 bytes, little-endian.
const NUMBERS: i32 = 0;
/// Whole numbers of 4 bytes.
const WHOLE: i32 = 20;
/// Characters of one byte.
const TEXT: i32 = 51;

/// A file that grows matrix by matrix; all are column by column.
#[derive(Clone, Debug, Default)]
pub struct Level4 {
    bytes: Vec<u8>,
}

impl Level4 {
    /// A matrix of numbers with so many rows.
    #[must_use]
    pub fn numbers(mut self, name: &str, rows: usize, values: &[f64]) -> Self {
        self.head(name, NUMBERS, rows, values.len());
        for value in values {
            self.bytes.extend(value.to_le_bytes());
        }
        self
    }

    /// A matrix of whole numbers with so many rows.
    #[must_use]
    pub fn whole(mut self, name: &str, rows: usize, values: &[i32]) -> Self {
        self.head(name, WHOLE, rows, values.len());
        for value in values {
            self.bytes.extend(value.to_le_bytes());
        }
        self
    }

    /// A matrix of characters with one text in each column, blanks behind the shorter ones.
    #[must_use]
    pub fn texts_in_columns(mut self, name: &str, texts: &[String]) -> Self {
        let longest = texts.iter().map(String::len).max().unwrap_or(0).max(1);
        self.head(name, TEXT, longest, longest * texts.len());
        for text in texts {
            self.bytes.extend(text.as_bytes());
            let blanks = longest - text.len();
            self.bytes.extend(std::iter::repeat_n(b' ', blanks));
        }
        self
    }

    /// A matrix of characters with one text in each row.
    #[must_use]
    pub fn texts_in_rows(mut self, name: &str, texts: &[&str]) -> Self {
        let longest = texts.iter().map(|text| text.len()).max().unwrap_or(0);
        self.head(name, TEXT, texts.len(), longest * texts.len());
        for column in 0..longest {
            for text in texts {
                let byte = text.as_bytes().get(column);
                self.bytes.push(byte.copied().unwrap_or(b' '));
            }
        }
        self
    }

    /// The file.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }

    fn head(&mut self, name: &str, kind: i32, rows: usize, count: usize) {
        let columns = count.checked_div(rows).unwrap_or(0);
        let whole = |number: usize| i32::try_from(number).unwrap_or(i32::MAX);
        let head = [kind, whole(rows), whole(columns), 0, whole(name.len() + 1)];
        for number in head {
            self.bytes.extend(number.to_le_bytes());
        }
        self.bytes.extend(name.as_bytes());
        self.bytes.push(0);
    }
}
