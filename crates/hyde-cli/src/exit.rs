//! The exit status of a command.

use std::process::ExitCode;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Exit {
    /// Everything was done.
    Done = 0,
    /// The model or its data are at fault; a diagnostic says where.
    Model = 1,
    /// The command line is.
    CommandLine = 2,
    /// The solver could not go on.
    Solver = 3,
    /// An `expect` did not hold.
    Expectation = 4,
    /// Interrupted; what was finished is kept.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}
