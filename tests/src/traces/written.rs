//! A motion written as a trace: the layout, its signs and its encoding.

use super::mutated::{Channel, Motion};
use std::fmt::Write as _;

/// What stands above the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Head {
    Plain,
    Comment,
    Preamble,
    Groups,
    Pairs,
    Nothing,
}

/// Where units stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Units {
    Brackets,
    Parentheses,
    Row,
    Meanings,
    Nowhere,
}

/// How numbers are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Fixed,
    Shortest,
    Exponent,
    Thousands,
}

/// How the text is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Utf8,
    Marked,
    Utf16Le,
    Utf16Be,
    Unmarked16,
    Latin1,
}

/// All of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    pub(super) head: Head,
    pub(super) units: Units,
    pub(super) form: Form,
    pub(super) encoding: Encoding,
    pub(super) separator: char,
    pub(super) comma: bool,
    pub(super) crlf: bool,
    pub(super) trailing: bool,
}

impl Style {
    /// The lines of the trace.
    pub(super) fn lines(&self, motion: &Motion) -> Vec<String> {
        let mut lines = self.head_of(motion);
        for row in 0..motion.time.len() {
            lines.push(self.row(motion, row));
        }
        lines
    }

    /// The bytes of lines.
    pub(super) fn bytes(&self, lines: &[String]) -> Vec<u8> {
        let end = if self.crlf { "\r\n" } else { "\n" };
        let text: String = lines.iter().map(|line| line.clone() + end).collect();
        let wide = |order: fn(u16) -> [u8; 2], mark: &str| -> Vec<u8> {
            let text = [mark, &text].concat();
            text.encode_utf16().flat_map(order).collect()
        };
        match self.encoding {
            Encoding::Utf8 => text.into_bytes(),
            Encoding::Marked => ["\u{feff}", &text].concat().into_bytes(),
            Encoding::Utf16Le => wide(u16::to_le_bytes, "\u{feff}"),
            Encoding::Utf16Be => wide(u16::to_be_bytes, "\u{feff}"),
            Encoding::Unmarked16 => wide(u16::to_le_bytes, ""),
            Encoding::Latin1 => text
                .chars()
                .map(|c| u8::try_from(u32::from(c)).unwrap_or(b'?'))
                .collect(),
        }
    }

    fn head_of(&self, motion: &Motion) -> Vec<String> {
        let columns: Vec<&Channel> = motion.columns().collect();
        let header = |mark: &str| {
            let cells = columns.iter().map(|column| self.heading(column));
            mark.to_owned() + &self.joined(cells.collect())
        };
        let (step, unit) = motion.step();
        // Three places are too few for a short one.
        let short = Style {
            form: if self.form == Form::Thousands && step < 1.0 {
                Form::Shortest
            } else {
                self.form
            },
            ..*self
        };
        let step = short.number(step);
        let period = format!("SampleTime[{unit}]");
        let mut lines = match self.head {
            Head::Plain => vec![header("")],
            Head::Comment => vec!["# bench".to_owned(), header("#")],
            Head::Preamble => vec![
                self.joined(vec!["File".to_owned(), "C:\\Scope\\run.csv".to_owned()]),
                self.joined(vec!["Start".to_owned(), "14:03:22.117".to_owned()]),
                self.joined(vec![period, step]),
                String::new(),
                header(""),
            ],
            Head::Groups => {
                let facts = |key: &str, of: &dyn Fn(&Channel) -> String| {
                    let cells = columns.iter().skip(1).map(|column| of(column));
                    self.joined(std::iter::once(key.to_owned()).chain(cells).collect())
                };
                vec![
                    facts("Name", &|channel| channel.name.to_owned()),
                    facts(&period, &|_| step.clone()),
                    facts("Unit", &|channel| {
                        channel.unit.unwrap_or("(None)").to_owned()
                    }),
                ]
            }
            Head::Pairs => vec![format!("Sampling period is {step} {unit}")],
            Head::Nothing => Vec::new(),
        };
        let below = matches!(self.head, Head::Plain | Head::Preamble);
        let cell = |column: &&Channel| match (self.units, column.unit) {
            (Units::Row, Some(unit)) => format!("[{unit}]"),
            (Units::Meanings, Some(unit)) if column.name != motion.clock.name => {
                format!("Meaning ({unit})")
            }
            (_, unit) => unit.unwrap_or("").to_owned(),
        };
        if below && matches!(self.units, Units::Row | Units::Meanings) {
            lines.push(self.joined(columns.iter().map(cell).collect()));
        }
        lines
    }

    /// A name, with its unit where the header has it.
    fn heading(&self, channel: &Channel) -> String {
        match (self.units, channel.unit) {
            (Units::Brackets, Some(unit)) => format!("{} [{unit}]", channel.name),
            (Units::Parentheses, Some(unit)) => format!("{} ({unit})", channel.name),
            _ => channel.name.to_owned(),
        }
    }

    pub(super) fn row(&self, motion: &Motion, row: usize) -> String {
        let cells = motion
            .columns()
            .map(|column| self.number(column.written[row]));
        if self.head == Head::Pairs {
            let pairs = motion
                .channels
                .iter()
                .map(|channel| format!("{} {}", channel.name, self.number(channel.written[row])));
            return pairs.collect::<Vec<String>>().join(" ");
        }
        self.joined(cells.collect())
    }

    fn joined(&self, mut cells: Vec<String>) -> String {
        if self.trailing {
            cells.push(String::new());
        }
        // A decimal comma between commas is quoted, as spreadsheets do.
        let quoted = |cell: &String| match cell.contains(self.separator) {
            true => format!("\"{cell}\""),
            false => cell.clone(),
        };
        let cells: Vec<String> = cells.iter().map(quoted).collect();
        cells.join(&self.separator.to_string())
    }

    fn number(&self, value: f64) -> String {
        let text = match self.form {
            Form::Fixed => format!("{value:.6}"),
            Form::Shortest => format!("{value}"),
            Form::Exponent => format!("{value:.9e}"),
            Form::Thousands => thousands(value),
        };
        if self.comma {
            text.replace('.', ",").replace('_', ".")
        } else {
            text.replace('_', ",")
        }
    }
}

/// `1_234.5`, the sign between thousands as a place holder.
fn thousands(value: f64) -> String {
    let text = format!("{:.3}", value.abs());
    let (whole, places) = text.split_once('.').unwrap_or((&text, "0"));
    let mut grouped = String::new();
    for (at, digit) in whole.chars().enumerate() {
        if at > 0 && (whole.len() - at) % 3 == 0 {
            grouped.push('_');
        }
        grouped.push(digit);
    }
    let mut out = String::new();
    let sign = if value < 0.0 { "-" } else { "" };
    // Whole ones without places, as spreadsheets write them.
    let places = places.trim_end_matches('0');
    let point = if places.is_empty() { "" } else { "." };
    let _ = write!(out, "{sign}{grouped}{point}{places}");
    out
}
