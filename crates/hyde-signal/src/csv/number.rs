//! The numbers in cells: with a point or with a comma, the same in the whole file; and signs between thousands, where
//! nothing else can be meant.

use crate::Fault;
use crate::decimal::decimal;
use std::borrow::Cow;

/// The decimal sign of a file, as its cells show it.
#[derive(Debug)]
pub(super) struct Numbers {
    /// Whether it is the comma; nothing as long as all numbers are whole.
    comma: Option<bool>,
    both: bool,
    /// The decimal sign that is declared.
    declared: Option<char>,
    /// The first number with signs between its thousands, and its value.
    grouped: Option<(String, f64)>,
}

impl Numbers {
    /// Those of a file whose decimal sign may be declared.
    pub(super) fn of(decimal: Option<char>) -> Self {
        Self {
            comma: decimal.map(|sign| sign == ','),
            both: false,
            declared: decimal,
            grouped: None,
        }
    }

    /// The same for cells that a program wrote as numbers or texts: none has signs between its thousands.
    pub(super) fn exact(self) -> Self {
        Self {
            declared: None,
            ..self
        }
    }

    /// A number in a cell with a point and without signs between its thousands.
    pub(super) fn plain<'c>(&self, cell: &'c str) -> Cow<'c, str> {
        match self.declared.and_then(|sign| in_groups(cell, sign)) {
            Some(plain) => Cow::Owned(plain),
            None => plain(cell),
        }
    }

    /// The number in a cell, if it is a finite one with the file's decimal sign.
    pub(super) fn read(&mut self, cell: &str) -> Option<f64> {
        // With a declared decimal sign the other one can only stand between thousands.
        if let Some(plain) = self.declared.and_then(|sign| in_groups(cell, sign)) {
            let value = plain.parse().ok()?;
            self.grouped.get_or_insert_with(|| (cell.to_owned(), value));
            return Some(value);
        }
        let Number {
            value,
            comma,
            grouped,
        } = number(cell)?;
        if comma.is_some() {
            let known = *self.comma.get_or_insert(comma == Some(true));
            if comma != Some(known) {
                self.both = true;
                return None;
            }
        }
        if grouped && self.grouped.is_none() {
            self.grouped = Some((cell.to_owned(), value));
        }
        Some(value)
    }

    /// A number with signs between its thousands, and how it is read.
    pub(super) fn grouped(&self) -> Option<(&str, f64)> {
        let (cell, value) = self.grouped.as_ref()?;
        Some((cell, *value))
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
    number(cell.trim()).map(|number| number.value)
}

/// The sign before the decimals of a number that has one.
pub(super) fn decimal_sign(cell: &str) -> Option<char> {
    number(cell)?
        .comma
        .map(|comma| if comma { ',' } else { '.' })
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
        "bad", "invalid", "#div/0!", "#value!", "#num!", "#ref!", "#null!", "#name?",
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

/// A finite number in a cell.
struct Number {
    value: f64,
    /// Whether its decimal sign is the comma, if it has one.
    comma: Option<bool>,
    /// Whether signs stand between its thousands.
    grouped: bool,
}

fn number(cell: &str) -> Option<Number> {
    let finite = |text: &str| text.parse().ok().filter(|value: &f64| value.is_finite());
    let read = |value, comma, grouped| Number {
        value,
        comma,
        grouped,
    };
    if let Some((value, point)) = decimal(cell) {
        return Some(read(value, point.then_some(false), false));
    }
    if let Some(value) = finite(cell) {
        return Some(read(value, cell.contains('.').then_some(false), false));
    }
    if !cell.contains('.')
        && let Some(value) = finite(&cell.replacen(',', ".", 1))
    {
        return Some(read(value, Some(true), false));
    }
    if let Some(value) = fortran(cell).and_then(|cell| finite(&cell)) {
        return Some(read(value, Some(false), false));
    }
    let (plain, comma) = without_groups(cell, None)?;
    Some(read(finite(&plain)?, comma, true))
}

/// A number as a cell has it, with a point and without signs between its thousands.
pub(super) fn plain(cell: &str) -> Cow<'_, str> {
    if decimal(cell).is_some() {
        return Cow::Borrowed(cell);
    }
    if let Some(plain) = fortran(cell) {
        return Cow::Owned(plain);
    }
    match without_groups(cell, None) {
        Some((plain, _)) => Cow::Owned(plain),
        None if cell.contains(',') => Cow::Owned(cell.replace(',', ".")),
        None => Cow::Borrowed(cell),
    }
}

/// A double as Fortran writes it, `1.25D-03`, with the sign of an exponent that others read.
fn fortran(cell: &str) -> Option<String> {
    let (mantissa, exponent) = cell.split_once(['D', 'd'])?;
    let digits = exponent.trim_start_matches(['+', '-']);
    let whole = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    (mantissa.contains('.') && whole).then(|| format!("{mantissa}e{exponent}"))
}

/// A number without the signs between its thousands, with a point, and whether its decimal sign is a comma: `1.234,5`,
/// `1'234.5`, `1 234`. Points alone, or commas alone, may be decimal signs that were written wrongly, and are not taken for
/// others, unless the decimal sign is declared.
fn without_groups(cell: &str, declared: Option<char>) -> Option<(String, Option<bool>)> {
    let is_group = |c: char| matches!(c, '.' | ',' | '\'' | '’' | ' ' | '\u{a0}' | '\u{202f}');
    let digits = cell.trim_start_matches(['+', '-', '−']);
    let sign = digits.chars().find(|c| is_group(*c))?;
    let decimal = digits
        .char_indices()
        .rev()
        .find(|(_, c)| matches!(c, '.' | ',') && *c != sign);
    let (whole, decimals) = match decimal {
        Some((at, _)) => (&digits[..at], &digits[at + 1..]),
        None => (digits, ""),
    };
    let groups: Vec<&str> = whole.split(sign).collect();
    let (first, others) = groups.split_first()?;
    let all_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    let even = (1..=3).contains(&first.len())
        && all_digits(first)
        && others
            .iter()
            .all(|group| group.len() == 3 && all_digits(group));
    let other = declared.is_some_and(|declared| declared != sign) && !first.starts_with('0');
    let doubtful = decimal.is_none() && matches!(sign, '.' | ',') && !other;
    if !even || doubtful || !all_digits(decimals) {
        return None;
    }
    let minus = if digits.len() < cell.len() && !cell.starts_with('+') {
        "-"
    } else {
        ""
    };
    let point = if decimal.is_some() { "." } else { "" };
    let plain = format!("{minus}{}{point}{decimals}", groups.concat());
    Some((plain, decimal.map(|(_, c)| c == ',')))
}

/// A number whose groups of three digits have the sign between them that is not the declared decimal sign: `3.000.000` and
/// `1.234` where that is the comma.
fn in_groups(cell: &str, decimal: char) -> Option<String> {
    let other = if decimal == ',' { '.' } else { ',' };
    let (plain, comma) = cell
        .contains(other)
        .then(|| without_groups(cell, Some(decimal)))??;
    let own = comma.is_none_or(|comma| comma == (decimal == ','));
    own.then_some(plain)
}

/// The number in a cell of a file with that decimal sign.
pub(crate) fn number_with(decimal: char, cell: &str) -> Option<f64> {
    Numbers::of(Some(decimal)).read(cell)
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
    if let Some(decimal) = [',', '.']
        .into_iter()
        .find(|sign| in_groups(cell, *sign).is_some())
    {
        return Fault {
            message: format!(
                "{place}: `{cell}` is not a number unless signs stand between its thousands"
            ),
            repair: format!(
                "say the decimal sign, though no number has decimals: `decimal = \"{decimal}\"`; or write thousands without a sign"
            ),
        };
    }
    Fault {
        message: format!("{place}: `{cell}` is not a number"),
        repair: "write numbers with a point, `0.5`, or all of them with a comma and another separator, `0,5;1,5`; \
                 take rows that were not measured out"
            .to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_between_thousands_are_read_where_nothing_else_is_meant() {
        for (cell, value) in [
            ("1.234,5", 1234.5),
            ("-1,234.5", -1234.5),
            ("1'234.5", 1234.5),
            ("1 234 567", 1_234_567.0),
            ("1\u{202f}234,25", 1234.25),
            ("12.345.678,9", 12_345_678.9),
        ] {
            let mut numbers = Numbers::of(None);
            assert_eq!(numbers.read(cell), Some(value), "{cell}");
            assert_eq!(plain(cell).parse(), Ok(value), "{cell}");
            assert_eq!(numbers.grouped(), Some((cell, value)));
        }
        for cell in [
            "1.23,5",
            "1.234,5,6",
            "1.2.3",
            "2024.05.06",
            "1 2",
            "12:30",
            "1.234.567",
            "1.234.56",
            ".234,5",
        ] {
            assert!(!is_number(cell), "{cell}");
        }
        // With the decimal sign declared the other one stands between thousands.
        for (decimal, cell, value) in [
            (',', "3.000.000", Some(3e6)),
            (',', "111.814", Some(111_814.0)),
            (',', "-1.234,5", Some(-1234.5)),
            (',', "0,5", Some(0.5)),
            (',', "0.123", None),
            (',', "1.5", None),
            ('.', "3,000,000", Some(3e6)),
            ('.', "111,814", Some(111_814.0)),
            ('.', "111.814", Some(111.814)),
            ('.', "1,5", None),
        ] {
            assert_eq!(number_with(decimal, cell), value, "{cell}");
            if let Some(value) = value {
                let numbers = Numbers::of(Some(decimal));
                assert_eq!(numbers.plain(cell).parse(), Ok(value), "{cell}");
            }
        }
        let fault = not_a_number(2, 2, "x", "3.000.000");
        assert!(
            fault.repair.contains("`decimal = \",\"`"),
            "{}",
            fault.repair
        );
        for (cell, value) in [("1.25D-03", 1.25e-3), ("-0.5d2", -50.0)] {
            assert_eq!(Numbers::of(None).read(cell), Some(value), "{cell}");
            assert_eq!(plain(cell).parse(), Ok(value), "{cell}");
        }
        for cell in ["12D3", "1.5D", "1.5D+", "abD1"] {
            assert!(!is_number(cell), "{cell}");
        }
        for (cell, value) in [("1.234", 1.234), ("1,234", 1.234), ("1e3", 1000.0)] {
            let mut numbers = Numbers::of(None);
            assert_eq!(numbers.read(cell), Some(value));
            assert_eq!(numbers.grouped(), None);
        }
    }
}
