//! From the columns of a file to a table: which of them is the time, and which cannot be used.

use crate::calendar::Origin;
use crate::heading::{Heading, Place};
use crate::instants;
use crate::layout::Layout;
use crate::texts::Texts;
use crate::time_error::TimeError;
use crate::{Column, Note, Table, TableError, declared};
use std::fmt;

/// A column as a file has it.
#[derive(Debug)]
pub(crate) struct Raw {
    pub(crate) heading: Heading,
    pub(crate) cells: Cells,
}

/// The cells of a column.
#[derive(Debug)]
pub(crate) enum Cells {
    /// Numbers, with what makes them unusable.
    Numbers(Vec<f64>, Option<Fault>),
    /// Numbers of which some are missing, NaN, with that told; the others are readings.
    Sparse(Vec<f64>, Fault),
    /// Whole numbers.
    Integers(Vec<i64>),
    /// Texts.
    Texts(Texts),
}

impl Cells {
    /// Whether these are the same numbers or texts, all of them there.
    fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Numbers(a, None), Self::Numbers(b, None)) => a == b,
            (Self::Integers(a), Self::Integers(b)) => a == b,
            (Self::Texts(a), Self::Texts(b)) => a == b,
            _ => false,
        }
    }
}

/// Why a column cannot be used, and what to change in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// What is wrong.
    pub message: String,
    /// What to change.
    pub repair: String,
}

/// A column that a file has and nobody can use as a whole.
#[derive(Clone, Debug, PartialEq)]
pub struct Unusable {
    /// Its name.
    pub name: String,
    /// What is wrong with it.
    pub fault: Fault,
    /// Its readings at their own times, where nothing is wrong but that some are missing: they can be compared with a model,
    /// and cannot drive one.
    pub readings: Option<Box<Table>>,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// Why columns are no table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AssembleError {
    Time(TimeError),
    Table(TableError),
}

/// Makes the table; `place` names a row in messages.
pub(crate) fn assemble(
    mut raw: Vec<Raw>,
    layout: &Layout,
    mut notes: Vec<Note>,
    place: &dyn Fn(usize) -> String,
) -> Result<Table, AssembleError> {
    notes.extend(declared::apply(&mut raw, &layout.columns).map_err(AssembleError::Time)?);
    notes.extend(set_repeated_apart(&mut raw));
    let mut time = match layout.every_s {
        Some(_) => None,
        None => {
            let declared = layout.time.as_ref();
            let at = instants::place(&raw, declared).map_err(AssembleError::Time)?;
            let instants =
                instants::read(&raw, at, declared, place).map_err(AssembleError::Time)?;
            Some((at, instants))
        }
    };
    notes.extend(in_parentheses(&raw));
    let mut origin: Option<Origin> = None;
    let mut columns: Vec<(bool, Column)> = Vec::new();
    let mut unusable: Vec<Unusable> = Vec::new();
    let mut sparse: Vec<(Column, Fault)> = Vec::new();
    let names: Vec<String> = raw
        .iter()
        .map(|column| column.heading.name.clone())
        .collect();
    for (at, column) in raw.into_iter().enumerate() {
        let name = column.heading.name.clone();
        if let Some((_, instants)) = time.take_if(|(time, _)| *time == at) {
            notes.extend(instants.notes);
            origin = instants.origin;
            let column = Column::new(name, instants.unit, instants.seconds);
            columns.push((true, column));
            continue;
        }
        let first = names[..at]
            .iter()
            .position(|known| *known == name && !name.is_empty());
        let read = match first {
            Some(first) => Err(twice(&name, first, at)),
            None => usable(column, at + 1),
        };
        match read {
            Ok((column, None)) => columns.push((false, column)),
            Ok((column, Some(missing))) => sparse.push((column, missing)),
            Err(fault) => unusable.push(Unusable {
                name,
                fault,
                readings: None,
            }),
        }
    }
    // A name that two columns have means neither of them; the time is known by its place.
    let doubled = |column: &Column| unusable.iter().any(|other| other.name == column.name());
    columns.retain(|(is_time, column)| *is_time || !doubled(column));
    let faults = unusable.iter().map(|own| &own.fault);
    let faults = faults.chain(sparse.iter().map(|(_, fault)| fault)).next();
    if let (true, Some(first)) = (columns.is_empty(), faults) {
        let error = TableError::NoneUsable(first.message.clone());
        return Err(AssembleError::Table(error));
    }
    let time_at = columns.iter().position(|(is_time, _)| *is_time);
    let columns = columns.into_iter().map(|(_, column)| column).collect();
    let table = match layout.every_s {
        Some(period_s) => Table::every(period_s, columns),
        None => Table::with_time(columns, time_at.unwrap_or(0)),
    };
    let table = table.map_err(AssembleError::Table)?;
    unusable.extend(sparse.into_iter().map(|(column, fault)| Unusable {
        name: column.name().to_owned(),
        readings: table.readings_of(&column).map(Box::new),
        fault,
    }));
    Ok(table.with_findings(notes, unusable, origin))
}

/// A column, with what is told of readings that it lacks.
fn usable(column: Raw, number: usize) -> Result<(Column, Option<Fault>), Fault> {
    let Heading {
        name,
        unit,
        meaning,
        ..
    } = column.heading;
    if name.is_empty() {
        return Err(Fault {
            message: format!("column {number} has no name"),
            repair: "give the column a name in the header".to_owned(),
        });
    }
    let mut missing = None;
    let values = match column.cells {
        Cells::Numbers(values, None) => values,
        Cells::Sparse(values, fault) => {
            missing = Some(fault);
            values
        }
        #[allow(clippy::cast_precision_loss, reason = "a record is of doubles")]
        Cells::Integers(values) => values.into_iter().map(|value| value as f64).collect(),
        Cells::Numbers(_, Some(fault)) => return Err(fault),
        Cells::Texts(_) => {
            return Err(Fault {
                message: format!("column `{name}` holds no numbers"),
                repair: "remove the column: a record contains only numbers".to_owned(),
            });
        }
    };
    let raw = Column::raw(name.clone(), values).showing(meaning);
    match unit {
        None => Ok((raw, missing)),
        Some(Ok(unit)) => Ok((raw.converted(unit), missing)),
        Some(Err(error)) => Err(Fault {
            message: format!("column {number} (`{name}`): {error}"),
            repair: format!(
                "write the unit as in a model, `{name} [N]`, or leave the unit out and give it where the column is used; \
                 or say it in the experiment: `record NAME(column = {name:?} in [N])`"
            ),
        }),
    }
}

/// Channels that are in the file twice with equal values count once.
fn set_repeated_apart(raw: &mut Vec<Raw>) -> Option<Note> {
    let mut repeated: Vec<String> = Vec::new();
    let mut at = 0;
    while at < raw.len() {
        let column = &raw[at];
        let same = |other: &Raw| {
            other.heading == column.heading
                && !column.heading.name.is_empty()
                && other.cells.same(&column.cells)
        };
        match raw[..at].iter().any(same) {
            true => repeated.push(raw.remove(at).heading.name),
            false => at += 1,
        }
    }
    (!repeated.is_empty()).then(|| {
        let names = crate::note::listed(repeated.iter().map(String::as_str));
        Note::new(format!(
            "more than once in the file with equal values, and read once: {names}"
        ))
    })
}

fn twice(name: &str, first: usize, second: usize) -> Fault {
    let error = TableError::DuplicateName {
        name: name.to_owned(),
        columns: (first + 1, second + 1),
    };
    Fault {
        message: error.to_string(),
        repair: "give every column a different name".to_owned(),
    }
}

/// That units in parentheses were read.
fn in_parentheses(raw: &[Raw]) -> Option<Note> {
    let in_parentheses = raw.iter().filter(|c| c.heading.place == Place::Parentheses);
    let list: Vec<String> = in_parentheses
        .filter_map(|c| {
            Some(format!(
                "`{}` in {}",
                c.heading.name,
                c.heading.known_unit()?
            ))
        })
        .collect();
    (!list.is_empty()).then(|| {
        Note::new(format!(
            "units in parentheses were read: {}",
            list.join(", ")
        ))
    })
}
