//! Reads a CSV record into a table.

use super::ReadError;
use super::columns::Columns;
use super::grid::Grid;
use super::groups::Group;
use super::number::{any_number, decimal_sign, grouping_sign, is_number};
use super::rows::Rows;
use super::runs;
use super::text::decoded;
use crate::assemble::{Cells, Raw};
use crate::heading::{Heading, Temporal, is_time_unit, temporal};
use crate::layout::Layout;
use crate::{Fault, Note, Table, TimeError, contradicted, gaps, instants};

/// Reads a record. Columns with a unit become SI; those without keep their values, see [`Column::with_unit`](crate::Column).
///
/// The time is the column that the layout says, else the first one; in a measured response that is the frequency. Several
/// rows may have the same time. A column that cannot be read does not matter as long as nobody uses it:
/// [`Table::unusable`].
///
/// # Errors
/// The first mistake in the file, with its line.
pub fn read(bytes: &[u8], layout: &Layout) -> Result<Table, ReadError> {
    read_cells(bytes, layout, |columns| columns)
}

/// The same for the text of a sheet, whose cells are numbers with a point, or texts.
pub(crate) fn read_sheet(text: &str, layout: &Layout) -> Result<Table, ReadError> {
    read_cells(text.as_bytes(), layout, Columns::of_sheet)
}

fn read_cells(
    bytes: &[u8],
    layout: &Layout,
    kind: impl FnOnce(Columns) -> Columns,
) -> Result<Table, ReadError> {
    let (text, note) = decoded(bytes, layout.encoding.as_deref())?;
    let mut grid = Grid::of(&text, layout)?;
    let mut notes: Vec<Note> = note
        .into_iter()
        .chain(std::mem::take(&mut grid.notes))
        .collect();
    let mut layout = layout.clone();
    let declared_s = layout.every_s;
    if layout.every_s.is_none() {
        layout.every_s = said_period(&grid, &layout, &mut notes)?;
    }
    let groups = match layout.every_s {
        None if !grid.groups.is_empty() => grid.groups.clone(),
        _ => vec![whole(&grid, &layout)?],
    };
    if let Some(run) = layout.run {
        let time = groups.first().and_then(|group| group.time);
        notes.push(runs::choose(&mut grid, run, time, layout.time.as_ref())?);
    }
    let mut rows = Rows::new(&grid.rows, grid.separator, grid.lines_above);
    let expected = expected_rows(&grid.rows, grid.headings.len());
    let columns = Columns::of(&grid.headings, &groups, layout.decimal, expected);
    let mut columns = kind(columns);
    if declared_s.is_some() {
        columns.pass_over(passed_over(&grid), expected);
    }
    // Where the last row begins, and how many cells the first one has.
    let (mut before, mut width) = (None, None);
    while rows.advance()? {
        if rows.is_end_mark() {
            break;
        }
        if is_cut_off(&rows, before, grid.headings.len()) {
            notes.push(Note::new(format!(
                "the file ends within line {}: this row is ignored",
                rows.line()
            )));
            break;
        }
        let width = *width.get_or_insert(rows.count());
        check_row(&rows, &grid, width, groups.len() > 1)?;
        columns.push(&rows, &grid.headings)?;
        before = Some(rows.position());
    }
    if before.is_none() {
        return Err(ReadError::NoRows);
    }
    notes.extend(columns.notes(&grid.headings));
    let place = |row: usize| format!("line {}", line_of(&grid, row));
    let period_s = declared_s.filter(|period| *period > 0.0);
    notes.extend(period_s.and_then(|period_s| columns.contradicted(&grid, period_s, &place)));
    columns.tables(&grid, &groups, &layout, notes, &place)
}

/// The line of a row, from 0: the rows are counted once more, which one message asks for.
fn line_of(grid: &Grid<'_>, row: usize) -> u64 {
    let mut rows = Rows::new(&grid.rows, grid.separator, grid.lines_above);
    for _ in 0..=row {
        if !rows.advance().unwrap_or(false) {
            break;
        }
    }
    rows.line()
}

/// About how many rows a text has, by the length of its first ones: a cell has a character and its separator at least.
fn expected_rows(text: &str, columns: usize) -> usize {
    let first: Vec<&str> = text.lines().take(16).collect();
    let length = first.iter().map(|line| line.len() + 1).sum::<usize>();
    let length = length.max(2 * columns * first.len()).max(1);
    text.len() * first.len() / length + first.len()
}

/// The group of all columns; a column that is named as the time must be there.
fn whole(grid: &Grid<'_>, layout: &Layout) -> Result<Group, ReadError> {
    let time = match layout.every_s {
        Some(_) => None,
        None => {
            let named: Vec<Raw> = grid.headings.iter().cloned().map(without_cells).collect();
            Some(instants::place(&named, layout.time.as_ref())?)
        }
    };
    Ok(Group {
        first: 0,
        time,
        end: grid.headings.len(),
        period: grid.period.clone(),
    })
}

/// The time between rows, if a line above them says it and no column is the time.
fn said_period(
    grid: &Grid<'_>,
    layout: &Layout,
    notes: &mut Vec<Note>,
) -> Result<Option<f64>, TimeError> {
    let said = grid.period.as_ref();
    let Some((said, unit)) = said.and_then(|said| Some((said, said.unit.as_ref()?))) else {
        return Ok(None);
    };
    let timed = |heading: &Heading| {
        heading.known_unit().is_some_and(is_time_unit)
            || (heading.unit.is_none() && !matches!(temporal(&heading.name), Temporal::No))
    };
    let none = layout.time.is_none() && grid.groups.is_empty();
    let first = first_cells(grid);
    if !none || grid.headings.iter().any(timed) || advances_by(&first, said.value) {
        return Ok(None);
    }
    let of_rows = first.iter().flatten().find_map(|cell| decimal_sign(cell));
    if let (Some(own), Some(of_rows)) = (grouping_sign(&said.text), layout.decimal.or(of_rows))
        && own != of_rows
    {
        return Err(TimeError::Doubtful(Fault {
            message: format!(
                "line {}: `{}` is `{}`, and the rows have `{of_rows}` before their decimals: is it {} or {}?",
                said.line,
                said.key,
                said.text,
                said.value,
                1000.0 * said.value
            ),
            repair: "say the time between rows in the experiment: `every 1 [ms]`".to_owned(),
        }));
    }
    let period_s = unit.unit().to_si(said.value);
    notes.push(Note::new(format!(
        "no column is the time: its rows are {} apart, as `{}` in line {} says",
        gaps::seconds(period_s),
        said.key,
        said.line
    )));
    Ok(Some(period_s))
}

/// The cells of the first two rows.
fn first_cells(grid: &Grid<'_>) -> Vec<Vec<String>> {
    let mut rows = Rows::new(&grid.rows, grid.separator, grid.lines_above);
    let mut next = || {
        let more = rows.advance().unwrap_or(false);
        more.then(|| rows.cells().map(str::to_owned).collect())
    };
    next().into_iter().chain(next()).collect()
}

/// The column that would be the time if no period were declared.
fn passed_over(grid: &Grid<'_>) -> Option<usize> {
    let mut cells = first_cells(grid).into_iter().next()?.into_iter();
    let named = grid.headings.iter().cloned().map(|heading| Raw {
        heading,
        cells: Cells::Texts(cells.next().into_iter().collect()),
    });
    contradicted::passed_over(named.collect::<Vec<Raw>>().iter())
}

/// Whether the first column goes from row to row by so much: then it is the time, whatever it is called.
fn advances_by(rows: &[Vec<String>], step: f64) -> bool {
    let first = |row: &Vec<String>| row.first().and_then(|cell| any_number(cell));
    match rows {
        [a, b] => first(a)
            .zip(first(b))
            .is_some_and(|(a, b)| (b - a - step).abs() <= 0.02 * step),
        _ => false,
    }
}

/// Whether the file ends within the row: it has too few cells, or a last one that is not written to its end.
fn is_cut_off(rows: &Rows<'_>, before: Option<u64>, columns: usize) -> bool {
    if !rows.is_cut_off() {
        return false;
    }
    let Some(before) = before else {
        return true;
    };
    let (Some(last), Some(above)) = (rows.cells().last(), rows.last_cell_at(before)) else {
        return true;
    };
    let decimals = |cell: &str| cell.split_once(['.', ',']).map(|(_, places)| places.len());
    let shorter = match (decimals(last), decimals(&above)) {
        (Some(last), Some(above)) => last != above,
        (None, None) => last.len() < above.len(),
        _ => true,
    };
    rows.count() < columns || (shorter && is_number(last))
}

/// A row has a cell a column, and an empty one behind them if the first one, with `width` cells, has: a row that lost a cell
/// would have one less. Behind them may be a column for remarks.
fn check_row(
    rows: &Rows<'_>,
    grid: &Grid<'_>,
    width: usize,
    may_end: bool,
) -> Result<(), ReadError> {
    let headings = &grid.headings;
    let (found, expected) = (rows.count(), headings.len());
    let beyond = rows.cells().skip(expected).any(|cell| !cell.is_empty());
    let ends_otherwise = (found > expected) != (width > expected) && !grid.remarks;
    if ((found < expected || ends_otherwise) && !may_end) || beyond {
        let line = rows.line();
        return Err(ReadError::Ragged {
            line,
            found,
            expected,
        });
    }
    if rows.is_header(headings) {
        return Err(ReadError::HeaderAgain { line: rows.line() });
    }
    Ok(())
}

fn without_cells(heading: Heading) -> Raw {
    let cells = Cells::Integers(Vec::new());
    Raw { heading, cells }
}

#[cfg(test)]
mod device_tests;
#[cfg(test)]
mod tests;
