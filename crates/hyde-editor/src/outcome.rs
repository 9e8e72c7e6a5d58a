//! How a command of a lens ended: its page, the course of every variable of a run, and why the run failed.

use hyde_units::NamedUnit;
use std::path::PathBuf;

/// How a command ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The page that it wrote, or why there is none.
    pub page: Result<PathBuf, String>,
    /// The variables of a run, as far as it came.
    pub courses: Option<Courses>,
    /// What ended a run, the reason first.
    pub failures: Vec<Failure>,
}

impl From<Result<PathBuf, String>> for Outcome {
    fn from(page: Result<PathBuf, String>) -> Self {
        Self {
            page,
            courses: None,
            failures: Vec::new(),
        }
    }
}

/// Variables over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Courses {
    /// The instants in s, never running back.
    pub time: Vec<f64>,
    /// The variables.
    pub list: Vec<Course>,
}

/// A variable over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Its full name.
    pub name: String,
    /// The unit that it is declared in.
    pub unit: NamedUnit,
    /// Its values, SI, one an instant.
    pub values: Vec<f64>,
}

/// Why a run ended, at the equations that it is about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Failure {
    /// The code of the diagnostic.
    pub code: String,
    /// What happened.
    pub message: String,
    /// Values at that instant, and what came before.
    pub notes: Vec<String>,
    /// What to do.
    pub help: Option<String>,
    /// The equations and conditions.
    pub labels: Vec<Label>,
}

/// A place in a text. Lines and columns begin at 1, columns count characters.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Label {
    /// The name of the source text: a path, or that of a text of the library.
    pub file: String,
    /// Where it begins.
    pub from: (usize, usize),
    /// Where it ends.
    pub to: (usize, usize),
    /// What is there.
    pub text: String,
}
