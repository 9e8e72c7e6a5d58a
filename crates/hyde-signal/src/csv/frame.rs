//! Reads a CSV table that need not be over time: event logs, responses, cases.

use super::ReadError;
use super::grid::Grid;
use super::rows::Rows;
use super::text::decoded;
use crate::{Field, Frame, Kind, Values};

/// Reads a table. A column is of numbers, in the unit of its header, if every cell of it is one or empty; else of texts.
///
/// An empty cell among numbers is NaN. A header without rows is a table as well.
///
/// # Errors
/// The first mistake in the file, with its line and column.
pub fn read_frame(bytes: &[u8]) -> Result<Frame, ReadError> {
    let (text, _) = decoded(bytes, None)?;
    let grid = Grid::of_frame(&text)?;
    let mut rows = Rows::new(&grid.rows, grid.separator, grid.lines_above);
    let header = grid.headings;
    let mut cells: Vec<Vec<String>> = vec![Vec::new(); header.len()];
    while rows.advance()? {
        let (found, expected) = (rows.count(), header.len());
        if found != expected {
            return Err(ReadError::Ragged {
                line: rows.line(),
                found,
                expected,
            });
        }
        for (cell, column) in rows.cells().zip(&mut cells) {
            column.push(cell.to_owned());
        }
    }
    let (mut fields, mut values) = (Vec::new(), Vec::new());
    for (heading, cells) in header.into_iter().zip(cells) {
        let (name, unit) = heading.named();
        match numbers(&cells) {
            Some(numbers) => {
                fields.push(Field::number(name, unit));
                values.push(Values::Numbers(numbers));
            }
            None => {
                fields.push(Field::plain(name, Kind::Text));
                values.push(Values::Texts(cells));
            }
        }
    }
    Ok(Frame {
        fields,
        values,
        metadata: Vec::new(),
    })
}

/// The numbers of a column, if it has no text.
fn numbers(cells: &[String]) -> Option<Vec<f64>> {
    let number = |cell: &String| match cell.as_str() {
        "" => Some(f64::NAN),
        cell => cell.parse().ok(),
    };
    if !cells.is_empty() && cells.iter().all(String::is_empty) {
        return None;
    }
    cells.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_units_and_gaps_and_the_rest_is_text() {
        let text = b"case,gap [um],cause,note\n1,20,\"s > 0, or\",\n2,,ok,\n";
        let frame = read_frame(text).unwrap();
        assert_eq!(frame.numbers("case").unwrap(), [1.0, 2.0]);
        let gap = frame.numbers("gap").unwrap();
        assert!((gap[0] - 20.0).abs() < f64::EPSILON && gap[1].is_nan());
        let (field, _) = frame.column("gap").unwrap();
        assert_eq!(field.unit.as_ref().unwrap().text(), "um");
        assert_eq!(frame.texts("cause").unwrap(), ["s > 0, or", "ok"]);
        assert_eq!(frame.texts("note").unwrap(), ["", ""]);
    }

    /// Counting the lines above each row took minutes for the results of a run.
    #[test]
    fn a_long_table_is_read_in_time_that_grows_with_its_rows() {
        let rows: String = (0..200_000).map(|row| format!("{row},1,2\n")).collect();
        let frame = read_frame(format!("t [s],x,y\n{rows}").as_bytes()).unwrap();
        assert_eq!(frame.rows(), 200_000);
    }

    #[test]
    fn rows_may_be_absent_but_not_ragged() {
        assert_eq!(read_frame(b"t [s],what\n").unwrap().rows(), 0);
        let error = read_frame(b"t,what\n1\n").unwrap_err().to_string();
        assert!(error.contains("line 2"), "{error}");
    }
}
