//! [`Unsupported`]: why a program cannot be driven by a record step by step.

/// Why a program has no fixed-step form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unsupported {
    /// A clocked part drives the axis and is not replayed: its name.
    Clock(String),
    /// What is delayed depends on states.
    Delay,
    /// States are chosen while running.
    ChosenStates,
    /// The start has no consistent values.
    Start(String),
}

impl Unsupported {
    /// The equations do not say what the model does.
    pub(crate) fn singular() -> Self {
        Self::Start("the equations are singular".to_owned())
    }
}
