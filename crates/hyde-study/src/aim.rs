//! [`Aim`]: what a program is made for, which decides its form.

use hyde_compiler::FreeInputs;

/// What a program is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aim {
    /// A run.
    Run,
    /// A run with the energy ledger, and to check everything that is written.
    Ledger,
    /// The linearised model, its inputs free, with the energies of its parts.
    Linearize,
    /// The same to be looked at only: FMUs are allowed, which have no derivatives.
    Look,
    /// What an observer runs: replays made, measured channels alone reported.
    Observe,
    /// A run whose free inputs another tool sets, but for those that a stimulus drives.
    Export,
}

impl Aim {
    /// Which inputs of the model another one drives.
    pub(crate) fn free_inputs(self) -> FreeInputs {
        match self {
            Self::Linearize | Self::Look => FreeInputs::All,
            Self::Export => FreeInputs::Undriven,
            Self::Run | Self::Ledger | Self::Observe => FreeInputs::None,
        }
    }
}
