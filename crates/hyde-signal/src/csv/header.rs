//! The header of a CSV record: its separator, and the name and unit of each column.

use super::ReadError;
use hyde_units::NamedUnit;

/// The separator of the first line that is neither blank nor a comment: comma, semicolon or tab.
pub(super) fn separator(text: &[u8]) -> u8 {
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let header = lines
        .into_iter()
        .find(|line| !line.is_empty() && !line.starts_with(b"#"));
    let mut counts = [(b',', 0_usize), (b';', 0), (b'\t', 0)];
    let mut quoted = false;
    for &byte in header.unwrap_or_default() {
        quoted ^= byte == b'"';
        for (separator, count) in &mut counts {
            *count += usize::from(byte == *separator && !quoted);
        }
    }
    // Of equal counts the first wins: a header of one column has commas, if any.
    counts
        .into_iter()
        .rev()
        .max_by_key(|(_, count)| *count)
        .map_or(b',', |(separator, _)| separator)
}

/// Splits `x [mm]` into name and unit.
///
/// Brackets that close the cell hold a unit, except an index that stands at the name: `x[1]` is an element.
pub(crate) fn name_and_unit(
    cell: &str,
    column: usize,
) -> Result<(String, Option<NamedUnit>), ReadError> {
    let cell = cell.trim();
    let (name, unit) = match cell
        .strip_suffix(']')
        .and_then(|rest| rest.rsplit_once('['))
    {
        Some((name, inside)) if !is_index(name, inside) => (name.trim_end(), Some(inside)),
        Some(_) | None => (cell, None),
    };
    if name.is_empty() {
        return Err(ReadError::NoName { column });
    }
    let unit = unit.map(NamedUnit::parse).transpose();
    let unit = unit.map_err(|error| ReadError::Unit {
        column,
        name: name.to_owned(),
        error,
    })?;
    Ok((name.to_owned(), unit))
}

fn is_index(name: &str, inside: &str) -> bool {
    let digits = inside
        .chars()
        .all(|c| c.is_ascii_digit() || matches!(c, ',' | ' '));
    digits && inside.contains(|c: char| c.is_ascii_digit()) && !name.ends_with(char::is_whitespace)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_most_frequent_separator_outside_quotes_wins() {
        assert_eq!(separator(b"t,x;y,z\n"), b',');
        assert_eq!(separator(b"\n# a,b,c\n t;x;y\n"), b';');
        assert_eq!(separator(b"t\tx\n"), b'\t');
        assert_eq!(separator(b"\"a,b,c\";\"d,e,f\"\n"), b';');
        assert_eq!(separator(b"t"), b',');
        assert_eq!(separator(b""), b',');
    }

    #[test]
    fn units_are_in_closing_brackets_and_indices_at_the_name() {
        let split = |cell| {
            let (name, unit) = name_and_unit(cell, 1).unwrap();
            (name, unit.map(|unit| unit.text().to_owned()))
        };
        assert_eq!(split(" x [mm] "), ("x".to_owned(), Some("mm".to_owned())));
        assert_eq!(split("x[mm]"), ("x".to_owned(), Some("mm".to_owned())));
        assert_eq!(
            split("th[3] [rad]"),
            ("th[3]".to_owned(), Some("rad".to_owned()))
        );
        assert_eq!(
            split("Butterworth.x[1]"),
            ("Butterworth.x[1]".to_owned(), None)
        );
        assert_eq!(split("a[1,2]"), ("a[1,2]".to_owned(), None));
        assert_eq!(split("slip [1]"), ("slip".to_owned(), Some("1".to_owned())));
        assert_eq!(split("qg_m"), ("qg_m".to_owned(), None));
        assert_eq!(
            split("Reference Velocity"),
            ("Reference Velocity".to_owned(), None)
        );
    }
}
