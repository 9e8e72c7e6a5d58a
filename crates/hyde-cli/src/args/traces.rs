//! Arguments of the commands that begin with traces: `hyde look`, `hyde new`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct LookArgs {
    /// Files of traces; settings may follow the name of each: `'log.csv (time = "t" in [ms])'`
    #[arg(required = true)]
    pub(crate) files: Vec<String>,
    /// Write the page `look.html`, with a picture of every channel, to this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct NewArgs {
    /// Name of the package, and of its file
    pub(crate) name: String,
    /// The kind of axis
    #[arg(long, value_enum)]
    pub(crate) template: TemplateName,
    /// Traces that the model is compared with; the last of several is held out. Settings may follow the name of each:
    /// `'log.csv (column = "pos" in [mm])'`
    #[arg(long, value_name = "TRACE", num_args = 1..)]
    pub(crate) from: Vec<String>,
    /// Torque per current: `'0.8 [N.m/A]'`; for a linear motor, force per current: `'78 [N/A]'`
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) constant: Option<String>,
    /// Travel per revolution of the motor: `'10 [mm/rev]'`; for a rotary table, revolutions of the motor per revolution of the table
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) ratio: Option<String>,
    /// Folder of the file [default: the folder of the first trace, or the current folder]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// Kinds of axes.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum TemplateName {
    /// Motor, ball-screw, table
    Screw,
    /// Motor, toothed belt, carriage
    Belt,
    /// Motor, gear, pinion on a rack, table
    Rack,
    /// Linear motor, slide
    Linear,
    /// Motor, worm or gear, rotary table
    Table,
    /// Motor, flexible shaft, load
    Bench,
}
