//! [`Refused`] and [`Fault`]: why a study ends without its answer.

use hyde_diag::{Diagnostics, Sources};

/// What is at fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// What was asked: a file, a name, a setting.
    Asked,
    /// The model or its data.
    Model,
    /// The solver could not go on.
    Solver,
    /// Something that the experiment expects.
    Expectation,
    /// Nothing: it was interrupted.
    Interrupted,
}

/// Why a study has no answer.
#[derive(Debug)]
pub enum Refused {
    /// What was asked cannot be: one sentence.
    Asked(String),
    /// Something else is at fault, which has no place in a file: one sentence.
    Because(String, Fault),
    /// The model or its data are at fault, as diagnostics of their files.
    Model {
        /// The files.
        sources: Box<Sources>,
        /// What is wrong with them; warnings stand among them.
        diagnostics: Diagnostics,
        /// What is at fault.
        fault: Fault,
    },
}

impl Refused {
    /// What is at fault.
    #[must_use]
    pub fn fault(&self) -> Fault {
        match self {
            Self::Asked(_) => Fault::Asked,
            Self::Because(_, fault) | Self::Model { fault, .. } => *fault,
        }
    }
}
