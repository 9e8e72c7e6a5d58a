//! Several runs one below the other in one text, and the rows of the one that is asked for.
//!
//! A run begins where the header is repeated, and where the clock returns: where a time is nearer to the first time of the run
//! than to the one above it.

use super::ReadError;
use super::grid::Grid;
use super::number::any_number;
use super::rows::Rows;
use crate::layout::DeclaredColumn;
use crate::{Note, calendar, instants};
use std::borrow::Cow;
use std::ops::Range;

/// Leaves only the rows of a run, and tells which; the first one is 1. `time` is the column of its clock.
///
/// # Errors
/// If there are not so many.
pub(super) fn choose(
    grid: &mut Grid<'_>,
    run: usize,
    time: Option<usize>,
    declared: Option<&DeclaredColumn>,
) -> Result<Note, ReadError> {
    let runs = runs(grid, time, declared)?;
    let Some(own) = run.checked_sub(1).and_then(|at| runs.get(at)) else {
        return Err(ReadError::NoRun {
            asked: run,
            found: runs.len(),
        });
    };
    let note = Note::new(format!(
        "the file contains {}: run {run} is read, lines {} to {}",
        hyde_units::counted(runs.len(), "run"),
        own.lines.start,
        own.lines.end
    ));
    let bytes = own.bytes.clone();
    let above = grid.rows.as_bytes()[..bytes.start].iter();
    grid.lines_above += above.filter(|byte| **byte == b'\n').count() as u64;
    grid.rows = match std::mem::take(&mut grid.rows) {
        Cow::Borrowed(text) => Cow::Borrowed(&text[bytes]),
        Cow::Owned(text) => Cow::Owned(text[bytes].to_owned()),
    };
    Ok(note)
}

/// Rows one below the other: where they are in the text, and the lines of the first and the last.
struct Run {
    bytes: Range<usize>,
    lines: Range<u64>,
}

fn runs(
    grid: &Grid<'_>,
    time: Option<usize>,
    declared: Option<&DeclaredColumn>,
) -> Result<Vec<Run>, ReadError> {
    let mut rows = Rows::new(&grid.rows, grid.separator, grid.lines_above);
    // Where each row begins, whether it is a header, and what its clock reads.
    let (mut begins, mut headers, mut clock) = (Vec::new(), Vec::new(), Vec::new());
    while rows.advance()? && !rows.is_end_mark() {
        let header = rows.is_header(&grid.headings);
        headers.push(header);
        begins.push(rows.position());
        if let Some(cell) = time.filter(|_| !header).and_then(|at| rows.cells().nth(at)) {
            clock.push(cell.to_owned());
        }
    }
    let mut returns = returns(&clock, declared).into_iter();
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (row, _) in headers.iter().enumerate().filter(|(_, header)| !**header) {
        let returned = returns.next().unwrap_or(false);
        match runs.last_mut() {
            Some(run) if run.end == row && !returned => run.end = row + 1,
            _ => runs.push(row..row + 1),
        }
    }
    let byte = |row: usize| {
        let begin = begins
            .get(row)
            .and_then(|begin| usize::try_from(*begin).ok());
        begin.unwrap_or(grid.rows.len())
    };
    let run = |run: Range<usize>| Run {
        bytes: byte(run.start)..byte(run.end),
        lines: rows.line_at(begins[run.start])..rows.line_at(begins[run.end - 1]),
    };
    Ok(runs.into_iter().map(run).collect())
}

/// Which times are those of a clock that has returned: numbers, or dates; a counter that overflows goes on.
fn returns(clock: &[String], declared: Option<&DeclaredColumn>) -> Vec<bool> {
    let numbers: Option<Vec<f64>> = clock.iter().map(|cell| any_number(cell)).collect();
    let times = match numbers {
        Some(values) if instants::wraps(&values, declared).is_some() => return Vec::new(),
        Some(values) => values,
        None => match calendar::of_texts(&clock.iter().collect()) {
            Ok((seconds, _)) => seconds,
            Err(_) => return Vec::new(),
        },
    };
    let mut first = f64::NAN;
    let mut before = f64::NAN;
    let returned = times.into_iter().map(|now| {
        let returned = instants::is_anew(first, before, now);
        if returned || first.is_nan() {
            first = now;
        }
        before = now;
        returned
    });
    returned.collect()
}
