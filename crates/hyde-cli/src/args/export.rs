//! Arguments of `hyde export`.

use super::si::seconds;
use super::{AboutArgs, ModelArgs};
use clap::{Args, Subcommand, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(subcommand)]
    pub(crate) kind: ExportKind,
}

/// What a model is exported as.
#[derive(Debug, Subcommand)]
pub(crate) enum ExportKind {
    /// Write an FMU for Simulink, OpenModelica, FMPy, OMSimulator and others: co-simulation and model exchange
    Fmu(FmuArgs),
    /// Write the model as one C11 file and header with a fixed step, for controllers and hardware in the loop
    C(CArgs),
    /// Write the model as one flat class of Modelica: equations after index reduction, events, modes, clocks
    Modelica(ModelicaArgs),
    /// Write the linearised model as matrices A, B, C, D with names: for MATLAB, Octave, python-control, or as JSON
    #[command(name = "statespace")]
    StateSpace(StateSpaceArgs),
}

/// How much of an experiment is run for the reference results of an FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReferenceRun {
    /// Nothing: the FMU has no reference results
    None,
    /// Its first 1000 rows; expectations only if that is all of it
    First,
    /// All of it, with its expectations
    Whole,
}

#[derive(Debug, Args)]
pub(crate) struct FmuArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Version of the FMI standard
    #[arg(long, value_enum, default_value_t = FmiVersion::Three)]
    pub(crate) fmi: FmiVersion,
    /// Inputs of the FMU that a stimulus of the experiment drives; the stimulus is left out: `--input r,inject`
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) input: Vec<String>,
    /// Outputs of the FMU: `--output saddle.s,motor.i` [default: the variables of the model itself]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) output: Vec<String>,
    /// Put the source text of the model into the FMU, for people to read
    #[arg(long)]
    pub(crate) with_source: bool,
    /// How much of the experiment to run for reference results in the FMU
    #[arg(long, value_enum, default_value_t = ReferenceRun::First)]
    pub(crate) reference: ReferenceRun,
    /// File of the FMU [default: the model and the experiment, `Axis_positioning.fmu`]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
}

/// A version of the FMI standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum FmiVersion {
    /// FMI 3.0
    #[value(name = "3")]
    Three,
    /// FMI 2.0
    #[value(name = "2")]
    Two,
}

#[derive(Debug, Args)]
pub(crate) struct StateSpaceArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) about: AboutArgs,
    /// Export only the plant, continuous; the held outputs of clocked controllers are inputs
    #[arg(long)]
    pub(crate) open: bool,
    /// Inputs: `--input F,load` [default: every free input of the model]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) input: Vec<String>,
    /// Outputs: `--output saddle.s,motor.i` [default: the variables of the model itself]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) output: Vec<String>,
    /// File; its ending is the format: `.mat` (level 5), `.json`, `.py` (python-control) or `.m` (Octave, MATLAB)
    /// [default: the model and the experiment, `Axis_positioning.mat`]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// The step, in s or with its unit; the periods and delays of all clocks are multiples of it
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub(crate) step: f64,
    /// Inputs that a stimulus of the experiment drives; the stimulus is left out: `--input r,inject`
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) input: Vec<String>,
    /// Outputs: `--output saddle.s,motor.i` [default: the variables of the model itself]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) output: Vec<String>,
    /// Name of the type and the beginning of all public names [default: the model and the experiment]
    #[arg(long, value_name = "NAME")]
    pub(crate) name: Option<String>,
    /// Folder of the two files, `NAME.c` and `NAME.h`
    #[arg(long, value_name = "DIR", default_value = ".")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ModelicaArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Inputs that a stimulus of the experiment drives; the stimulus is left out: `--input r,inject`
    #[arg(long, value_name = "NAME,…", value_delimiter = ',')]
    pub(crate) input: Vec<String>,
    /// File [default: the model and the experiment, `Axis_positioning.mo`]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
}
