//! MATLAB files of level 5, as versions 5 to 7 write them: numeric arrays, plain or compressed.
//!
//! Layout: The MathWorks, *MAT-File Format*.

use super::number::number;
use super::{Array, Content, ReadError, places};
use crate::unpack::unpacked;

const HEADER: usize = 128;
const INT8: u32 = 1;
const COMPRESSED: u32 = 15;
const MATRIX: u32 = 14;
/// Classes of arrays: from doubles to whole numbers of 64 bits.
const NUMERIC: std::ops::RangeInclusive<u8> = 6..=15;
/// The flag of an array that has an imaginary part.
const COMPLEX: u8 = 0x08;

/// Whether a file is one of MATLAB.
pub(super) fn is_mat(bytes: &[u8]) -> bool {
    bytes.starts_with(b"MATLAB ")
}

/// Reads its numeric arrays.
pub(super) fn read(bytes: &[u8]) -> Result<Content, ReadError> {
    if bytes.starts_with(b"MATLAB 7.3") {
        return Err(ReadError::Hdf5);
    }
    let big = match bytes.get(126..HEADER) {
        Some(b"IM") => false,
        Some(b"MI") => true,
        _ => return Err(cut_off()),
    };
    let mut content = Content::default();
    let mut rest = &bytes[HEADER..];
    while !rest.is_empty() {
        let element = element(&mut rest, big).ok_or_else(cut_off)?;
        match element.kind {
            COMPRESSED => {
                let plain = unpacked(flate2::read::ZlibDecoder::new(element.data));
                let plain = plain.map_err(ReadError::Damaged)?;
                let mut plain = plain.as_slice();
                let inner = self::element(&mut plain, big).ok_or_else(cut_off)?;
                if inner.kind == MATRIX {
                    add(&mut content, inner.data, big)?;
                }
            }
            MATRIX => add(&mut content, element.data, big)?,
            _ => {}
        }
    }
    Ok(content)
}

fn cut_off() -> ReadError {
    ReadError::Damaged("it is cut off or not a MATLAB file of level 5".to_owned())
}

struct Element<'a> {
    kind: u32,
    data: &'a [u8],
}

/// Takes the next element; a short one has its data in its tag.
fn element<'a>(rest: &mut &'a [u8], big: bool) -> Option<Element<'a>> {
    let first = u32_of(rest.get(..4)?, big)?;
    let (kind, short) = (first & 0xffff, first >> 16);
    if short > 0 {
        let data = rest.get(4..8)?.get(..usize::try_from(short).ok()?)?;
        *rest = &rest[8..];
        return Some(Element { kind, data });
    }
    let length = usize::try_from(u32_of(rest.get(4..8)?, big)?).ok()?;
    let end = length.checked_add(8)?;
    let data = rest.get(8..end)?;
    // A compressed element is not filled up to a multiple of 8 bytes.
    let next = match kind == COMPRESSED {
        true => end,
        false => end.next_multiple_of(8).min(rest.len()),
    };
    *rest = &rest[next..];
    Some(Element { kind, data })
}

/// Adds an array, or the name of one that has no real numbers.
fn add(content: &mut Content, mut data: &[u8], big: bool) -> Result<(), ReadError> {
    let rest = &mut data;
    let flags = element(rest, big).ok_or_else(cut_off)?;
    let flags = u32_of(flags.data.get(..4).ok_or_else(cut_off)?, big).ok_or_else(cut_off)?;
    let [class, bits, ..] = flags.to_le_bytes();
    let axes = element(rest, big).ok_or_else(cut_off)?;
    let axes = axes.data.chunks_exact(4);
    let axes = axes.map(|axis| usize::try_from(u32_of(axis, big)?).ok());
    let shape: Vec<usize> = axes.collect::<Option<_>>().ok_or_else(cut_off)?;
    let name = element(rest, big).filter(|name| name.kind == INT8);
    let name = String::from_utf8_lossy(name.ok_or_else(cut_off)?.data).into_owned();
    if !NUMERIC.contains(&class) || bits & COMPLEX != 0 {
        content.others.push(name);
        return Ok(());
    }
    let numbers = element(rest, big).ok_or_else(cut_off)?;
    let values = values(&numbers, big).filter(|values| places(&shape) == Some(values.len()));
    let values = values.ok_or_else(cut_off)?;
    content.arrays.push(Array {
        name,
        values: last_axis_fastest(&values, &shape),
        shape,
    });
    Ok(())
}

/// Numbers that were written with the first axis fastest.
pub(super) fn last_axis_fastest(values: &[f64], shape: &[usize]) -> Vec<f64> {
    let mut strides = Vec::with_capacity(shape.len());
    let mut stride = 1;
    for axis in shape {
        strides.push(stride);
        stride *= axis;
    }
    let at = |mut place: usize| {
        let mut from = 0;
        for (axis, stride) in shape.iter().zip(&strides).rev() {
            from += place % axis * stride;
            place /= axis;
        }
        values[from]
    };
    (0..values.len()).map(at).collect()
}

/// The numbers of an element: MATLAB writes whole ones as short as they can be.
fn values(element: &Element<'_>, big: bool) -> Option<Vec<f64>> {
    let kind = match element.kind {
        1 => "i1",
        2 => "u1",
        3 => "i2",
        4 => "u2",
        5 => "i4",
        6 => "u4",
        7 => "f4",
        9 => "f8",
        12 => "i8",
        13 => "u8",
        _ => return None,
    };
    let (number, size) = number(kind, big)?;
    Some(element.data.chunks_exact(size).map(number).collect())
}

fn u32_of(bytes: &[u8], big: bool) -> Option<u32> {
    let bytes = bytes.try_into().ok()?;
    Some(match big {
        true => u32::from_be_bytes(bytes),
        false => u32::from_le_bytes(bytes),
    })
}
