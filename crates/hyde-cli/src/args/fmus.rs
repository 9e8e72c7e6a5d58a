//! How FMUs in a model are run: an argument of the commands that run them, and of no others.

use super::{BudgetArgs, Command, LiveArgs, RunArgs, TestArgs};
use clap::Args;

/// How a command that runs a model runs the FMUs in it.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct FmuProcessArgs {
    /// Run each FMU of the model in a process of its own
    #[arg(long)]
    pub(crate) sandbox: bool,
}

impl Command {
    /// Tells the model of a command how its FMUs are run. A sweep tells each of its cases.
    pub(crate) fn tell_model(&mut self) {
        if let Self::Run(RunArgs { model, fmus, .. })
        | Self::Budget(BudgetArgs { model, fmus, .. })
        | Self::Test(TestArgs { model, fmus })
        | Self::Live(LiveArgs { model, fmus, .. }) = self
        {
            model.sandbox = fmus.sandbox;
        }
    }
}
