//! What separates the cells of a line.

use super::number::is_number;
use super::rows::cells_of;

/// What separates cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Separator {
    Byte(u8),
    /// Blanks and tabs, one or several.
    Blanks,
}

impl Separator {
    /// All of them; of two that fit equally well the first counts.
    pub(super) const ALL: [Self; 5] = [
        Self::Byte(b','),
        Self::Byte(b';'),
        Self::Byte(b'\t'),
        Self::Byte(b'|'),
        Self::Blanks,
    ];

    /// The one that a declaration means by a character; nothing for one that is not ASCII.
    pub(super) fn of_char(c: char) -> Option<Self> {
        match c {
            ' ' => Some(Self::Blanks),
            _ => u8::try_from(c).ok().filter(u8::is_ascii).map(Self::Byte),
        }
    }

    /// The cells of a line.
    pub(super) fn split(self, line: &str) -> Vec<String> {
        match self {
            Self::Byte(byte) => cells_of(line, byte),
            Self::Blanks => by_blanks(line),
        }
    }

    /// The cells of a line of a preamble, where brackets join nothing.
    pub(super) fn words(self, line: &str) -> Vec<String> {
        match self {
            Self::Byte(byte) => cells_of(line, byte),
            Self::Blanks => words(line),
        }
    }
}

/// What separates the cells of a header, by the first row where there is one.
pub(super) fn separator(header: &str, row: Option<&str>) -> Separator {
    let all = &Separator::ALL[..4];
    let count = |line: &str, separator| match separator {
        Separator::Byte(byte) => 1 + outside_quotes(line, byte),
        Separator::Blanks => by_blanks(line).len(),
    };
    if let Some(row) = row {
        let fits = |separator: &Separator| {
            count(header, *separator) > 1 && count(header, *separator) == count(row, *separator)
        };
        // By how large a part of the cells is numbers, then by how many there are.
        let numbers = |separator: &Separator| {
            let cells = separator.split(row);
            let numbers = cells.iter().filter(|cell| is_number(cell));
            (64 * numbers.count() / cells.len().max(1), cells.len())
        };
        // Of equal ones the first wins.
        if let Some(found) = all
            .iter()
            .rev()
            .filter(|s| fits(s))
            .max_by_key(|s| numbers(s))
        {
            return *found;
        }
        let blanks = Separator::Blanks;
        let none = all.iter().all(|separator| count(header, *separator) == 1);
        if none && count(header, blanks) > 1 && count(header, blanks) == count(row, blanks) {
            return blanks;
        }
    }
    let most = all
        .iter()
        .rev()
        .max_by_key(|separator| count(header, **separator));
    most.copied().unwrap_or(Separator::Byte(b','))
}

/// How often a byte stands in a line outside quotes.
fn outside_quotes(line: &str, separator: u8) -> usize {
    let mut quoted = false;
    let mut own = |byte: u8| {
        quoted ^= byte == b'"';
        byte == separator && !quoted
    };
    line.bytes().filter(|byte| own(*byte)).count()
}

/// Cells between blanks; a unit in brackets belongs to the name before it.
fn by_blanks(line: &str) -> Vec<String> {
    let mut cells: Vec<String> = Vec::new();
    let mut open = false;
    for word in words(line) {
        let continued = open || word.starts_with(['[', '(']);
        open = (open || word.contains(['[', '('])) && !word.ends_with([']', ')']);
        match cells.last_mut().filter(|_| continued) {
            Some(cell) => {
                cell.push(' ');
                cell.push_str(&word);
            }
            None => cells.push(word),
        }
    }
    cells
}

/// What stands between blanks; quotes hold blanks together.
fn words(line: &str) -> Vec<String> {
    let mut words = Vec::new();
    let mut rest = line.trim_start();
    while !rest.is_empty() {
        let quoted = rest
            .strip_prefix('"')
            .and_then(|inner| inner.split_once('"'));
        let (word, behind) = match quoted {
            Some((word, behind)) => (word, behind),
            None => rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len())),
        };
        words.push(word.to_owned());
        rest = behind.trim_start();
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_separator_is_that_of_header_and_row() {
        let byte = |b| Separator::Byte(b);
        assert_eq!(separator("t,x;y,z", None), byte(b','));
        assert_eq!(separator("t;x;y", None), byte(b';'));
        assert_eq!(separator("t\tx", None), byte(b'\t'));
        assert_eq!(separator("\"a,b,c\";\"d,e,f\"", None), byte(b';'));
        assert_eq!(separator("t", None), byte(b','));
        assert_eq!(separator("Time, s;Pos, mm", Some("0,1;0,5")), byte(b';'));
        assert_eq!(separator("t x mode", Some("0.1  2 7")), Separator::Blanks);
        assert_eq!(
            separator("t [s] x [mm]", Some("0,1 2,5")),
            Separator::Blanks
        );
        assert_eq!(separator("Actual Position", Some("0.1")), byte(b','));
    }

    #[test]
    fn quotes_and_brackets_hold_blanks_together() {
        let blanks = Separator::Blanks;
        assert_eq!(blanks.split("t [s] \"x y\" z"), ["t [s]", "x y", "z"]);
        assert_eq!(blanks.words("Unit (None) V (Voltage)").len(), 4);
    }
}
