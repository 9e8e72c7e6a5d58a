//! Workbooks of a spreadsheet: a sheet becomes the text that it would be as a file of tabs.

use crate::{Layout, Note, Table, csv};
use calamine::{Data, ExcelDateTime, Range, Reader as _};
use std::fmt::Write as _;
use std::io::Cursor;

/// Whether a file may be a workbook, by its first bytes.
pub(crate) fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\xd0\xcf\x11\xe0")
}

/// Why a workbook is no record.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is not one.
    Workbook(String),
    /// It has no such sheet; those that it has.
    NoSheet(String, Vec<String>),
    /// Several sheets have cells, and nothing says which one is meant.
    Which(Vec<String>),
    /// No sheet has cells.
    Empty,
    /// The sheet is no record.
    Sheet(csv::ReadError),
}

/// Reads the sheet that the layout says, else the only one with cells.
pub(crate) fn read(bytes: &[u8], layout: &Layout) -> Result<Table, ReadError> {
    let (name, text) = sheet(bytes, layout)?;
    let layout = Layout {
        separator: Some('\t'),
        decimal: Some('.'),
        ..layout.clone()
    };
    let mut table = csv::read_sheet(&text, &layout).map_err(ReadError::Sheet)?;
    table.tell(Note::new(format!(
        "read from the sheet `{name}` of a workbook"
    )));
    Ok(table)
}

/// The name of a sheet, and its cells as text.
fn sheet(bytes: &[u8], layout: &Layout) -> Result<(String, String), ReadError> {
    let asked = layout.sheet.as_deref();
    let wrong = |error: calamine::Error| ReadError::Workbook(error.to_string());
    let mut book = calamine::open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(wrong)?;
    let names = book.sheet_names();
    if let Some(asked) = asked
        && !names.iter().any(|name| name == asked)
    {
        return Err(ReadError::NoSheet(asked.to_owned(), names));
    }
    let mut found = Vec::new();
    for name in names
        .iter()
        .filter(|name| asked.is_none_or(|asked| asked == *name))
    {
        let range = book.worksheet_range(name).map_err(wrong)?;
        if range.height() > 1 {
            found.push((name.clone(), range));
        }
    }
    match found.len() {
        0 => Err(ReadError::Empty),
        1 => {
            let (name, range) = found.remove(0);
            Ok((name, text(&range, layout.decimal)))
        }
        _ => Err(ReadError::Which(
            found.into_iter().map(|(name, _)| name).collect(),
        )),
    }
}

/// The cells as text; texts that are numbers with the declared decimal sign become such.
fn text(range: &Range<Data>, decimal: Option<char>) -> String {
    let mut out = String::new();
    // Lines are those of the sheet: rows above the first cell are blank ones.
    let above = range.start().map_or(0, |(row, _)| row);
    out.extend((0..above).map(|_| '\n'));
    for row in range.rows() {
        for (number, cell) in row.iter().enumerate() {
            if number > 0 {
                out.push('\t');
            }
            push(&mut out, cell, decimal);
        }
        out.push('\n');
    }
    out
}

fn push(out: &mut String, cell: &Data, decimal: Option<char>) {
    // Writing to a string cannot fail.
    let _ = match cell {
        Data::Int(value) => write!(out, "{value}"),
        Data::Float(value) => write!(out, "{value:?}"),
        Data::Bool(true) => write!(out, "TRUE"),
        Data::Bool(false) => write!(out, "FALSE"),
        Data::DateTime(at) => write!(out, "{}", stamp(at)),
        Data::DateTimeIso(text) | Data::DurationIso(text) | Data::String(text) => {
            let plain = text.replace(['\t', '\n', '\r', '"'], " ");
            let plain = plain.trim();
            match decimal.and_then(|decimal| csv::number_with(decimal, plain)) {
                Some(number) => write!(out, "{number:?}"),
                None => write!(out, "{plain}"),
            }
        }
        Data::Error(error) => write!(out, "{error}"),
        Data::Empty => Ok(()),
    };
}

/// A date with its time of day; a time of day alone where there is no date.
fn stamp(at: &ExcelDateTime) -> String {
    let (year, month, day, hour, minute, second, milli) = at.to_ymd_hms_milli();
    let time = format!("{hour:02}:{minute:02}:{second:02}.{milli:03}");
    match at.as_f64() < 1.0 || at.is_duration() {
        true => time,
        false => format!("{year:04}-{month:02}-{day:02} {time}"),
    }
}

impl ReadError {
    /// What to change, in the file or in the experiment that calls it `record`.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Sheet(error) => error.repair(record),
            Self::NoSheet(_, names) | Self::Which(names) => {
                let list: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                format!(
                    "say which sheet, `record {record}(sheet = {:?})`; it has {}",
                    names.first().map_or("NAME", String::as_str),
                    list.join(", ")
                )
            }
            Self::Workbook(_) | Self::Empty => "save the sheet as CSV".to_owned(),
        }
    }
}

impl std::fmt::Display for ReadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Workbook(error) => write!(
                f,
                "this is an Excel workbook or another zip archive that cannot be read: {error}"
            ),
            Self::NoSheet(name, _) => write!(f, "the workbook has no sheet `{name}`"),
            Self::Which(names) => write!(f, "{} sheets of the workbook have cells", names.len()),
            Self::Empty => write!(f, "no sheet of the workbook has rows"),
            Self::Sheet(error) => error.fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_numbers_have_the_declared_decimal_sign() {
        let written = |cell: &Data, decimal| {
            let mut out = String::new();
            push(&mut out, cell, decimal);
            out
        };
        let text = |text: &str| Data::String(text.to_owned());
        assert_eq!(written(&text("0,5"), Some(',')), "0.5");
        assert_eq!(written(&text("1.234,5"), Some(',')), "1234.5");
        assert_eq!(written(&text("0,5"), None), "0,5");
        assert_eq!(written(&text("x [mm]"), Some(',')), "x [mm]");
        assert_eq!(written(&Data::Float(0.5), Some(',')), "0.5");
        // Without a declaration `1,234` may be one and a part.
        let layout = Layout {
            separator: Some('\t'),
            decimal: Some('.'),
            ..Layout::default()
        };
        let table = csv::read_sheet("t [s]\tx\ty\n0\t1,234\t1\n1\t1,235\t1\n", &layout).unwrap();
        assert_eq!(table.unusable()[0].name, "x");
        let error = csv::read_sheet("t [s]\tx\n0,0\t1\n0,5\t1\n", &layout).unwrap_err();
        assert!(
            error
                .repair("log")
                .contains("`record log(decimal = \",\")`")
        );
    }
}
