//! What the lines of facts of a LabVIEW measurement (`.lvm`) say of its columns.
//!
//! ```text
//! Y_Unit_Label  mm    A
//! X_Dimension   Time  Time
//! X_Value       pos   cur   Comment
//! ```

use super::facts::Period;
use super::head::Line;
use super::separator::Separator;
use crate::Note;
use crate::heading::Heading;
use hyde_units::{Dimension, NamedUnit};

/// The header of the column of times.
const TIMES: &str = "X_Value";

/// The columns with the units that lines above them give: one for each column that is no `X_Value`, whose values are in s
/// where its dimension is time.
pub(super) fn with_units(
    columns: Vec<Heading>,
    above: &[Line<'_>],
    separator: Separator,
) -> (Vec<Heading>, Option<Note>) {
    let line = |key: &str| {
        let mut lines = above
            .iter()
            .rev()
            .map(|line| (line, separator.words(line.text)));
        lines.find(|(_, cells)| cells.first().is_some_and(|cell| cell == key))
    };
    let units = line("Y_Unit_Label");
    let timed = is_timed(above, separator) && !lacks_times(above, separator);
    let mut own = units.iter().flat_map(|(_, cells)| cells.iter().skip(1));
    let columns = columns
        .into_iter()
        .map(|heading| match heading.name == TIMES {
            true if timed => heading.with_row("s"),
            true => heading,
            false => match own.next() {
                Some(unit) => heading.with_row(unit),
                None => heading,
            },
        });
    let columns = columns.collect();
    let note = units.as_ref().map(|(line, _)| {
        Note::new(format!(
            "the units of its columns are in line {}, `Y_Unit_Label`",
            line.number
        ))
    });
    (columns, note)
}

/// The time between rows in s, where the file has no column of times: it gives `Delta_X` without a unit.
pub(super) fn in_seconds(period: Period, above: &[Line<'_>], separator: Separator) -> Period {
    let bare = period.unit.is_none() && period.key == "Delta_X";
    match bare && lacks_times(above, separator) && is_timed(above, separator) {
        true => Period {
            unit: Some(NamedUnit::usual(Dimension::TIME)),
            ..period
        },
        false => period,
    }
}

/// Whether the dimension of its columns of `X_Value` is time.
fn is_timed(above: &[Line<'_>], separator: Separator) -> bool {
    says(above, separator, "X_Dimension", "Time")
}

/// Whether its `X_Value` is empty.
fn lacks_times(above: &[Line<'_>], separator: Separator) -> bool {
    says(above, separator, "X_Columns", "No")
}

fn says(above: &[Line<'_>], separator: Separator, key: &str, word: &str) -> bool {
    above.iter().any(|line| {
        let cells = separator.words(line.text);
        cells.first().is_some_and(|cell| cell == key) && cells[1..].iter().any(|cell| cell == word)
    })
}
