//! Places as the protocol counts them: lines from 0, and columns in units of UTF-16 or in bytes.

use lsp_types::{Position, Range};

/// In what columns are counted, as client and server agree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// Bytes.
    Utf8,
    /// Units of UTF-16, which every client knows.
    Utf16,
}

impl Encoding {
    /// The position of a byte; that of the end for one behind it.
    pub(crate) fn position(self, text: &str, byte: usize) -> Position {
        let byte = floor(text, byte);
        let before = &text[..byte];
        let line = before.matches('\n').count();
        let start = before.rfind('\n').map_or(0, |at| at + 1);
        let column = match self {
            Self::Utf8 => byte - start,
            Self::Utf16 => before[start..].encode_utf16().count(),
        };
        let clip = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
        Position::new(clip(line), clip(column))
    }

    /// The byte at a position. A column behind the end of its line is that end; a line behind the last is the end of the
    /// text.
    pub(crate) fn byte(self, text: &str, position: Position) -> usize {
        let mut start = 0;
        for _ in 0..position.line {
            match text[start..].find('\n') {
                Some(at) => start += at + 1,
                None => return text.len(),
            }
        }
        let line = text[start..].split('\n').next().unwrap_or_default();
        let line = line.strip_suffix('\r').unwrap_or(line);
        let wanted = position.character as usize;
        match self {
            Self::Utf8 => start + floor(line, wanted),
            Self::Utf16 => {
                let mut units = 0;
                for (at, sign) in line.char_indices() {
                    if units >= wanted {
                        return start + at;
                    }
                    units += sign.len_utf16();
                }
                start + line.len()
            }
        }
    }

    /// The range of some bytes.
    pub(crate) fn range(self, text: &str, bytes: std::ops::Range<usize>) -> Range {
        Range::new(
            self.position(text, bytes.start),
            self.position(text, bytes.end.max(bytes.start)),
        )
    }
}

/// The last boundary between characters that is not behind a byte.
fn floor(text: &str, byte: usize) -> usize {
    let mut at = byte.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_counted_in_utf_16_or_in_bytes() {
        let text = "a\r\n±𝛼y\nz";
        let y = text.find('y').unwrap();
        assert_eq!(Encoding::Utf16.position(text, y), Position::new(1, 3));
        assert_eq!(Encoding::Utf8.position(text, y), Position::new(1, 6));
        for encoding in [Encoding::Utf8, Encoding::Utf16] {
            for (byte, _) in text.char_indices().filter(|(_, sign)| *sign != '\n') {
                assert_eq!(encoding.byte(text, encoding.position(text, byte)), byte);
            }
            assert_eq!(encoding.byte(text, Position::new(0, 99)), 1);
            assert_eq!(encoding.byte(text, Position::new(99, 0)), text.len());
            assert_eq!(encoding.position(text, 999), Position::new(2, 1));
        }
        // In the middle of a character: its beginning or its end, and no panic.
        assert_eq!(Encoding::Utf8.byte(text, Position::new(1, 1)), 3);
    }
}
