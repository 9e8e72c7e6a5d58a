//! The arguments of batches.

use super::FmuProcessArgs;
use clap::{Args, ValueEnum};
use hyde_study::sweep::TableForm;
use std::path::PathBuf;

#[derive(Clone, Debug, Args)]
pub(crate) struct SweepArgs {
    /// File of the model, or the folder of an earlier sweep
    pub(crate) file: PathBuf,
    /// Name of the sweep; optional if the file has only one
    pub(crate) sweep: Option<String>,
    /// Sweep this experiment with the parameters of `--vary` and `--cases`, instead of a sweep of the file
    #[arg(long, value_name = "EXPERIMENT", conflicts_with = "sweep")]
    pub(crate) of: Option<String>,
    /// With `--of`: a varied parameter, written as in a sweep: `--vary 'gap in 5 .. 50 [um]'` (repeatable)
    #[arg(long, value_name = "WHAT", requires = "of", conflicts_with = "sweep")]
    pub(crate) vary: Vec<String>,
    /// With `--of`: sampling plan: `--points 'grid 10'`, `'random 500'`, `'latin 500'`, `'sobol 512'`
    #[arg(long, value_name = "HOW", requires = "of", conflicts_with = "sweep")]
    pub(crate) points: Option<String>,
    /// With `--of`: file of a table with one column per parameter and one row per case
    #[arg(long, value_name = "FILE", requires = "of", conflicts_with = "sweep")]
    pub(crate) cases: Option<String>,
    /// Set a parameter in all cases: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]")]
    pub(crate) settings: Vec<String>,
    /// Set the file of a record of the experiment: `--record file=strokes.csv` (repeatable)
    #[arg(long = "record", value_name = "NAME=PATH")]
    pub(crate) records: Vec<String>,
    /// Folder of the records and of the table of cases [default: the folder of the model]
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) fmus: FmuProcessArgs,
    /// Write the batch to this folder; cases already there are not solved again
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// File format of the data set
    #[arg(long, value_enum, default_value_t = TableFormat::Parquet)]
    pub(crate) format: TableFormat,
    /// Number of cases solved at the same time [default: one per core]
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<usize>,
    /// Seed of the random numbers, instead of that of the sweep
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Keep a variable of every case over time: `saddle.s`, `guide.*` (repeatable)
    #[arg(long, value_name = "NAME")]
    pub(crate) keep: Vec<String>,
    /// Run only this case, like `hyde run`, and write its files to `--out`
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "engine", "keep"])]
    pub(crate) case: Option<usize>,
    /// Solve one part of the cases of a folder: `3/16`, or `auto/16` with the number from the scheduler
    #[arg(long, value_name = "K/N")]
    pub(crate) shard: Option<String>,
    /// Print which of N shards have unsolved cases, as an index list for a scheduler
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "engine", "case"])]
    pub(crate) missing: Option<usize>,
    /// Where the cases are solved
    #[arg(long, value_enum, default_value_t = Engine::Local)]
    pub(crate) engine: Engine,
    /// Number of scheduler jobs that share the cases
    #[arg(long, value_name = "N", default_value_t = 16)]
    pub(crate) shards: usize,
    /// An option for `sbatch`: `--slurm=--partition=long` (repeatable)
    #[arg(long = "slurm", value_name = "OPTION", allow_hyphen_values = true)]
    pub(crate) slurm: Vec<String>,
    /// Print events and the summary as JSON on standard output, one object per line
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Where the cases of a batch are solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// In this process, on all cores
    Local,
    /// On a cluster, as job arrays
    Slurm,
}

/// File format of a data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// `cases.parquet`, with units in the metadata
    Parquet,
    /// `cases.csv`, with a header of `name [unit]` columns
    Csv,
}

impl From<TableFormat> for TableForm {
    fn from(format: TableFormat) -> Self {
        match format {
            TableFormat::Parquet => Self::Parquet,
            TableFormat::Csv => Self::Csv,
        }
    }
}
