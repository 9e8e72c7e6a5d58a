//! The file of a signal: a record, or set points for a controller.

use hyde_signal::excite::{Bounds, Design, g_code, twincat};
use hyde_units::{Dimension, NamedUnit, significant};
use std::fmt::Write as _;

/// A format of set points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalForm {
    /// `t [s]` and the column.
    Csv,
    /// Position, velocity, acceleration and direction per cycle, for `MC_ExtSetPointGenFeed`.
    Twincat,
    /// Blocks for one axis, by its letter.
    Gcode(char),
}

/// The content of the file.
///
/// # Errors
/// The signal has no such file.
pub fn content(column: &str, design: &Design, form: SignalForm) -> Result<String, String> {
    if form == SignalForm::Csv {
        return Ok(csv(column, design));
    }
    if matches!(design.wish.bounds, Bounds::Effort(_)) {
        return Err(format!(
            "a controller takes positions, and this signal is in {}\n  help: write a CSV file, `--format csv`, or limit a motion with `--travel`",
            design.wish.unit
        ));
    }
    let SignalForm::Gcode(axis) = form else {
        return Ok(twincat(design));
    };
    if !axis.is_ascii_alphabetic() {
        return Err(format!(
            "`--axis {axis}` is not a letter\n  help: write the letter of the axis, `--axis X`"
        ));
    }
    let is_turned = design.wish.unit.unit().dimension == Dimension::ANGLE;
    let unit = if is_turned { "deg" } else { "mm" };
    let unit = NamedUnit::parse(unit).map_err(|error| error.to_string())?;
    let per_unit = unit.unit().from_si(1.0);
    Ok(g_code(design, axis.to_ascii_uppercase(), per_unit))
}

/// The signal as a record.
fn csv(column: &str, design: &Design) -> String {
    let mut out = format!("t [s],{column} [{}]\n", design.wish.unit);
    for row in 0..design.rows() {
        let time = significant(design.time(row), 12);
        let _ = writeln!(out, "{time},{}", design.cell(row));
    }
    out
}
