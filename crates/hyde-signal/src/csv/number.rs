//! The numbers in cells: with a point or with a comma, the same in the whole file.

use crate::Fault;

/// The decimal sign of a file, as its cells show it.
#[derive(Debug, Default)]
pub(super) struct Numbers {
    /// Whether it is the comma; nothing as long as all numbers are whole.
    comma: Option<bool>,
}

impl Numbers {
    /// The number in a cell, if it is a finite one with the file's decimal sign.
    pub(super) fn read(&mut self, cell: &str) -> Option<f64> {
        let (value, comma) = number(cell)?;
        if comma.is_some() {
            let known = *self.comma.get_or_insert(comma == Some(true));
            if comma != Some(known) {
                return None;
            }
        }
        Some(value)
    }

    /// Whether a cell is a number, whatever the decimal sign.
    pub(super) fn is_number(cell: &str) -> bool {
        number(cell).is_some()
    }

    /// Whether the decimal sign is the comma.
    pub(super) fn has_comma(&self) -> bool {
        self.comma == Some(true)
    }
}

/// The number, and whether its decimal sign is a comma, if it has one.
fn number(cell: &str) -> Option<(f64, Option<bool>)> {
    let finite = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
    match finite(cell) {
        Some(value) => Some((value, cell.contains('.').then_some(false))),
        None if cell.contains('.') => None,
        None => Some((finite(&cell.replacen(',', ".", 1))?, Some(true))),
    }
}

/// `TRUE` and `FALSE` as 1 and 0.
pub(super) fn truth(cell: &str) -> Option<f64> {
    let is = |text: &str| cell.eq_ignore_ascii_case(text);
    match (is("true"), is("false")) {
        (true, _) => Some(1.0),
        (_, true) => Some(0.0),
        _ => None,
    }
}

/// A cell that is no number, in words.
pub(super) fn not_a_number(line: u64, column: usize, name: &str, cell: &str) -> Fault {
    let place = format!("line {line}, column {column} (`{name}`)");
    if cell.is_empty() {
        return Fault {
            message: format!("{place}: the cell is empty"),
            repair: "insert the missing value, or remove the row: Hyde does not guess values"
                .to_owned(),
        };
    }
    if number(cell).is_some() {
        return Fault {
            message: format!("{place}: `{cell}` has a different decimal sign than the cells before it"),
            repair: "write all numbers with a point, `0.5`, or all with a comma and another separator, `0,5;1,5`".to_owned(),
        };
    }
    if cell.parse::<f64>().is_ok() {
        return Fault {
            message: format!("{place}: `{cell}` is not finite"),
            repair: "remove the row, or insert the correct value: Hyde does not guess values"
                .to_owned(),
        };
    }
    Fault {
        message: format!("{place}: `{cell}` is not a number"),
        repair: "write numbers with a point, `0.5`, or all of them with a comma and another separator, `0,5;1,5`; \
                 take rows that were not measured out"
            .to_owned(),
    }
}
