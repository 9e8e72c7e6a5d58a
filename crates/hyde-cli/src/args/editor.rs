//! The options of the commands that help to write models.

use super::{FmuProcessArgs, ModelArgs};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct FmtArgs {
    /// Files, folders with all `.hyde` files below them, or `-` for standard input
    #[arg(required = true, value_name = "PATH")]
    pub(crate) paths: Vec<PathBuf>,
    /// Write nothing; list the files that are not formatted, and end with status 1 if there are any
    #[arg(long)]
    pub(crate) check: bool,
    /// Write nothing; print what would change
    #[arg(long)]
    pub(crate) diff: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// The code, such as `E0503` [default: list all codes]
    pub(crate) code: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct LiveArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) fmus: FmuProcessArgs,
    /// Port of the page on the loopback interface [default: a free one]
    #[arg(long, default_value_t = 0, hide_default_value = true)]
    pub(crate) port: u16,
}

#[derive(Debug, Args)]
pub(crate) struct LspArgs {
    /// Accepted because some editors add it; the server has no other way
    #[arg(long, hide = true)]
    pub(crate) stdio: bool,
}

/// It has no options; the protocol negotiates everything.
#[derive(Debug, Args)]
pub(crate) struct McpArgs {}
