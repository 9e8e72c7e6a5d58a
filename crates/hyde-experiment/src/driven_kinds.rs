//! [`check_columns`]: records that drive an Integer or a Boolean have such a value in every row.

use hyde_diag::Span;
use hyde_program::Program;
use hyde_signal::{Column, Table};
use hyde_units::{Allowed, Dimension, Kind, NamedUnit, significant};
use std::collections::BTreeMap;
use std::fmt;

/// A row with a value that what it drives may not have.
#[derive(Clone, Debug, PartialEq)]
pub struct RowFault {
    /// The record and the column.
    pub column: (String, String),
    /// What it drives: the kind, the name, and where that is said.
    pub drives: (Kind, String, Span),
    /// The number of the row, from 1.
    pub row: usize,
    /// Its time in s.
    pub t: f64,
    /// Its value.
    pub value: f64,
    /// Why the value is refused.
    pub refusal: String,
}

impl fmt::Display for RowFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (record, column) = &self.column;
        let (row, t) = (self.row, significant(self.t, 9));
        let value = significant(self.value, 9);
        let (kind, name) = match self.drives.0 {
            Kind::Boolean => ("Boolean", &self.drives.1),
            Kind::Integer | Kind::Real => ("Integer", &self.drives.1),
        };
        write!(
            f,
            "the column `{column}` of the record `{record}` is {value} in row {row}, at {t} s, and drives the {kind} `{name}`: {}",
            self.refusal
        )
    }
}

/// Looks at every row of the columns that drive an Integer or a Boolean.
///
/// # Errors
/// The first row with a value that is not one.
pub fn check_columns(
    program: &Program,
    records: &BTreeMap<String, Table>,
) -> Result<(), Box<RowFault>> {
    let number = NamedUnit::usual(Dimension::DIMENSIONLESS);
    for column in &program.columns {
        let Some(drives) = &column.drives else {
            continue;
        };
        let allowed = Allowed {
            kind: drives.0,
            ..Allowed::default()
        };
        let Some(table) = records.get(&column.record) else {
            continue;
        };
        let table = table.holding(&column.column);
        let values = table.column(&column.column).map(Column::values);
        for (row, value) in values.unwrap_or_default().iter().enumerate() {
            if let Some(refusal) = allowed.refusal(*value, &number) {
                return Err(Box::new(RowFault {
                    column: (column.record.clone(), column.column.clone()),
                    drives: drives.clone(),
                    row: row + 1,
                    t: table.time()[row],
                    value: *value,
                    refusal,
                }));
            }
        }
    }
    Ok(())
}
