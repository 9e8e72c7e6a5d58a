//! [`Level5`]: matrices, texts and cells of texts as elements with a type and a length.

/// Types of data.
const INT8: u32 = 1;
const UINT16: u32 = 4;
const INT32: u32 = 5;
const UINT32: u32 = 6;
const DOUBLE: u32 = 9;
const MATRIX: u32 = 14;
/// Classes of arrays.
const CELL: u32 = 1;
const CHAR: u32 = 4;
const NUMBER: u32 = 6;

/// A file that grows variable by variable.
#[derive(Clone, Debug)]
pub struct Level5 {
    bytes: Vec<u8>,
}

impl Level5 {
    /// A file with a text in its header, of which 116 characters are kept.
    #[must_use]
    pub fn new(about: &str) -> Self {
        let about = format!("MATLAB 5.0 MAT-file, {about}");
        let mut bytes: Vec<u8> = about.bytes().filter(u8::is_ascii).take(116).collect();
        bytes.resize(116, b' ');
        // No further data; version 1.0; little-endian.
        bytes.extend([0; 8]);
        bytes.extend([0x00, 0x01, b'I', b'M']);
        Self { bytes }
    }

    /// A matrix with so many rows, column by column.
    #[must_use]
    pub fn numbers(mut self, name: &str, rows: usize, columns: usize, values: &[f64]) -> Self {
        let data = values.iter().flat_map(|value| value.to_le_bytes());
        let data = (DOUBLE, data.collect::<Vec<u8>>());
        self.bytes
            .extend(array(name, NUMBER, (rows, columns), &[data]));
        self
    }

    /// A text.
    #[must_use]
    pub fn text(mut self, name: &str, text: &str) -> Self {
        self.bytes.extend(of_text(name, text));
        self
    }

    /// A column of texts.
    #[must_use]
    pub fn texts(mut self, name: &str, texts: &[String]) -> Self {
        let mut content = head(name, CELL, (texts.len(), 1));
        for text in texts {
            content.extend(of_text("", text));
        }
        self.bytes.extend(element(MATRIX, &content));
        self
    }

    /// The file.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

fn of_text(name: &str, text: &str) -> Vec<u8> {
    let units: Vec<u16> = text.encode_utf16().collect();
    let data = units.iter().flat_map(|unit| unit.to_le_bytes()).collect();
    let rows = usize::from(!units.is_empty());
    array(name, CHAR, (rows, units.len()), &[(UINT16, data)])
}

fn array(name: &str, class: u32, size: (usize, usize), parts: &[(u32, Vec<u8>)]) -> Vec<u8> {
    let mut content = head(name, class, size);
    for (kind, data) in parts {
        content.extend(element(*kind, data));
    }
    element(MATRIX, &content)
}

fn head(name: &str, class: u32, (rows, columns): (usize, usize)) -> Vec<u8> {
    let flags = [class.to_le_bytes(), [0; 4]].concat();
    let whole = |number: usize| i32::try_from(number).unwrap_or(i32::MAX).to_le_bytes();
    let size = [whole(rows), whole(columns)].concat();
    [
        element(UINT32, &flags),
        element(INT32, &size),
        element(INT8, name.as_bytes()),
    ]
    .concat()
}

/// Type, length and data, filled up to a multiple of 8 bytes.
fn element(kind: u32, data: &[u8]) -> Vec<u8> {
    let length = u32::try_from(data.len()).unwrap_or(u32::MAX);
    let mut bytes = [kind.to_le_bytes(), length.to_le_bytes()].concat();
    bytes.extend(data);
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}
