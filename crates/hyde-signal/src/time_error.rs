//! Why a column cannot be the time of a record, and what to write instead.

use crate::Fault;
use std::fmt;

/// What is wrong with the time of a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TimeError {
    /// The declared column is not there: its name, and those that are.
    NoColumn(String, Vec<String>),
    /// Another declared column is not there: its name, and those that are.
    NoOther(String, Vec<String>),
    /// The column has a unit of something else.
    OtherUnit {
        /// Its name.
        name: String,
        /// Its unit.
        unit: String,
        /// A column that may be the time.
        instead: Option<Candidate>,
    },
    /// Unit declared and unit in the file are not the same: name, unit in the file, unit declared.
    TwoUnits(String, String, String),
    /// Nothing says that the first column is a time.
    NotSaid {
        /// Its name.
        name: String,
        /// A column that may be the time.
        instead: Option<Candidate>,
    },
    /// A time in whole numbers whose unit is not said: name, and the distance of rows as it stands.
    NoUnit(String, String),
    /// A line above the rows says another time between them than the column, which has no unit.
    OtherStep {
        /// The column.
        name: String,
        /// By how much it advances.
        step: String,
        /// The time between rows that is said.
        said: String,
        /// How the file calls that.
        key: String,
        /// The line that says it.
        line: u64,
    },
    /// Its numbers can be read in two ways.
    Doubtful(Fault),
    /// All rows are at one time.
    Stands {
        /// The name of the column.
        name: String,
        /// The time, as it stands.
        value: String,
        /// A column that may be the time.
        instead: Option<Candidate>,
    },
    /// A cell is no number and no date.
    NoTime {
        /// Its place.
        place: String,
        /// The name of the column.
        name: String,
        /// The cell.
        text: String,
        /// A column that may be the time.
        instead: Option<Candidate>,
    },
    /// The time of a row is before that of the row above it.
    RunsBack {
        /// The place of the row.
        place: String,
        /// The time of the row above it and its own.
        times: (String, String),
        /// Whether it goes back to where it began.
        anew: bool,
    },
}

/// A column that may be the time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// Whether the file says its unit.
    pub has_unit: bool,
}

impl Candidate {
    fn line(&self, record: &str) -> String {
        let Self { name, has_unit } = self;
        match has_unit {
            true => format!("`record {record}(time = {name:?})`"),
            false => format!("`record {record}(time = {name:?} in [ms])` with its unit"),
        }
    }
}

impl TimeError {
    /// What to write, in the experiment that calls the record so.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        let every =
            format!("`record {record} every 1 [ms]` where rows follow each other by a period");
        let which = |instead: &Option<Candidate>| match instead {
            Some(candidate) => format!(
                "declare the column of the time: {}; or {every}",
                candidate.line(record)
            ),
            None => format!(
                "declare the column of the time and its unit: `record {record}(time = \"NAME\" in [ms])`; or {every}"
            ),
        };
        match self {
            Self::NoColumn(_, names) | Self::NoOther(_, names) => {
                let list: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                format!("its columns are {}", list.join(", "))
            }
            Self::OtherUnit { instead, .. } | Self::Stands { instead, .. } => which(instead),
            Self::NotSaid { name, instead } => match instead {
                Some(_) => which(instead),
                None => format!(
                    "if it is the time, say its unit, or what one count of it is: `record {record}(time = {name:?} in [s])`, \
                     `record {record}(time = {name:?} in 125 [us])`; or {every}"
                ),
            },
            Self::TwoUnits(..) => "remove the unit in one of the two places".to_owned(),
            Self::NoUnit(name, _) => format!(
                "say the unit, `record {record}(time = {name:?} in [ms])`, or write it in the header, `{name} [ms]`"
            ),
            Self::OtherStep { name, .. } => {
                format!("say the unit of the time: `record {record}(time = {name:?} in [ms])`")
            }
            Self::Doubtful(fault) => fault.repair.clone(),
            Self::NoTime { text, .. } if has_comma(text) => format!(
                "say the decimal sign, `record {record}(decimal = \",\")`, or write numbers with a point, as `0.5`"
            ),
            Self::NoTime { instead, .. } => {
                let other = instead.as_ref().map_or_else(String::new, |candidate| {
                    format!(
                        "; or declare the column of the time: {}",
                        candidate.line(record)
                    )
                });
                format!(
                    "write seconds, as `0.5`, or dates as `2024-03-05 14:07:01.250`; a time of day may stand alone{other}"
                )
            }
            Self::RunsBack { anew: true, .. } => format!(
                "cut the file there into one file per run, and give them one by one: `--record {record}=PATH`"
            ),
            Self::RunsBack { anew: false, .. } => {
                format!(
                    "sort the rows, or remove those that are out of order. Only if all rows were sampled evenly in the order of the file: \
                     `record {record} every 1 [ms]`, which does not read the time and puts each row one period after the row before it"
                )
            }
        }
    }
}

/// Whether a text is a number but for its decimal comma.
fn has_comma(text: &str) -> bool {
    text.contains(',') && text.trim().replacen(',', ".", 1).parse::<f64>().is_ok()
}

impl fmt::Display for TimeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoColumn(name, _) => write!(f, "there is no column `{name}` for the time"),
            Self::NoOther(name, _) => write!(f, "there is no column `{name}`"),
            Self::OtherUnit { name, unit, .. } => {
                write!(f, "the column `{name} [{unit}]` is not a time")
            }
            Self::TwoUnits(name, file, declared) => write!(
                f,
                "the column `{name}` is in {file} by the file and in {declared} by its declaration"
            ),
            Self::NotSaid { name, .. } if name.is_empty() => {
                write!(f, "the first column has no name, so it may not be the time")
            }
            Self::NotSaid { name, .. } => {
                write!(f, "the first column, `{name}`, may not be the time")
            }
            Self::NoUnit(name, step) => write!(
                f,
                "the time `{name}` has no unit and is in whole numbers, rows {step} apart: seconds, milliseconds, or a count?"
            ),
            Self::OtherStep {
                name,
                step,
                said,
                key,
                line,
            } => write!(
                f,
                "the time `{name}` has no unit and advances by {step}, and `{key}` in line {line} says {said}"
            ),
            Self::Doubtful(fault) => fault.fmt(f),
            Self::Stands { name, value, .. } => write!(
                f,
                "the column `{name}` is not a time: it does not advance, all rows are at {value}"
            ),
            Self::NoTime {
                place, name, text, ..
            } if text.is_empty() => {
                write!(f, "{place}, time column `{name}`: the cell is empty")
            }
            Self::NoTime {
                place, name, text, ..
            } => {
                write!(
                    f,
                    "{place}, time column `{name}`: `{text}` is neither a number nor a date with a time of day"
                )
            }
            Self::RunsBack {
                place,
                times: (before, now),
                anew: true,
            } => write!(
                f,
                "the file contains several runs: the time restarts in {place}, from {before} to {now}"
            ),
            Self::RunsBack {
                place,
                times: (before, now),
                anew: false,
            } => write!(f, "{place}: time runs back from {before} to {now}"),
        }
    }
}

impl std::error::Error for TimeError {}
