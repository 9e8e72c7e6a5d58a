//! Reads a CSV record into a table.

use super::ReadError;
use super::grid::Grid;
use super::number::{Numbers, not_a_number, truth};
use super::rows::Rows;
use super::text::decoded;
use crate::assemble::{AssembleError, Cells, Raw, assemble};
use crate::heading::Heading;
use crate::instants;
use crate::layout::Layout;
use crate::{Fault, Note, Table};

/// Reads a record. Columns with a unit become SI; those without keep their values, see [`Column::with_unit`](crate::Column).
///
/// The time is the column that the layout says, else the first one; in a measured response that is the frequency. Several
/// rows may have the same time. A column that cannot be read does not matter as long as nobody uses it:
/// [`Table::unusable`].
///
/// # Errors
/// The first mistake in the file, with its line.
pub fn read(bytes: &[u8], layout: &Layout) -> Result<Table, ReadError> {
    let (text, note) = decoded(bytes).map_err(ReadError::Foreign)?;
    let grid = Grid::of(&text)?;
    let mut notes: Vec<Note> = note.into_iter().chain(grid.notes).collect();
    let mut rows = Rows::new(&grid.rows, grid.separator, grid.lines_above);
    let headings = grid.headings;
    let time = match layout.every_s {
        Some(_) => None,
        None => {
            let named: Vec<Raw> = headings.iter().cloned().map(without_cells).collect();
            Some(instants::place(&named, layout.time.as_ref())?)
        }
    };
    let mut columns = Columns {
        of: headings.iter().map(|_| Vec::new()).collect(),
        faults: vec![None; headings.len()],
        truths: vec![false; headings.len()],
        numbers: Numbers::default(),
        time,
        instants: Vec::new(),
    };
    let mut positions = Vec::new();
    while rows.advance()? {
        let (found, expected) = (rows.count(), headings.len());
        if found < expected && rows.is_cut_off() && !positions.is_empty() {
            notes.push(Note::new(format!(
                "the file ends within line {}: this row is ignored",
                rows.line()
            )));
            break;
        }
        let beyond = rows.cells().skip(expected).any(|cell| !cell.is_empty());
        if found < expected || beyond {
            let line = rows.line();
            return Err(ReadError::Ragged {
                line,
                found,
                expected,
            });
        }
        let again = |(cell, heading): (&str, &Heading)| cell == heading.written;
        if rows.cells().zip(&headings).all(again) {
            return Err(ReadError::HeaderAgain { line: rows.line() });
        }
        columns.push(&rows, &headings);
        positions.push(rows.position());
    }
    if positions.is_empty() {
        return Err(ReadError::NoRows);
    }
    notes.extend(columns.notes(&headings));
    let place = |row: usize| format!("line {}", rows.line_at(positions[row]));
    let raw = columns.raw(headings);
    assemble(raw, layout, notes, &place).map_err(|error| match error {
        AssembleError::Time(error) => ReadError::Time(error),
        AssembleError::Table(error) => ReadError::Table(error),
    })
}

fn without_cells(heading: Heading) -> Raw {
    let cells = Cells::Integers(Vec::new());
    Raw { heading, cells }
}

/// The cells below the header.
struct Columns {
    of: Vec<Vec<f64>>,
    faults: Vec<Option<Fault>>,
    /// Whether a column has `TRUE` or `FALSE`.
    truths: Vec<bool>,
    numbers: Numbers,
    /// Which of them is the time, with its cells.
    time: Option<usize>,
    instants: Vec<String>,
}

impl Columns {
    fn push(&mut self, rows: &Rows<'_>, headings: &[Heading]) {
        for (at, cell) in rows.cells().take(headings.len()).enumerate() {
            if self.time == Some(at) {
                // Dates have commas of their own; numbers have points from here on.
                let number = self.numbers.read(cell).is_some();
                let cell = if number {
                    cell.replace(',', ".")
                } else {
                    cell.to_owned()
                };
                self.instants.push(cell);
                continue;
            }
            let truth = || truth(cell).inspect(|_| self.truths[at] = true);
            let value = self.numbers.read(cell).or_else(truth);
            if value.is_none() && self.faults[at].is_none() {
                let fault = not_a_number(rows.line(), at + 1, &headings[at].name, cell);
                self.faults[at] = Some(fault);
            }
            self.of[at].push(value.unwrap_or(f64::NAN));
        }
    }

    fn notes(&self, headings: &[Heading]) -> Vec<Note> {
        let mut notes = Vec::new();
        if self.numbers.has_comma() {
            notes.push(Note::new(
                "its numbers have a decimal comma: `0,5` is read as 0.5",
            ));
        }
        let columns = headings.iter().zip(&self.truths).zip(&self.faults);
        let truths = columns.filter(|((_, truth), fault)| **truth && fault.is_none());
        let names: Vec<String> = truths.map(|((h, _), _)| format!("`{}`", h.name)).collect();
        if !names.is_empty() {
            notes.push(Note::new(format!(
                "TRUE and FALSE are read as 1 and 0 in {}",
                names.join(", ")
            )));
        }
        notes
    }

    fn raw(self, headings: Vec<Heading>) -> Vec<Raw> {
        let Self {
            of,
            faults,
            time,
            mut instants,
            ..
        } = self;
        let columns = headings.into_iter().zip(of).zip(faults).enumerate();
        columns
            .map(|(at, ((heading, values), fault))| {
                let cells = match time == Some(at) {
                    true => Cells::Texts(std::mem::take(&mut instants)),
                    false => Cells::Numbers(values, fault),
                };
                Raw { heading, cells }
            })
            .collect()
    }
}

#[cfg(test)]
mod tests;
