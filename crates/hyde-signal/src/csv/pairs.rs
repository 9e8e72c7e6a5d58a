//! Rows that name each channel before its value, as LinuxCNC's halscope wrote them.
//!
//! ```text
//! Sampling period is 1000000 nSec
//! joint.0.motor-pos-fb +0,25 joint.0.vel-cmd +157,08
//! ```

use super::ReadError;
use super::facts::period;
use super::grid::Grid;
use super::head::{Line, lines};
use super::number::is_number;
use super::separator::Separator;
use crate::Note;
use crate::heading::Heading;
use crate::layout::Kind;
use std::borrow::Cow;

/// So many lines may stand above the rows.
const ABOVE: usize = 50;

/// Reads the text if its rows are of this kind.
pub(super) fn of(text: &str) -> Result<Option<Grid<'_>>, ReadError> {
    let head: Vec<Line> = lines(text, 0, 0).take(ABOVE).collect();
    let is_first = |at: usize| match (names(head[at].text), head.get(at + 1)) {
        (Some(first), Some(next)) => names(next.text).is_some_and(|names| names == first),
        (first, None) => first.is_some() && at > 0,
        (None, _) => false,
    };
    let Some(at) = (0..head.len()).find(|at| is_first(*at)) else {
        return Ok(None);
    };
    let own = names(head[at].text).unwrap_or_default();
    let is_odd = |line: &&Line| {
        let numbers = line.text.split_whitespace().filter(|word| is_number(word));
        numbers.count() > 1 || own.iter().any(|name| line.text.contains(name))
    };
    if let Some(line) = head[..at].iter().find(is_odd) {
        return Err(ReadError::OddRow { line: line.number });
    }
    let start = head[at].start;
    let above = head[at].number - 1;
    let mut rows = String::with_capacity(text.len() - start);
    let mut last = above;
    for line in lines(text, start, above) {
        // Lines that are left out are kept as blank ones: rows keep the line they stand in.
        rows.extend(std::iter::repeat_n(
            '\n',
            usize::try_from(line.number - last - 1).unwrap_or(0),
        ));
        last = line.number;
        let words: Vec<&str> = line.text.split_whitespace().collect();
        let other = words
            .iter()
            .step_by(2)
            .zip(&own)
            .any(|(word, name)| word != name);
        let is_last = line.end == text.len() && !text.ends_with('\n');
        if (other || words.len() != 2 * own.len()) && !is_last {
            return Err(ReadError::Ragged {
                line: line.number,
                found: words.len().div_ceil(2),
                expected: own.len(),
            });
        }
        let values: Vec<&str> = words.into_iter().skip(1).step_by(2).collect();
        rows.push_str(&values.join("\t"));
        if !is_last {
            rows.push('\n');
        }
    }
    let notes = vec![Note::new("each row names its channels before their values")];
    Ok(Some(Grid {
        headings: own.iter().map(|name| Heading::plain(name)).collect(),
        groups: Vec::new(),
        rows: Cow::Owned(rows),
        lines_above: above,
        separator: b'\t',
        remarks: false,
        period: period(&head[..at], Separator::Byte(b';')),
        kind: Kind::Pairs,
        notes,
    }))
}

/// The names in a row of names and values.
fn names(line: &str) -> Option<Vec<&str>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let (names, values): (Vec<_>, Vec<_>) =
        words.chunks_exact(2).map(|pair| (pair[0], pair[1])).unzip();
    let is_name = |word: &&str| !is_number(word) && word.starts_with(char::is_alphabetic);
    let whole = words.len().is_multiple_of(2) && !names.is_empty();
    (whole && names.iter().all(is_name) && values.iter().all(|word| is_number(word)))
        .then_some(names)
}
