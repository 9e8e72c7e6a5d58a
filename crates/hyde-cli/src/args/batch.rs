//! The arguments of batches.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Clone, Debug, Args)]
pub(crate) struct SweepArgs {
    /// The model's file, or the folder that a sweep left
    pub(crate) file: PathBuf,
    /// The sweep; the file's only one if left out
    pub(crate) sweep: Option<String>,
    /// A sweep of this experiment instead of one that the file has: what varies is said by `--vary` and `--cases`
    #[arg(long, value_name = "EXPERIMENT", conflicts_with = "sweep")]
    pub(crate) of: Option<String>,
    /// With `--of`: what varies, as behind the word in a sweep: `--vary 'gap in 5 .. 50 [um]'` (repeatable)
    #[arg(long, value_name = "WHAT", requires = "of")]
    pub(crate) vary: Vec<String>,
    /// With `--of`: how ranges are filled: `--points 'grid 10'`, `'random 500'`, `'latin 500'`, `'sobol 512'`
    #[arg(long, value_name = "HOW", requires = "of")]
    pub(crate) points: Option<String>,
    /// With `--of`: a table with a column for each parameter and a row for each case
    #[arg(long, value_name = "FILE", requires = "of")]
    pub(crate) cases: Option<String>,
    /// Set a parameter of all cases: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]")]
    pub(crate) settings: Vec<String>,
    /// Give a record of the experiment its file: `--record file=strokes.csv` (repeatable)
    #[arg(long = "record", value_name = "NAME=PATH")]
    pub(crate) records: Vec<String>,
    /// Look for records and the table of cases below this folder instead of beside the model
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    /// Keep the batch in this folder: what is there is not solved again
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Form of the data set
    #[arg(long, value_enum, default_value_t = TableFormat::Parquet)]
    pub(crate) format: TableFormat,
    /// Cases solved at once; one a core if left out
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<usize>,
    /// Seed of the random numbers instead of the sweep's
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Keep a variable of every case over time: `saddle.s`, `guide.*` (repeatable)
    #[arg(long, value_name = "NAME")]
    pub(crate) keep: Vec<String>,
    /// Run this case alone, as `hyde run` does; `--out` takes its files
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "engine", "keep"])]
    pub(crate) case: Option<usize>,
    /// Solve one part of the cases of a folder: `3/16`, or `auto/16` with the number from the scheduler
    #[arg(long, value_name = "K/N")]
    pub(crate) shard: Option<String>,
    /// Print the shards of N that have cases missing, as a scheduler takes them
    #[arg(long, value_name = "N", conflicts_with_all = ["shard", "engine", "case"])]
    pub(crate) missing: Option<usize>,
    /// Who solves the cases
    #[arg(long, value_enum, default_value_t = Engine::Local)]
    pub(crate) engine: Engine,
    /// Into how many jobs the cases are split for a scheduler
    #[arg(long, value_name = "N", default_value_t = 16)]
    pub(crate) shards: usize,
    /// An option for `sbatch`: `--slurm=--partition=long` (repeatable)
    #[arg(long = "slurm", value_name = "OPTION", allow_hyphen_values = true)]
    pub(crate) slurm: Vec<String>,
    /// Print events and the summary as JSON on standard output, one object a line
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// Who solves the cases of a batch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// This process, on its cores
    Local,
    /// The cluster, by job arrays
    Slurm,
}

/// Form of a data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum TableFormat {
    /// `cases.parquet`, units in the metadata
    Parquet,
    /// `cases.csv`, a header of `name [unit]` columns
    Csv,
}
