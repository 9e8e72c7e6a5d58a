//! What is declared of columns, put on them: units that the file does not say, and values that begin again.

use crate::assemble::{Cells, Raw};
use crate::heading::Place;
use crate::layout::DeclaredColumn;
use crate::time_error::TimeError;
use crate::{Note, wrap};

/// Whether a declaration means that column.
pub(crate) fn means(declared: &DeclaredColumn, column: &Raw) -> bool {
    let heading = &column.heading;
    heading.name == declared.name
        || heading.written == declared.name
        || heading.meaning.as_ref() == Some(&declared.name)
}

/// Puts the declarations on the columns that they mean.
pub(crate) fn apply(raw: &mut [Raw], declared: &[DeclaredColumn]) -> Result<Vec<Note>, TimeError> {
    let mut notes = Vec::new();
    for declared in declared {
        let mut meant = raw.iter_mut().filter(|column| means(declared, column));
        let Some(column) = meant.next() else {
            continue;
        };
        if let Some(period) = declared.wraps {
            notes.push(unwrapped(column, period));
        }
        let Some(unit) = &declared.unit else {
            continue;
        };
        if let Some(own) = column.heading.known_unit()
            && !unit.is(own.unit())
        {
            return Err(TimeError::TwoUnits(
                column.heading.name.clone(),
                own.text().to_owned(),
                unit.to_string(),
            ));
        }
        if !unit.is(unit.unit.unit()) {
            numbers(column, |values| {
                values.iter_mut().for_each(|value| *value *= unit.factor);
            });
        }
        column.heading.unit = Some(Ok(unit.unit.clone()));
        column.heading.place = Place::Usual;
        notes.push(Note::new(format!(
            "`{}` is read in {unit}, as declared",
            column.heading.name
        )));
    }
    Ok(notes)
}

/// Checks that every declared column is there.
pub(crate) fn check<'a>(
    columns: impl Iterator<Item = &'a Raw> + Clone,
    declared: &[DeclaredColumn],
) -> Result<(), TimeError> {
    let missing = declared
        .iter()
        .find(|declared| !columns.clone().any(|column| means(declared, column)));
    match missing {
        Some(declared) => Err(TimeError::NoOther(
            declared.name.clone(),
            columns.map(|column| column.heading.name.clone()).collect(),
        )),
        None => Ok(()),
    }
}

fn unwrapped(column: &mut Raw, period: f64) -> Note {
    let mut wraps = 0;
    numbers(column, |values| {
        let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
        let far = |pair: &&[f64]| (pair[1] - pair[0]).abs() > period / 2.0;
        wraps = finite.windows(2).filter(far).count();
        wrap::unwrap(values, period);
    });
    Note::new(format!(
        "`{}` wraps after {period}, as declared: it does so {}, and is continued",
        column.heading.name,
        hyde_units::counted(wraps, "time")
    ))
}

#[allow(clippy::cast_precision_loss, reason = "a record is of doubles")]
fn numbers(column: &mut Raw, change: impl FnOnce(&mut Vec<f64>)) {
    if let Cells::Integers(values) = &column.cells {
        column.cells = Cells::Numbers(values.iter().map(|value| *value as f64).collect(), None);
    }
    if let Cells::Numbers(values, _) | Cells::Sparse(values, _) = &mut column.cells {
        change(values);
    }
}
