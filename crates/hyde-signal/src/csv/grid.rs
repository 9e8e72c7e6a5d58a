//! Where header, units and rows of a text are, and what separates the cells.

use super::ReadError;
use super::facts::{Period, period};
use super::groups::{self, Group};
use super::head::{Head, Line, declared_above, lines, plain};
use super::labview;
use super::number::is_number;
use super::pairs;
use super::separator::{Separator, separator};
use crate::heading::{Heading, may_be_of_row, of_row};
use crate::layout::Kind;
use crate::{Layout, Note};
use std::borrow::Cow;

/// The parts of a text.
#[derive(Debug)]
pub(super) struct Grid<'a> {
    /// The columns.
    pub(super) headings: Vec<Heading>,
    /// The groups with a time column each; none where all columns have one time.
    pub(super) groups: Vec<Group>,
    /// What is below the header.
    pub(super) rows: Cow<'a, str>,
    /// The lines above it.
    pub(super) lines_above: u64,
    /// What separates the cells.
    pub(super) separator: u8,
    /// Whether a last column for remarks was left out, which rows need not have.
    pub(super) remarks: bool,
    /// The time between rows that a line above them says.
    pub(super) period: Option<Period>,
    /// What kind of layout it is.
    pub(super) kind: Kind,
    /// What was taken for granted.
    pub(super) notes: Vec<Note>,
}

impl<'a> Grid<'a> {
    /// Finds the parts of a record.
    pub(super) fn of(text: &'a str, layout: &Layout) -> Result<Self, ReadError> {
        let found = Self::found(text, layout)?;
        match layout.kind {
            Some(kind) if kind != found.kind => Err(ReadError::OtherKind {
                found: found.kind,
                declared: kind,
            }),
            Some(_) | None => Ok(found),
        }
    }

    fn found(text: &'a str, layout: &Layout) -> Result<Self, ReadError> {
        let declared = layout.separator.and_then(Separator::of_char);
        if let Some(line) = layout.header.filter(|line| *line > 0) {
            return Self::below(text, line, declared);
        }
        let pairs = match (declared, &layout.headings) {
            (None | Some(Separator::Blanks), None) => pairs::of(text)?,
            _ => None,
        };
        if let Some(pairs) = pairs {
            return Ok(pairs);
        }
        let head = Head::of(text, declared);
        let Some(head) = head else {
            return match &layout.headings {
                Some(_) => Err(ReadError::NoRows),
                None => Self::plain(text, (0, 0), declared),
            };
        };
        if let Some((headings, groups, mut notes)) = groups::of(&head, layout.headings.as_deref())?
        {
            head.check_first()?;
            let (rows, separator) = rows(text, head.first.start, head.separator, &mut notes);
            return Ok(Self {
                headings,
                groups,
                rows,
                lines_above: head.first.number - 1,
                separator,
                remarks: false,
                period: None,
                kind: Kind::Groups,
                notes,
            });
        }
        if let Some(headings) = &layout.headings {
            return Self::with_headings(text, &head, headings);
        }
        let named = head.above.is_empty() || is_header(&head, 0);
        let by_rows = declared.or((named && head.width > 1).then_some(head.separator));
        let units = |line: &Line| row_of_units(line, head.separator, head.width).is_some();
        match head.above.as_slice() {
            [] | [_] => Self::plain(text, (0, 0), by_rows),
            [_, line] if is_header(&head, 0) && units(line) => Self::plain(text, (0, 0), by_rows),
            _ if head.has_row_above() => Self::plain(text, (0, 0), declared),
            _ => Self::with_preamble(text, &head, declared),
        }
    }

    /// A header in the first line that is neither blank nor a comment, or in a comment above rows of numbers.
    fn plain(
        text: &'a str,
        (from, above): (usize, u64),
        separator_declared: Option<Separator>,
    ) -> Result<Self, ReadError> {
        let (declared, first) = first_line(text, from, above)?;
        let declared = separator_declared.or(declared);
        let mut notes = Vec::new();
        let below = plain(text, first.end, first.number).next();
        let own = declared.unwrap_or_else(|| separator(first.text, below.map(|line| line.text)));
        let numbers = |line: &str| {
            let cells = own.split(line);
            cells.iter().all(|cell| cell.is_empty() || is_number(cell))
        };
        let mut kind = Kind::Plain;
        let (separator, header, end) = if numbers(first.text) {
            let comments = lines(text, from, above).take_while(|line| line.number < first.number);
            let header = comments.filter(Line::is_comment).last();
            let found = header.and_then(|line| {
                let names = line.plain_text();
                let separator = declared.unwrap_or_else(|| separator(names, Some(first.text)));
                let fits = separator.split(names).len() == separator.split(first.text).len();
                fits.then_some((separator, names, line.number))
            });
            let Some((separator, names, number)) = found else {
                return Err(ReadError::NoHeader {
                    line: first.number,
                    columns: own
                        .split(first.text)
                        .iter()
                        .filter(|cell| !cell.is_empty())
                        .count(),
                    counted: below.is_some_and(|below| counts(own, first.text, below.text)),
                });
            };
            notes.push(Note::new(format!(
                "the comment in line {number} is read as the header"
            )));
            kind = Kind::Preamble;
            let end = Line {
                end: first.start,
                number: first.number - 1,
                ..first
            };
            (separator, names, end)
        } else {
            (own, first.text, first)
        };
        let mut headings = headings(&separator.split(header), &mut notes);
        let mut end = end;
        if let Some(line) = plain(text, end.end, end.number).next()
            && let Some(units) = row_of_units(&line, separator, headings.len())
        {
            headings = with_units(headings, &units, line.number, &mut notes);
            end = line;
        }
        let comments = lines(text, 0, 0).take_while(|line| line.number <= end.number);
        let comments: Vec<Line> = comments.filter(Line::is_comment).collect();
        let period = period(&comments, separator);
        let (rows, separator) = rows(text, end.end, separator, &mut notes);
        Ok(Self {
            headings,
            groups: Vec::new(),
            rows,
            lines_above: end.number,
            separator,
            remarks: false,
            period,
            kind: if above > 0 { Kind::Preamble } else { kind },
            notes,
        })
    }

    /// The header in a declared line.
    fn below(text: &'a str, line: u64, declared: Option<Separator>) -> Result<Self, ReadError> {
        let above = line - 1;
        let lines_above = usize::try_from(above).unwrap_or(usize::MAX);
        let from = text
            .split_inclusive('\n')
            .take(lines_above)
            .map(str::len)
            .sum();
        let header = lines(text, from, above).next();
        let Some(header) = header.filter(|header| header.number == line) else {
            return Err(ReadError::NoLine { line });
        };
        let mut found = match header.is_comment() {
            true => {
                let next = plain(text, header.end, line)
                    .next()
                    .ok_or(ReadError::NoRows)?;
                Self::plain(text, (header.start, above), declared).and_then(|grid| {
                    match grid.lines_above + 1 {
                        first if first == next.number => Ok(grid),
                        _ => Err(ReadError::NoLine { line }),
                    }
                })?
            }
            false => Self::plain(text, (from, above), declared)?,
        };
        let head: Vec<Line> = lines(text, 0, 0)
            .take_while(|other| other.number < line)
            .collect();
        found.period = period(&head, Separator::Byte(found.separator));
        Ok(found)
    }

    /// Rows whose columns are declared one by one.
    fn with_headings(text: &'a str, head: &Head<'a>, names: &[String]) -> Result<Self, ReadError> {
        if names.len() != head.width {
            return Err(ReadError::Names {
                line: head.first.number,
                found: names.len(),
                expected: head.width,
            });
        }
        let mut notes = Vec::new();
        if let Some(last) = head.above.last() {
            notes.push(Note::new(match last.number {
                1 => "line 1 is left out: its columns are declared".to_owned(),
                last => format!("lines 1 to {last} are left out: its columns are declared"),
            }));
        }
        let (rows, separator) = rows(text, head.first.start, head.separator, &mut notes);
        Ok(Self {
            headings: names.iter().map(|name| Heading::of(name)).collect(),
            groups: Vec::new(),
            rows,
            lines_above: head.first.number - 1,
            separator,
            remarks: false,
            period: period(&head.above, head.separator),
            kind: Kind::Numbers,
            notes,
        })
    }

    /// Lines of facts, then a header of one row or two, then rows.
    fn with_preamble(
        text: &'a str,
        head: &Head<'a>,
        declared: Option<Separator>,
    ) -> Result<Self, ReadError> {
        let last = head.above.len() - 1;
        let mut notes = Vec::new();
        let units = row_of_units(&head.above[last], head.separator, head.width)
            .filter(|units| is_header(head, last - 1) || names_by_number(head, last - 1, units));
        let meanings = row_of_meanings(head).filter(|_| units.is_none());
        let two = units.is_some() || meanings.is_some();
        let by_number = |at: usize, units: &[String]| names_by_number(head, at, units);
        let names = (0..=last - usize::from(two)).rfind(|at| {
            let own = units.as_deref().filter(|_| at + 1 == last);
            is_header(head, *at) || own.is_some_and(|units| by_number(*at, units))
        });
        // A line of dashes may stand below the names; one with numbers is a row with something odd in it.
        let is_rule =
            |line: &Line| head.separator.split(line.text).len() == 1 && !is_number(line.text);
        let names = names.filter(|at| two || head.above[at + 1..].iter().all(is_rule));
        let Some(names) = names else {
            if is_header(head, 0) {
                return Self::plain(text, (0, 0), declared);
            }
            return Err(ReadError::Names {
                line: head.first.number,
                found: 0,
                expected: head.width,
            });
        };
        let line = head.above[names];
        let mut columns = headings(&head.separator.split(line.text), &mut notes);
        let remarks = columns.len() > head.width;
        columns.truncate(head.width);
        let number = head.above[last].number;
        if let Some(units) = units {
            columns = with_units(columns, &units, number, &mut notes);
        } else if let Some(meanings) = meanings {
            let both = columns.into_iter().zip(&meanings);
            columns = both
                .map(|(heading, cell)| heading.with_meaning(cell))
                .collect();
            notes.push(Note::new(format!(
                "line {number} says what the columns show, and their units"
            )));
        }
        notes.push(Note::new(format!(
            "the header is in line {}; the lines above it are read for the time between rows only",
            line.number
        )));
        let facts: Vec<Line> = head.above[..names]
            .iter()
            .chain(&head.comments)
            .copied()
            .collect();
        let (columns, note) = labview::with_units(columns, &facts, head.separator);
        notes.extend(note);
        let (rows, separator) = rows(text, head.first.start, head.separator, &mut notes);
        Ok(Self {
            headings: columns,
            groups: Vec::new(),
            rows,
            lines_above: head.first.number - 1,
            separator,
            remarks,
            period: period(&facts, head.separator)
                .map(|own| labview::in_seconds(own, &facts, head.separator)),
            kind: Kind::Preamble,
            notes,
        })
    }

    /// Finds the parts of a table that need not be over time and may have texts in it: a header and rows.
    pub(super) fn of_frame(text: &'a str) -> Result<Self, ReadError> {
        let (declared, first) = first_line(text, 0, 0)?;
        let own = declared.unwrap_or_else(|| separator(first.text, None));
        let Separator::Byte(separator) = own else {
            return Err(ReadError::Empty);
        };
        Ok(Self {
            headings: own
                .split(first.text)
                .iter()
                .map(|cell| Heading::of(cell))
                .collect(),
            groups: Vec::new(),
            rows: Cow::Borrowed(&text[first.end..]),
            lines_above: first.number,
            separator,
            remarks: false,
            period: None,
            kind: Kind::Plain,
            notes: Vec::new(),
        })
    }
}

/// The first line from a byte on that is neither blank nor a comment, and the separator that a line `sep=;` above it declares.
fn first_line(
    text: &str,
    from: usize,
    above: u64,
) -> Result<(Option<Separator>, Line<'_>), ReadError> {
    let mut plain = plain(text, from, above);
    let first = plain.next().ok_or(ReadError::Empty)?;
    match declared_above(&first) {
        Some(separator) => Ok((Some(separator), plain.next().ok_or(ReadError::Empty)?)),
        None => Ok((None, first)),
    }
}

/// Whether the first column of two rows is a number of the row.
fn counts(separator: Separator, row: &str, next: &str) -> bool {
    let first = |line| separator.split(line).first()?.trim().parse::<i64>().ok();
    let several = separator.split(row).len() > 1;
    several && first(row).is_some_and(|row: i64| first(next) == Some(row.saturating_add(1)))
}

/// The columns that the cells of a header name.
fn headings(cells: &[String], notes: &mut Vec<Note>) -> Vec<Heading> {
    let last = cells.iter().rposition(|cell| !cell.is_empty());
    let named = last.map_or(0, |last| last + 1);
    if named < cells.len() {
        notes.push(Note::new(
            "its lines end with a separator: the empty last column is ignored",
        ));
    }
    cells[..named]
        .iter()
        .map(|cell| Heading::of(cell))
        .collect()
}

/// The rows from a byte on, and the byte that separates their cells.
fn rows<'a>(
    text: &'a str,
    from: usize,
    separator: Separator,
    notes: &mut Vec<Note>,
) -> (Cow<'a, str>, u8) {
    let rows = &text[from..];
    match separator {
        Separator::Byte(byte) => (Cow::Borrowed(rows), byte),
        Separator::Blanks => {
            notes.push(Note::new("its cells are separated by blanks"));
            let tabbed = rows.split_inclusive('\n').map(|line| {
                let cells: Vec<&str> = line.split_whitespace().collect();
                let end = if line.ends_with('\n') { "\n" } else { "" };
                cells.join("\t") + end
            });
            (Cow::Owned(tabbed.collect()), b'\t')
        }
    }
}

/// Whether a last column of this name may be one in which nobody has written anything.
fn may_be_empty(name: &str) -> bool {
    let words = [
        "",
        "comment",
        "comments",
        "remark",
        "remarks",
        "kommentar",
        "note",
        "notes",
    ];
    words.iter().any(|word| name.eq_ignore_ascii_case(word))
}

/// Whether a line above the rows names as many columns as they have.
fn is_header(head: &Head<'_>, at: usize) -> bool {
    let Some(line) = head.above.get(at) else {
        return false;
    };
    let mut cells = head.separator.split(line.text);
    while cells.len() > head.width && cells.last().is_some_and(|cell| may_be_empty(cell)) {
        cells.pop();
    }
    let named = cells.iter().rposition(|cell| !cell.is_empty());
    let numbers = cells.iter().any(|cell| is_number(cell));
    let unnamed = cells.iter().take(head.width).filter(|cell| cell.is_empty());
    named == Some(head.width - 1) && !numbers && unnamed.count() <= 1
}

/// Whether a line names columns by number, `x-axis,1,2`, above a line in which each of them has its unit.
fn names_by_number(head: &Head<'_>, at: usize, units: &[String]) -> bool {
    let cells = head.separator.split(head.above[at].text);
    let named = cells.len() == head.width && cells.iter().all(|cell| !cell.is_empty());
    let first = cells.first().is_some_and(|cell| !is_number(cell));
    let each = units.iter().all(|cell| matches!(of_row(cell), Some(Ok(_))));
    named && first && each
}

fn with_units(
    headings: Vec<Heading>,
    units: &[String],
    line: u64,
    notes: &mut Vec<Note>,
) -> Vec<Heading> {
    notes.push(Note::new(format!("line {line} is read as a row of units")));
    headings
        .into_iter()
        .zip(units)
        .map(|(heading, cell)| heading.with_row(cell))
        .collect()
}

/// The cells of a line that is a row of units: no number among them, but a unit that is known.
fn row_of_units(line: &Line<'_>, separator: Separator, columns: usize) -> Option<Vec<String>> {
    let mut cells = separator.words(line.text);
    while cells.len() > columns.max(1) && cells.last().is_some_and(String::is_empty) {
        cells.pop();
    }
    let number = cells.iter().any(|cell| is_number(cell));
    let known = cells.iter().any(|cell| matches!(of_row(cell), Some(Ok(_))));
    let unit_or_none = cells
        .iter()
        .all(|cell| Heading::of(cell).unit.is_none() || may_be_of_row(cell));
    let first = cells.first().is_some_and(|cell| may_be_of_row(cell));
    (cells.len() == columns && !number && known && first && unit_or_none).then_some(cells)
}

/// The cells of the last line above the rows, if it says what the columns show that the line above it names.
fn row_of_meanings(head: &Head<'_>) -> Option<Vec<String>> {
    let last = head.above.len().checked_sub(1)?;
    let cells = |at: usize| head.separator.split(head.above[at].text);
    if last == 0 || !is_header(head, last - 1) || !is_header(head, last) {
        return None;
    }
    let has_unit = |cell: &String| Heading::of(cell).known_unit().is_some();
    let without = cells(last - 1).iter().all(|cell| !has_unit(cell));
    let with = cells(last).iter().any(has_unit);
    (without && with).then(|| cells(last))
}
