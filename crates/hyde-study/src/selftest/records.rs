//! The simulated records of a case as files, to run its diagnosis on and to look at.

use super::{Ended, work};
use crate::Calibration;
use hyde_calibrate::{Axis, Case, tables_of};
use hyde_signal::Table;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The files, named as those that their stimuli come from.
pub(super) fn files(
    axis: &Axis<'_>,
    case: &Case,
    calibration: &Calibration,
) -> Result<Vec<(String, String)>, Ended> {
    let all = || calibration.fitted.iter().chain(&calibration.holdout);
    let records: Vec<BTreeMap<String, Table>> = all().map(|r| r.tables.clone()).collect();
    let made = tables_of(axis, case, &records);
    let made = made.map_err(|error| Ended::Asked(work::reason(&error)))?;
    let mut files = Vec::new();
    for (recording, tables) in all().zip(made) {
        let several = tables.len() > 1;
        for (record, table) in tables {
            let name = match several {
                true => format!("{record}-{}", recording.name),
                false => recording.name.clone(),
            };
            files.push((name, csv(&table)));
        }
    }
    Ok(files)
}

/// A table in the units of its columns.
fn csv(table: &Table) -> String {
    let header = table.columns().iter().map(|column| match column.unit() {
        Some(unit) => format!("{} [{}]", column.name(), unit.text()),
        None => column.name().to_owned(),
    });
    let mut out = header.collect::<Vec<_>>().join(",");
    out.push('\n');
    let columns: Vec<_> = table.columns().iter().map(|c| c.in_unit()).collect();
    for row in 0..table.rows() {
        for (number, column) in columns.iter().enumerate() {
            let comma = if number == 0 { "" } else { "," };
            // Nine digits are more than any sensor has, and leave out what rounding adds.
            let _ = write!(out, "{comma}{}", hyde_units::significant(column[row], 9));
        }
        out.push('\n');
    }
    out
}
