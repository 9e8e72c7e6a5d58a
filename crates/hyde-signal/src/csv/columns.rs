//! The cells of a CSV record by columns, and the tables that they make.

use super::ReadError;
use super::facts::Period;
use super::grid::Grid;
use super::groups::Group;
use super::number::{Numbers, Thousands, any_number, is_missing, is_number, not_a_number, truth};
use super::rows::Rows;
use crate::assemble::{AssembleError, Cells, Raw, assemble};
use crate::heading::{Heading, Place};
use crate::layout::{DeclaredColumn, Layout};
use crate::statistics::median;
use crate::texts::Texts;
use crate::{Fault, Note, Table, TimeError, contradicted, declared};

/// The lines of so many missing readings are told.
const MISSING_TOLD: usize = 6;

/// The cells below the header.
pub(super) struct Columns {
    of: Vec<Column>,
    groups: Vec<OfGroup>,
    numbers: Numbers,
    thousands_declared: bool,
    /// The column that would be the time if no period were declared, and its cells.
    passed_over: Option<(usize, Texts)>,
}

#[derive(Default)]
struct Column {
    values: Vec<f64>,
    fault: Option<Fault>,
    /// How many readings are missing, and the lines of the first of them.
    missing: usize,
    lines: Vec<u64>,
    /// Whether something else than that is wrong with a cell.
    spoilt: bool,
    /// Whether it has `TRUE` or `FALSE`.
    truth: bool,
    thousands: Thousands,
}

/// The time of a group, and whether its rows ended above those of others.
struct OfGroup {
    group: Group,
    instants: Texts,
    ended: bool,
}

impl Columns {
    /// Without cells, with room for about so many rows: what is not used of it is never touched.
    pub(super) fn of(
        headings: &[Heading],
        groups: &[Group],
        decimal: Option<char>,
        rows: usize,
    ) -> Self {
        let column = |_: &Heading| Column {
            values: Vec::with_capacity(rows),
            ..Column::default()
        };
        Self {
            of: headings.iter().map(column).collect(),
            groups: groups
                .iter()
                .map(|group| OfGroup {
                    group: group.clone(),
                    instants: Texts::with_room(rows),
                    ended: false,
                })
                .collect(),
            numbers: Numbers::of(decimal),
            thousands_declared: decimal.is_some(),
            passed_over: None,
        }
    }

    /// The same for a sheet, whose cells are numbers or texts.
    pub(super) fn of_sheet(self) -> Self {
        Self {
            numbers: self.numbers.exact(),
            ..self
        }
    }

    /// Keeps the cells of a column as they are written, though it is not the time.
    pub(super) fn pass_over(&mut self, column: Option<usize>, rows: usize) {
        self.passed_over = column.map(|at| (at, Texts::with_room(rows)));
    }

    /// What the time that a declared period passes over says otherwise.
    pub(super) fn contradicted(
        &mut self,
        grid: &Grid<'_>,
        period_s: f64,
        place: &dyn Fn(usize) -> String,
    ) -> Option<Note> {
        let (at, texts) = self.passed_over.take()?;
        let time = Raw {
            heading: grid.headings[at].clone(),
            cells: Cells::Texts(texts),
        };
        contradicted::told(&time, period_s, place)
    }

    /// Takes the cells of a row. A group may end before others: then all its cells are empty.
    pub(super) fn push(&mut self, rows: &Rows<'_>, headings: &[Heading]) -> Result<(), ReadError> {
        let count = rows.count().min(headings.len());
        let many = self.groups.len() > 1;
        if let Some((at, texts)) = &mut self.passed_over {
            let cell = rows.cell(*at);
            match is_number(cell) {
                true => texts.push(&self.numbers.plain(cell)),
                false => texts.push(cell),
            }
        }
        for group in &mut self.groups {
            let own = group.group.first..group.group.end.min(count);
            if many && own.clone().all(|at| rows.cell(at).is_empty()) {
                group.ended = true;
                continue;
            }
            if group.ended || (many && own.end < group.group.end) {
                return Err(ReadError::Ragged {
                    line: rows.line(),
                    found: count,
                    expected: headings.len(),
                });
            }
            for at in own {
                let cell = rows.cell(at);
                if group.group.time == Some(at) {
                    // Dates have commas of their own; numbers have points from here on.
                    let number = self.numbers.read(cell).is_some();
                    self.of[at].thousands.see(cell);
                    match number {
                        true => group.instants.push(&self.numbers.plain(cell)),
                        false => group.instants.push(cell),
                    }
                    continue;
                }
                let column = &mut self.of[at];
                let value = match self.numbers.read(cell) {
                    Some(value) => {
                        column.thousands.see(cell);
                        Some(value)
                    }
                    None => truth(cell).inspect(|_| column.truth = true),
                };
                if value.is_none() && is_missing(cell) {
                    column.missing += 1;
                    if column.lines.len() < MISSING_TOLD {
                        column.lines.push(rows.line());
                    }
                } else {
                    column.spoilt |= value.is_none();
                }
                if value.is_none() && column.fault.is_none() {
                    let fault = not_a_number(rows.line(), at + 1, &headings[at].name, cell);
                    column.fault = Some(fault);
                }
                column.values.push(value.unwrap_or(f64::NAN));
            }
        }
        Ok(())
    }

    /// What was taken for granted of the cells.
    pub(super) fn notes(&self, headings: &[Heading]) -> Vec<Note> {
        let mut notes = Vec::new();
        if self.numbers.has_comma() {
            notes.push(Note::new(
                "its numbers have a decimal comma: `0,5` is read as 0.5",
            ));
        }
        if let Some((cell, value)) = self.numbers.grouped() {
            notes.push(Note::new(format!(
                "signs stand between the thousands of its numbers: `{cell}` is read as {value}"
            )));
        }
        notes.extend(spelled(headings));
        let columns = headings.iter().zip(&self.of);
        let truths = columns.filter(|(_, column)| column.truth && column.fault.is_none());
        let names: Vec<String> = truths.map(|(h, _)| format!("`{}`", h.name)).collect();
        if !names.is_empty() {
            notes.push(Note::new(format!(
                "TRUE and FALSE are read as 1 and 0 in {}",
                names.join(", ")
            )));
        }
        notes
    }

    /// The record: a table a group, those over equal times as one, the one with the most rows in front.
    pub(super) fn tables(
        self,
        grid: &Grid<'_>,
        groups: &[Group],
        layout: &Layout,
        mut notes: Vec<Note>,
        place: &dyn Fn(usize) -> String,
    ) -> Result<Table, ReadError> {
        let (declared, both) = (self.thousands_declared, self.numbers.has_both());
        let mut raw: Vec<Option<Raw>> = self
            .of
            .into_iter()
            .zip(&grid.headings)
            .enumerate()
            .map(|(at, (column, heading))| Some(column.raw(at, heading.clone(), declared, both)))
            .collect();
        let mut instants: Vec<Texts> = self
            .groups
            .into_iter()
            .map(|group| group.instants)
            .collect();
        declared::check(raw.iter().flatten(), &layout.columns)?;
        let mut tables = Vec::new();
        let mut joined = vec![false; groups.len()];
        for (at, group) in groups.iter().enumerate() {
            let timed = group.time.is_some();
            if joined[at] || (timed && instants[at].is_empty()) {
                continue;
            }
            // Groups whose instants are written alike have one time.
            let also: Vec<usize> = (at + 1..groups.len())
                .filter(|&other| timed && !joined[other] && instants[other] == instants[at])
                .collect();
            also.iter().for_each(|&other| joined[other] = true);
            let mut columns: Vec<Raw> = taken(&mut raw, group).collect();
            if let Some(time) = group.time.map(|time| &mut columns[time - group.first]) {
                if let Cells::Numbers(_, Some(fault)) | Cells::Sparse(_, fault) = &time.cells {
                    return Err(TimeError::Doubtful(fault.clone()).into());
                }
                time.cells = Cells::Texts(std::mem::take(&mut instants[at]));
                said_unit(
                    time,
                    group.period.as_ref(),
                    layout.time.as_ref(),
                    &mut notes,
                )?;
            }
            for other in also {
                columns.extend(taken(&mut raw, &groups[other]).skip(1));
            }
            let mut own = layout.clone();
            if let Some(time) = own.time.as_mut().filter(|_| groups.len() > 1) {
                super::groups::TIME.clone_into(&mut time.name);
            }
            let table = assemble(columns, &own, Vec::new(), place);
            tables.push(table.map_err(|error| match error {
                AssembleError::Time(error) => ReadError::Time(error),
                AssembleError::Table(error) => ReadError::Table(error),
            })?);
        }
        let table = Table::of_parts(tables, notes).ok_or(ReadError::NoRows)?;
        Ok(table.laid_out(grid.kind))
    }
}

/// The columns of a group; the first of several groups is their time.
fn taken<'r>(raw: &'r mut [Option<Raw>], group: &Group) -> impl Iterator<Item = Raw> + use<'r> {
    raw[group.first..group.end]
        .iter_mut()
        .filter_map(Option::take)
}

impl Column {
    fn raw(self, at: usize, heading: Heading, declared: bool, both_signs: bool) -> Raw {
        let thousands = self.thousands.fault(at + 1, &heading.name, both_signs);
        let thousands = thousands.filter(|_| !declared);
        let doubtful = thousands.is_some();
        let fault = self
            .fault
            .map(|fault| with_missing(fault, self.missing, &self.lines))
            .or(thousands);
        let cells = match fault {
            Some(missing) if !self.spoilt && self.missing > 0 && !doubtful => {
                Cells::Sparse(self.values, missing)
            }
            fault => Cells::Numbers(self.values, fault),
        };
        Raw { heading, cells }
    }
}

/// The units that the file spells otherwise than a model does.
fn spelled(headings: &[Heading]) -> Option<Note> {
    let mut told: Vec<String> = Vec::new();
    for heading in headings {
        if let (Some(spelled), Some(unit)) = (&heading.spelled, heading.known_unit()) {
            let text = format!("`{spelled}` is {unit}");
            if !told.contains(&text) {
                told.push(text);
            }
        }
    }
    (!told.is_empty()).then(|| Note::new(format!("of its units, {}", told.join(", "))))
}

/// The same fault with the lines of further readings that are missing.
fn with_missing(mut fault: Fault, missing: usize, lines: &[u64]) -> Fault {
    if missing > 1 {
        let list: Vec<String> = lines[1..].iter().map(u64::to_string).collect();
        let more = if missing > lines.len() { ", …" } else { "" };
        let readings = hyde_units::counted(missing - 1, "more reading");
        let is = if missing == 2 { "is" } else { "are" };
        fault.message.push_str(&format!(
            "; {readings} {is} missing, in line {}{more}",
            list.join(", ")
        ));
    }
    fault
}

/// Gives a time column the unit in which a line above it says the time between rows, if the column advances by so much.
fn said_unit(
    time: &mut Raw,
    period: Option<&Period>,
    declared: Option<&DeclaredColumn>,
    notes: &mut Vec<Note>,
) -> Result<(), TimeError> {
    let (Some(period), Cells::Texts(cells)) = (period, &time.cells) else {
        return Ok(());
    };
    let Some(unit) = &period.unit else {
        return Ok(());
    };
    let numbers: Vec<f64> = cells.iter().map_while(any_number).collect();
    let steps = numbers.windows(2).map(|pair| pair[1] - pair[0]);
    let steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
    let Some(step) = median(&steps) else {
        return Ok(());
    };
    let near = |a: f64, b: f64| (a - b).abs() <= 0.02 * b;
    let name = &time.heading.name;
    if time.heading.unit.is_none()
        && declared.is_none_or(|declared| declared.unit.is_none())
        && let crate::heading::Temporal::Time = crate::heading::temporal(name)
    {
        if !near(step, period.value) {
            return Err(TimeError::OtherStep {
                name: name.clone(),
                step: hyde_units::significant(step, 6),
                said: format!("{} {unit}", hyde_units::significant(period.value, 6)),
                key: period.key.clone(),
                line: period.line,
            });
        }
        notes.push(Note::new(format!(
            "the time `{name}` is read in {unit}: it advances by {}, as `{}` in line {} says",
            hyde_units::significant(step, 6),
            period.key,
            period.line
        )));
        time.heading.unit = Some(Ok(unit.clone()));
        time.heading.place = Place::Row;
        return Ok(());
    }
    let step_s = match (&time.heading.unit, declared.and_then(|d| d.unit.as_ref())) {
        (_, Some(declared)) => step * declared.count_si(),
        (Some(Ok(own)), None) => own.unit().to_si(step),
        _ => return Ok(()),
    };
    let said_s = unit.unit().to_si(period.value);
    if !near(step_s, said_s) {
        notes.push(Note::new(format!(
            "`{}` in line {} says {}, the rows of `{name}` are {} apart: the column counts",
            period.key,
            period.line,
            crate::gaps::seconds(said_s),
            crate::gaps::seconds(step_s)
        )));
    }
    Ok(())
}
