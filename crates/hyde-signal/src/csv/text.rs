//! The text of a file, whatever its encoding.

use super::ReadError;
use crate::Note;
use crate::foreign::Foreign;
use encoding_rs::{Encoding, UTF_16BE, UTF_16LE, WINDOWS_1252};
use std::borrow::Cow;

/// The text, with lines that end with a line feed, and what was taken for granted of its encoding.
pub(super) fn decoded<'a>(
    bytes: &'a [u8],
    declared: Option<&str>,
) -> Result<(Cow<'a, str>, Option<Note>), ReadError> {
    let (text, note) = in_utf_8(bytes, declared)?;
    let only_returns = text.contains('\r') && !text.contains('\n');
    let text = match only_returns {
        true => Cow::Owned(text.replace('\r', "\n")),
        false => text,
    };
    Ok((text, note))
}

/// The text with what was taken for granted of its encoding: UTF-8, else UTF-16 if every other byte is zero or a mark says
/// so, else Windows-1252, of which ISO 8859-1 is a part.
fn in_utf_8<'a>(
    bytes: &'a [u8],
    declared: Option<&str>,
) -> Result<(Cow<'a, str>, Option<Note>), ReadError> {
    if let Some(label) = declared {
        let encoding = Encoding::for_label(label.as_bytes())
            .ok_or_else(|| ReadError::Encoding(label.to_owned()))?;
        return Ok((whole(encoding.decode(bytes).0), None));
    }
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
        let text = whole(encoding.decode(bytes).0);
        let note = (encoding != encoding_rs::UTF_8)
            .then(|| Note::new(format!("the file is read as {}", encoding.name())));
        return Ok((text, note));
    }
    if bytes.contains(&0) {
        return Err(ReadError::Foreign(Foreign::Binary));
    }
    if let Ok(text) = str::from_utf8(bytes) {
        return Ok((Cow::Borrowed(text), None));
    }
    let (text, ..) = WINDOWS_1252.decode(bytes);
    let note = Note::new("the file is not UTF-8: it is read as Windows-1252 (Latin-1)");
    Ok((text, Some(note)))
}

/// Without the sign for a character that the end of the file cut in two.
fn whole(text: Cow<'_, str>) -> Cow<'_, str> {
    match text.ends_with('\u{fffd}') {
        true => Cow::Owned(text.trim_end_matches('\u{fffd}').to_owned()),
        false => text,
    }
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
            assert_eq!(decoded(&bytes, None).unwrap().0, text);
        }
        let (read, note) = decoded(b"t [s],Temperatur [\xb0C]\n0,1\n", None).unwrap();
        assert_eq!(read, "t [s],Temperatur [°C]\n0,1\n");
        assert!(note.unwrap().to_string().contains("Windows-1252"));
        assert!(decoded(b"t,x\n0,\0\0\0\n", None).is_err());
        assert!(decoded(b"", None).unwrap().0.is_empty());
    }

    #[test]
    fn lines_may_end_with_a_carriage_return_alone() {
        assert_eq!(decoded(b"t,x\r0,1\r", None).unwrap().0, "t,x\n0,1\n");
        assert_eq!(
            decoded(b"t,x\r\n0,1\r\n", None).unwrap().0,
            "t,x\r\n0,1\r\n"
        );
    }
}
