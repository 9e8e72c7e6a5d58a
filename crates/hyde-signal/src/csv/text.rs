//! The text of a file, whatever its encoding.

use crate::Note;
use crate::foreign::Foreign;
use encoding_rs::{Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};
use std::borrow::Cow;

/// The text with what was taken for granted of its encoding: UTF-8, else UTF-16 if every other byte is zero or a mark says
/// so, else Windows-1252, of which ISO 8859-1 is a part.
pub(super) fn decoded(bytes: &[u8]) -> Result<(Cow<'_, str>, Option<Note>), Foreign> {
    let marked = Encoding::for_bom(bytes).map(|(encoding, _)| encoding);
    let zeros = |from: usize| {
        let start = &bytes[..bytes.len().min(64)];
        start.len() > 3 && start.iter().skip(from).step_by(2).all(|&byte| byte == 0)
    };
    let encoding = match marked {
        Some(encoding) => Some(encoding),
        None if zeros(1) => Some(UTF_16LE),
        None if zeros(0) => Some(UTF_16BE),
        None => None,
    };
    if let Some(encoding) = encoding {
        let (text, ..) = encoding.decode(bytes);
        let note = (encoding != encoding_rs::UTF_8)
            .then(|| Note::new(format!("the file is read as {}", encoding.name())));
        return Ok((text, note));
    }
    if bytes.contains(&0) {
        return Err(Foreign::Binary);
    }
    if let Ok(text) = str::from_utf8(bytes) {
        return Ok((Cow::Borrowed(text), None));
    }
    let (text, ..) = WINDOWS_1252.decode(bytes);
    let note = Note::new("the file is not UTF-8: it is read as Windows-1252 (Latin-1)");
    Ok((text, Some(note)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text() {
        let text = "t [s],φ [°]\n0,1\n";
        let wide =
            |order: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(order).collect::<Vec<u8>>();
        for bytes in [
            text.as_bytes().to_vec(),
            ["\u{feff}", text].concat().into_bytes(),
            [vec![0xff, 0xfe], wide(u16::to_le_bytes)].concat(),
            [vec![0xfe, 0xff], wide(u16::to_be_bytes)].concat(),
        ] {
            assert_eq!(decoded(&bytes).unwrap().0, text);
        }
        let (read, note) = decoded(b"t [s],Temperatur [\xb0C]\n0,1\n").unwrap();
        assert_eq!(read, "t [s],Temperatur [°C]\n0,1\n");
        assert!(note.unwrap().to_string().contains("Windows-1252"));
        assert!(decoded(b"t,x\n0,\0\0\0\n").is_err());
        assert!(decoded(b"").unwrap().0.is_empty());
    }
}
