//! One file a command.

pub(crate) mod bode;
pub(crate) mod budget;
pub(crate) mod check;
pub(crate) mod completions;
pub(crate) mod diagnose;
pub(crate) mod doc;
pub(crate) mod effects;
mod effects_check;
pub(crate) mod emit;
pub(crate) mod explain;
pub(crate) mod export;
pub(crate) mod fit;
pub(crate) mod fmt;
pub(crate) mod look;
pub(crate) mod lsp;
pub(crate) mod man;
pub(crate) mod mcp;
pub(crate) mod modes;
pub(crate) mod new;
pub(crate) mod params;
pub(crate) mod plot;
pub(crate) mod report;
pub(crate) mod run;
pub(crate) mod selftest;
pub(crate) mod sweep;
pub(crate) mod test;
pub(crate) mod trend;
