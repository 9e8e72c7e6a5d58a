//! [`RunError`]: why a run of an experiment has no results.

use crate::compare::CompareError;
use crate::driven_kinds::RowFault;
use hyde_sim::Failure;

/// Why there is no run.
#[derive(Clone, Debug)]
pub enum RunError {
    /// No parameter of that name.
    NoParameter(String),
    /// The parameter shapes the equations or may not be set: its name and why.
    CannotSet(String, &'static str),
    /// The value of a parameter is not allowed: its name and why.
    NotAllowed(String, String),
    /// A row of a record has a value that what it drives may not have.
    Row(Box<RowFault>),
    /// The parameter shapes the equations, or is a whole array: there is no gradient by it. Its name and why.
    NoGradientBy(String, &'static str),
    /// Neither the experiment nor the caller says when to stop.
    NoStop,
    /// The run would end before it starts, at the times in s; the record that it starts with.
    EndsBeforeStart {
        /// Start in s.
        start_s: f64,
        /// Stop in s.
        stop_s: f64,
        /// The record that begins at the start.
        record: Option<String>,
    },
    /// It would last so many s, in which instants cannot be told apart.
    Lasts(f64),
    /// A number that must be positive is not: which, and its value.
    NotPositive(&'static str, f64),
    /// More rows of results than fit anywhere.
    TooManyRows {
        /// The rows.
        rows: f64,
        /// The columns of each.
        columns: usize,
        /// The time in s that rows may be apart at least.
        least_s: f64,
    },
    /// A measured channel cannot be compared.
    Compare(CompareError),
    /// A measure or expectation reads what is not a number: its name, the variable, and when first, in s.
    NotANumber {
        /// The measure's name, or the expectation as written.
        measure: String,
        /// The variable.
        variable: String,
        /// When first, in s.
        t: f64,
    },
    /// The solver could not go on.
    Failed(Box<Failure>),
}
