//! What is declared of a record's file beside what the file says itself.

use hyde_units::{NamedUnit, Unit};
use std::fmt;

/// How a file is to be read; by default its first column is the time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Layout {
    /// Row k is at k times this period in s; no column is the time then.
    pub every_s: Option<f64>,
    /// The column that is the time.
    pub time: Option<DeclaredColumn>,
    /// Columns whose unit or range the file does not say.
    pub columns: Vec<DeclaredColumn>,
    /// The headings of all columns in order, `x [mm]`, where no line of the file has them.
    pub headings: Option<Vec<String>>,
    /// The line of the names, from 1.
    pub header: Option<u64>,
    /// What separates the cells; a blank stands for one or several of them.
    pub separator: Option<char>,
    /// The decimal sign: a point or a comma.
    pub decimal: Option<char>,
    /// The sheet of a workbook.
    pub sheet: Option<String>,
    /// The encoding, by a name of the [WHATWG](https://encoding.spec.whatwg.org/#names-and-labels).
    pub encoding: Option<String>,
    /// The run that is meant, from 1, where a file contains several.
    pub run: Option<usize>,
    /// The kind of layout that the file must have.
    pub kind: Option<Kind>,
}

/// What is declared of one column.
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredColumn {
    /// Its name, with or without the unit behind it.
    pub name: String,
    /// The unit of its numbers, where the file does not say it.
    pub unit: Option<CountUnit>,
    /// The number of values after which it begins again: 65536 for a counter of 16 bits.
    pub wraps: Option<f64>,
}

/// A unit, or a multiple of one: `125 [us]` for what counts in steps of 125 us.
#[derive(Clone, Debug, PartialEq)]
pub struct CountUnit {
    /// How many of the unit one count is.
    pub factor: f64,
    /// The unit.
    pub unit: NamedUnit,
}

impl CountUnit {
    /// The unit itself.
    #[must_use]
    pub fn one(unit: NamedUnit) -> Self {
        Self { factor: 1.0, unit }
    }

    /// The SI value of one count.
    #[must_use]
    pub fn count_si(&self) -> f64 {
        self.factor * self.unit.unit().to_si(1.0)
    }

    /// Whether it is that unit.
    pub(crate) fn is(&self, unit: Unit) -> bool {
        self.factor.total_cmp(&1.0).is_eq() && self.unit.unit() == unit
    }
}

impl fmt::Display for CountUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is(self.unit.unit()) {
            return write!(f, "{}", self.unit);
        }
        write!(f, "counts of {} {}", self.factor, self.unit)
    }
}

impl DeclaredColumn {
    /// A column without more about it.
    #[must_use]
    pub fn named(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: None,
            wraps: None,
        }
    }
}

/// The kinds of layout that a text can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A header, then rows.
    Plain,
    /// Lines of facts, a header, then rows.
    Preamble,
    /// Lines of facts that name each fact again for every group of columns, and a time column a group.
    Groups,
    /// The name of each channel before its value, in every row.
    Pairs,
    /// Rows of numbers without a header.
    Numbers,
    /// Named arrays of MATLAB or NumPy, which are not a text.
    Arrays,
}

/// What programs write such layouts: the words of `layout WORD`.
const WORDS: [(&str, Kind); 10] = [
    ("plain", Kind::Plain),
    ("preamble", Kind::Preamble),
    ("scopeview", Kind::Preamble),
    ("drive_tool", Kind::Preamble),
    ("groups", Kind::Groups),
    ("twincat", Kind::Groups),
    ("daq", Kind::Groups),
    ("halscope", Kind::Pairs),
    ("halsampler", Kind::Numbers),
    ("numbers", Kind::Numbers),
];

impl Kind {
    /// The kind of that word.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        let found = WORDS.iter().find(|(known, _)| *known == word);
        found.map(|(_, kind)| *kind)
    }

    /// All words.
    pub fn words() -> impl Iterator<Item = &'static str> {
        WORDS.iter().map(|(word, _)| *word)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Plain => "a header and rows",
            Self::Preamble => "lines of facts, a header and rows",
            Self::Groups => "groups of columns, each with its own time column",
            Self::Pairs => "rows of names and values",
            Self::Numbers => "rows of numbers without a header",
            Self::Arrays => "named arrays",
        })
    }
}

impl Layout {
    /// Rows follow each other by a period in s.
    #[must_use]
    pub fn every(period_s: f64) -> Self {
        Self {
            every_s: Some(period_s),
            ..Self::default()
        }
    }
}
