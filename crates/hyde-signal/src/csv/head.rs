//! The lines of a text, and which of them are its first rows.

use super::ReadError;
use super::number::{is_missing, is_number, truth};
use super::separator::Separator;
use crate::calendar::is_stamp;

/// So many lines are looked at for the first row.
const LOOKED_AT: usize = 200;

/// So many lines below each other are rows.
const ROWS: usize = 3;

/// A line that is not blank.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line<'a> {
    pub(super) number: u64,
    pub(super) text: &'a str,
    /// Where it begins.
    pub(super) start: usize,
    /// Where the next line begins.
    pub(super) end: usize,
}

impl<'a> Line<'a> {
    pub(super) fn is_comment(&self) -> bool {
        self.text.starts_with(['#', '%'])
    }

    /// Without the mark of a comment.
    pub(super) fn plain_text(&self) -> &'a str {
        self.text.trim_start_matches(['#', '%']).trim()
    }
}

/// The lines from a byte on that are not blank, the line `above` being the last before it.
pub(super) fn lines(text: &str, from: usize, above: u64) -> impl Iterator<Item = Line<'_>> {
    let mut end = from;
    let mut number = above;
    let lines = text[from..].split_inclusive('\n').map(move |line| {
        let start = end;
        end += line.len();
        number += 1;
        Line {
            number,
            text: line.trim_matches([' ', '\r', '\n']),
            start,
            end,
        }
    });
    lines.filter(|line| !line.text.trim().is_empty())
}

/// Those of them that are no comments.
pub(super) fn plain(text: &str, from: usize, above: u64) -> impl Iterator<Item = Line<'_>> {
    lines(text, from, above).filter(|line| !line.is_comment())
}

/// What stands above the rows of a text whose rows are numbers.
#[derive(Debug)]
pub(super) struct Head<'a> {
    /// The lines above the first row, comments and a line `sep=;` apart.
    pub(super) above: Vec<Line<'a>>,
    /// The comments among them.
    pub(super) comments: Vec<Line<'a>>,
    /// What separates the cells.
    pub(super) separator: Separator,
    /// The first row.
    pub(super) first: Line<'a>,
    /// How many cells a row has.
    pub(super) width: usize,
}

impl<'a> Head<'a> {
    /// Looks for the first rows; nothing if no separator gives rows of numbers.
    pub(super) fn of(text: &'a str, declared: Option<Separator>) -> Option<Self> {
        let all: Vec<Line<'a>> = lines(text, 0, 0).take(LOOKED_AT).collect();
        let (comments, plain): (Vec<Line>, Vec<Line>) = all.into_iter().partition(Line::is_comment);
        let own = plain.first().and_then(declared_above);
        let plain = match own {
            Some(_) => &plain[1..],
            None => &plain[..],
        };
        let candidates = match declared.or(own) {
            Some(separator) => vec![separator],
            None => Separator::ALL.to_vec(),
        };
        let found = candidates.into_iter().rev().filter_map(|separator| {
            let (at, width, worth) = first_row(plain, separator)?;
            Some((separator, at, width, worth))
        });
        let (separator, at, width, _) = found.max_by_key(|(.., worth)| *worth)?;
        let first = plain[at];
        Some(Self {
            above: plain[..at].to_vec(),
            comments: comments
                .into_iter()
                .filter(|line| line.number < first.number)
                .collect(),
            separator,
            first,
            width,
        })
    }
}

impl Head<'_> {
    /// Refuses a line above the first row that begins as a row does.
    pub(super) fn check_first(&self) -> Result<(), ReadError> {
        let begins = |line: &&Line<'_>| {
            let cells = self.separator.words(line.text);
            let first = cells.first().map_or("", String::as_str);
            is_missing(first)
                || first.starts_with(|c: char| c.is_ascii_digit() || "+-−.".contains(c))
        };
        match self.above.iter().find(begins) {
            Some(line) => Err(ReadError::OddRow { line: line.number }),
            None => Ok(()),
        }
    }

    /// Whether a row stands among the lines above the first one.
    pub(super) fn has_row_above(&self) -> bool {
        self.above
            .iter()
            .any(|line| row(line, self.separator).is_some())
    }
}

/// The separator that a line `sep=;` declares.
pub(super) fn declared_above(line: &Line<'_>) -> Option<Separator> {
    let text = line.text.to_ascii_lowercase();
    match text.strip_prefix("sep=").map(str::as_bytes) {
        Some([byte]) => Some(Separator::Byte(*byte)),
        Some(_) | None => None,
    }
}

/// Where the rows begin with that separator, how many cells they have, and how well that explains the lines: how many of them
/// are such rows, and how many numbers they have.
fn first_row(lines: &[Line<'_>], separator: Separator) -> Option<(usize, usize, (usize, usize))> {
    let cells: Vec<Option<Vec<String>>> = lines.iter().map(|line| row(line, separator)).collect();
    (0..lines.len()).find_map(|at| {
        let rows = &cells[at..(at + ROWS).min(cells.len())];
        let rows: Vec<&Vec<String>> = rows.iter().filter_map(Option::as_ref).collect();
        // The last line of a file may be cut off.
        let whole = &rows[..rows.len().min((cells.len() - 1 - at).max(1))];
        let even = whole.iter().all(|row| row.len() == whole[0].len());
        if rows.is_empty() || rows.len() < ROWS.min(cells.len() - at) || !even {
            return None;
        }
        let numbers = rows[0].iter().filter(|cell| is_number(cell)).count();
        let width = rows[0].len();
        let own = cells[at..].iter().flatten();
        Some((
            at,
            width,
            (own.filter(|row| row.len() == width).count(), numbers),
        ))
    })
}

/// The cells of a line that can be a row: numbers, truths, stamps and empty ones; those behind a last separator left out.
fn row(line: &Line<'_>, separator: Separator) -> Option<Vec<String>> {
    let mut cells = separator.split(line.text);
    while cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    let is_value = |cell: &String| {
        is_missing(cell) || is_number(cell) || truth(cell).is_some() || is_stamp(cell)
    };
    (!cells.is_empty() && cells.iter().all(is_value)).then_some(cells)
}
