//! Arrays of NumPy: `.npy`, one array, and `.npz`, a zip archive of them.
//!
//! Layout: NumPy Enhancement Proposal 1, *A Simple File Format for NumPy Arrays*.

use super::number::{Number, number};
use super::{Array, Content, ReadError, places};
use crate::unpack::unpacked;
use std::borrow::Cow;
use std::io::Cursor;
use zip::ZipArchive;
use zip::result::ZipError;

const MARK: &[u8] = b"\x93NUMPY";

/// Whether a file is an array.
pub(super) fn is_array(bytes: &[u8]) -> bool {
    bytes.starts_with(MARK)
}

/// Whether a file is an archive of arrays alone.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    let archive = bytes
        .starts_with(b"PK")
        .then(|| ZipArchive::new(Cursor::new(bytes)));
    archive.is_some_and(|archive| {
        archive.is_ok_and(|archive| {
            let mut names = archive.file_names();
            let of_array =
                |name: Result<Cow<'_, str>, _>| name.is_ok_and(|it| it.ends_with(".npy"));
            !archive.is_empty() && names.all(of_array)
        })
    })
}

/// Reads either. The array of an `.npy` has no name and is called `data`.
pub(super) fn read(bytes: &[u8]) -> Result<Content, ReadError> {
    let mut content = Content::default();
    let mut add = |name: &str, bytes: &[u8]| match array(name, bytes)? {
        Some(array) => {
            content.arrays.push(array);
            Ok(())
        }
        None => {
            content.others.push(name.to_owned());
            Ok(())
        }
    };
    if is_array(bytes) {
        add("data", bytes)?;
        return Ok(content);
    }
    let damaged = |error: ZipError| ReadError::Damaged(error.to_string());
    let mut archive = ZipArchive::new(Cursor::new(bytes)).map_err(damaged)?;
    for number in 0..archive.len() {
        let file = archive.by_index(number).map_err(damaged)?;
        let name = file.name().map_err(damaged)?.into_owned();
        let array =
            unpacked(file).map_err(|reason| ReadError::Damaged(format!("`{name}`: {reason}")))?;
        add(name.trim_end_matches(".npy"), &array)?;
    }
    Ok(content)
}

/// The array; none if it is not one of real numbers.
fn array(name: &str, bytes: &[u8]) -> Result<Option<Array>, ReadError> {
    let wrong = |reason: &str| ReadError::Damaged(format!("array `{name}`: {reason}"));
    let (header, data) = parts(bytes).ok_or_else(|| wrong("its header is cut off"))?;
    let shape = shape(&header).ok_or_else(|| wrong("its header names no shape"))?;
    let Some((kind, size)) = kind(&header) else {
        return Ok(None);
    };
    let bytes = places(&shape).and_then(|places| places.checked_mul(size));
    if bytes != Some(data.len()) {
        return Err(wrong("it has fewer or more numbers than its header says"));
    }
    let mut values: Vec<f64> = data.chunks_exact(size).map(kind).collect();
    let fortran = value(&header, "fortran_order").is_some_and(|text| text.starts_with("True"));
    if fortran {
        values = super::mat::last_axis_fastest(&values, &shape);
    }
    Ok(Some(Array {
        name: name.to_owned(),
        shape,
        values,
    }))
}

/// The header, a dictionary as text, and the numbers.
fn parts(bytes: &[u8]) -> Option<(String, &[u8])> {
    let version = *bytes.get(MARK.len())?;
    let (length, begin) = match version {
        1 => (
            usize::from(u16::from_le_bytes(bytes.get(8..10)?.try_into().ok()?)),
            10,
        ),
        _ => {
            let length = u32::from_le_bytes(bytes.get(8..12)?.try_into().ok()?);
            (usize::try_from(length).ok()?, 12)
        }
    };
    let end = length.checked_add(begin)?;
    let header = String::from_utf8_lossy(bytes.get(begin..end)?).into_owned();
    Some((header, &bytes[end..]))
}

/// What stands behind a key of the header.
fn value<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let (_, rest) = header.split_once(&format!("'{key}':"))?;
    Some(rest.trim_start())
}

fn shape(header: &str) -> Option<Vec<usize>> {
    let (_, rest) = value(header, "shape")?.split_once('(')?;
    let (inside, _) = rest.split_once(')')?;
    let axes = inside
        .split(',')
        .map(str::trim)
        .filter(|axis| !axis.is_empty());
    axes.map(|axis| axis.parse().ok()).collect()
}

/// How a number is read, and how many bytes it has.
fn kind(header: &str) -> Option<(Number, usize)> {
    let text = value(header, "descr")?.strip_prefix('\'')?;
    let (text, _) = text.split_once('\'')?;
    let big = text.starts_with('>');
    number(text.trim_start_matches(['<', '>', '|', '=']), big)
}
