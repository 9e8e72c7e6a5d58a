//! Groups of columns side by side, each with its own time column: lines above the rows name each fact once more for every
//! group, as TwinCAT's scope and measuring cards write them.
//!
//! ```text
//! Name            PosActual  VeloActual  Name            Current
//! SampleTime[ms]  1          1           SampleTime[ms]  5
//! Unit            mm         mm/s        Unit            A
//! 0               0.1        5           0               1.2
//! ```

use super::ReadError;
use super::facts::{Period, key, period_key};
use super::head::{Head, Line};
use super::number::any_number;
use super::separator::Separator;
use crate::Note;
use crate::heading::Heading;

/// Columns over one time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Group {
    /// Its first column.
    pub(super) first: usize,
    /// The column that is the time; none where rows follow each other by a period.
    pub(super) time: Option<usize>,
    /// The column behind the last one.
    pub(super) end: usize,
    /// The time between its rows, where the file says it.
    pub(super) period: Option<Period>,
}

/// What the time column of a group is called.
pub(super) const TIME: &str = "time";

const NAMES: [&str; 5] = ["name", "channelname", "channel", "signal", "signalname"];
const UNITS: [&str; 4] = ["unit", "units", "einheit", "yunitlabel"];

/// Facts whose numbers say how a channel was scaled before it was written.
const SCALES: [&str; 4] = ["scalefactor", "unitscalefactor", "offset", "unitoffset"];

/// Columns, groups and notes of a text whose head is of this kind.
pub(super) type Found = (Vec<Heading>, Vec<Group>, Vec<Note>);

/// Reads the lines above the rows; nothing if they name no groups. `headings` are those that were declared.
pub(super) fn of(head: &Head<'_>, headings: Option<&[String]>) -> Result<Option<Found>, ReadError> {
    let rows: Vec<Row> = head
        .above
        .iter()
        .filter_map(|line| Row::of(line, head.separator, head.width))
        .collect();
    let is = |row: &&Row, keys: &[&str]| keys.contains(&row.key.as_str());
    let whole = |row: &&Row| row.cells.len() == head.width;
    let periods = rows.iter().rfind(|row| period_key(&row.cells[0]).is_some());
    let units = rows.iter().rfind(|row| is(row, &UNITS));
    let names = rows.iter().rfind(|row| is(row, &NAMES));
    let Some(names) = names.filter(|_| periods.is_some() || units.is_some()) else {
        return Ok(None);
    };
    let starts = [periods, Some(names), units].into_iter().flatten();
    let Some(starts) = starts.filter(whole).map(Row::starts).next() else {
        return Ok(None);
    };
    let named = match headings {
        Some(headings) => headings.to_vec(),
        None if names.cells.len() == head.width => names.cells.clone(),
        None => {
            return Err(ReadError::Names {
                line: names.line,
                found: names.cells.len(),
                expected: head.width,
            });
        }
    };
    let last = rows.iter().rposition(|row| row.is_fact()).unwrap_or(0);
    let odd = |row: &&Row| {
        row.cells.len() == head.width && row.cells.iter().any(|cell| any_number(cell).is_some())
    };
    if let Some(row) = rows[last + 1..].iter().find(odd) {
        return Err(ReadError::OddRow { line: row.line });
    }
    let mut notes = Vec::new();
    let units = units.and_then(|row| {
        let cells = row.joined(head.width);
        if cells.is_none() {
            notes.push(Note::new(format!(
                "line {} has units for {} columns, the rows have {}: it is not read",
                row.line,
                row.cells.len(),
                head.width
            )));
        }
        cells
    });
    let mut columns: Vec<Heading> = named
        .iter()
        .enumerate()
        .map(|(at, name)| Heading::plain(if starts.contains(&at) { TIME } else { name }))
        .collect();
    if let Some(units) = units {
        columns = columns
            .into_iter()
            .zip(&units)
            .enumerate()
            .map(|(at, (heading, cell))| match starts.contains(&at) {
                true => heading,
                false => heading.with_row(cell),
            })
            .collect();
    }
    let ends = starts[1..].iter().copied().chain([head.width]);
    let groups: Vec<Group> = starts
        .iter()
        .zip(ends)
        .map(|(&first, end)| Group {
            first,
            time: Some(first),
            end,
            period: periods.and_then(|row| row.period(first)),
        })
        .collect();
    notes.push(Note::new(match groups.len() {
        1 => "lines above its rows name its columns: the first one is their time".to_owned(),
        many => format!("its columns are {many} groups, each with a time column of its own"),
    }));
    notes.extend(scaled(&rows, &columns));
    Ok(Some((columns, groups, notes)))
}

/// That channels may have been scaled by the program that wrote them: an option of its export that the file does not show.
fn scaled(rows: &[Row], columns: &[Heading]) -> Option<Note> {
    let scales =
        |row: &&Row| SCALES.contains(&row.key.as_str()) && row.cells.len() == columns.len();
    let neutral = |row: &Row| {
        if row.key.ends_with("offset") {
            0.0
        } else {
            1.0
        }
    };
    let mut names: Vec<&str> = Vec::new();
    for row in rows.iter().filter(scales) {
        let cells = row.cells.iter().zip(columns);
        let scaled = cells.filter(|(cell, _)| {
            any_number(cell).is_some_and(|value| value.total_cmp(&neutral(row)).is_ne())
        });
        for (_, heading) in scaled {
            if !names.contains(&heading.name.as_str()) {
                names.push(&heading.name);
            }
        }
    }
    let list: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    (!list.is_empty()).then(|| {
        Note::new(format!(
            "the file gives scale factors or offsets of {}, and not whether its numbers have them already: they are taken as they stand",
            list.join(", ")
        ))
    })
}

/// A line with a key and a cell a column.
struct Row {
    key: String,
    cells: Vec<String>,
    line: u64,
}

impl Row {
    fn of(line: &Line<'_>, separator: Separator, width: usize) -> Option<Self> {
        let mut cells = separator.words(line.text);
        while cells.len() > width && cells.last().is_some_and(String::is_empty) {
            cells.pop();
        }
        let key = key(cells.first()?);
        let line = line.number;
        Some(Self { key, cells, line })
    }

    /// Whether it is a fact of the columns.
    fn is_fact(&self) -> bool {
        let known = [&NAMES[..], &UNITS[..], &SCALES[..]];
        known.iter().any(|keys| keys.contains(&self.key.as_str()))
            || period_key(&self.cells[0]).is_some()
    }

    /// Where a group begins: at each cell that repeats the key.
    fn starts(&self) -> Vec<usize> {
        let own = |(at, cell): (usize, &String)| (cell == &self.cells[0]).then_some(at);
        self.cells.iter().enumerate().filter_map(own).collect()
    }

    /// The time between the rows of the group that begins there.
    fn period(&self, start: usize) -> Option<Period> {
        let value = any_number(self.cells.get(start + 1)?)?;
        (value > 0.0).then(|| Period {
            value,
            text: self.cells[start + 1].clone(),
            unit: period_key(&self.cells[0]).flatten(),
            key: self.cells[0].clone(),
            line: self.line,
        })
    }

    /// Its cells, if there are so many; blanks as separators cut `V (Voltage)` in two.
    fn joined(&self, width: usize) -> Option<Vec<String>> {
        if self.cells.len() == width {
            return Some(self.cells.clone());
        }
        let mut cells: Vec<String> = Vec::new();
        for cell in &self.cells {
            let explains = cell.starts_with('(') && !cell.eq_ignore_ascii_case("(none)");
            match cells.last_mut() {
                Some(before)
                    if explains && *before != self.cells[0] && !before.starts_with('(') =>
                {
                    before.push(' ');
                    before.push_str(cell);
                }
                _ => cells.push(cell.clone()),
            }
        }
        (cells.len() == width).then_some(cells)
    }
}
