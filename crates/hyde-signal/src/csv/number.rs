//! The numbers in cells: with a point or with a comma, the same in the whole file.

use crate::Fault;

/// The decimal sign of a file, as its cells show it.
#[derive(Debug)]
pub(super) struct Numbers {
    /// Whether it is the comma; nothing as long as all numbers are whole.
    comma: Option<bool>,
    both: bool,
}

impl Numbers {
    /// Those of a file whose decimal sign may be declared.
    pub(super) fn of(decimal: Option<char>) -> Self {
        Self {
            comma: decimal.map(|sign| sign == ','),
            both: false,
        }
    }

    /// The number in a cell, if it is a finite one with the file's decimal sign.
    pub(super) fn read(&mut self, cell: &str) -> Option<f64> {
        let (value, comma) = number(cell)?;
        if comma.is_some() {
            let known = *self.comma.get_or_insert(comma == Some(true));
            if comma != Some(known) {
                self.both = true;
                return None;
            }
        }
        Some(value)
    }

    /// Whether some numbers have a point and others a comma.
    pub(super) fn has_both(&self) -> bool {
        self.both
    }

    /// Whether the decimal sign is the comma.
    pub(super) fn has_comma(&self) -> bool {
        self.comma == Some(true)
    }
}

/// Whether a cell is a number, whatever the decimal sign.
pub(super) fn is_number(cell: &str) -> bool {
    number(cell).is_some()
}

/// The number in a cell of a preamble, whatever the decimal sign.
pub(super) fn any_number(cell: &str) -> Option<f64> {
    number(cell.trim()).map(|(value, _)| value)
}

/// The sign before the decimals of a number that has one.
pub(super) fn decimal_sign(cell: &str) -> Option<char> {
    is_number(cell).then(|| cell.chars().find(|c| matches!(c, '.' | ',')))?
}

/// The sign of a number that may as well stand between thousands: `1.000`.
pub(super) fn grouping_sign(cell: &str) -> Option<char> {
    let digits = cell.trim().trim_start_matches(['+', '-']);
    let (whole, rest) = digits.split_once(['.', ','])?;
    let first = (1..=3).contains(&whole.len()) && !whole.starts_with('0');
    let group = rest.len() == 3 && rest.bytes().all(|byte| byte.is_ascii_digit());
    (first && group).then(|| decimal_sign(digits))?
}

/// Whether a cell stands for a reading that is missing.
pub(super) fn is_missing(cell: &str) -> bool {
    let marks = [
        "", "nan", "na", "n/a", "#n/a", "null", "none", "-", "--", "---", "inf", "+inf", "-inf",
        "bad", "invalid",
    ];
    let cell = cell.trim();
    marks.iter().any(|mark| cell.eq_ignore_ascii_case(mark)) || cell.contains(".#")
}

/// Whether the numbers of a column may have signs between their thousands: `1.234` beside `999`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Thousands {
    /// Some cell rules it out.
    ruled_out: bool,
    grouped: bool,
    bare: bool,
    cells: u32,
}

impl Thousands {
    /// Looks at a cell that is a number.
    pub(super) fn see(&mut self, cell: &str) {
        if self.ruled_out {
            return;
        }
        self.cells += 1;
        let digits = cell.trim_start_matches(['+', '-']);
        match digits.split_once(['.', ',']) {
            None => self.bare |= digits.len() <= 3,
            Some(_) => {
                self.ruled_out = grouping_sign(digits).is_none();
                self.grouped = true;
            }
        }
    }

    /// What to tell if it may be so.
    pub(super) fn fault(self, column: usize, name: &str, both_signs: bool) -> Option<Fault> {
        let odd = self.bare || both_signs;
        (!self.ruled_out && self.grouped && odd && self.cells > 2).then(|| Fault {
            message: format!(
                "column {column} (`{name}`) has numbers such as `999` beside ones such as `1.234`: one and a part, or a thousand and more?"
            ),
            repair: "say the decimal sign, `decimal = \".\"` or `decimal = \",\"`, or write thousands without a sign"
                .to_owned(),
        })
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
    if cell.parse::<f64>().is_ok() || is_missing(cell) {
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
