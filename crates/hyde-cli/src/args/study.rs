//! Arguments of studies on records: calibrations and diagnoses.

use super::ModelArgs;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// A study in a file, with what is set from outside.
#[derive(Clone, Debug, Args)]
pub(crate) struct StudyArgs {
    /// The model's file
    pub(crate) file: PathBuf,
    /// The study; the file's only one of its kind if left out
    pub(crate) study: Option<String>,
    /// Set a parameter: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]")]
    pub(crate) settings: Vec<String>,
    /// Look for the study's records below this folder instead of beside the model
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    /// Number of threads; all there are if left out. The result does not depend on it
    #[arg(long, value_name = "N")]
    pub(crate) jobs: Option<usize>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

impl StudyArgs {
    /// The model's file with what is set.
    pub(crate) fn model_args(&self) -> ModelArgs {
        ModelArgs {
            settings: self.settings.clone(),
            data: self.data.clone(),
            json: self.json,
            quiet: self.quiet,
            ..ModelArgs::of_file(&self.file)
        }
    }

    /// Takes the number of threads asked for.
    pub(crate) fn use_jobs(&self) -> Result<(), String> {
        match self.jobs {
            None => Ok(()),
            Some(0) => Err("`--jobs` must be positive".to_owned()),
            Some(jobs) => rayon::ThreadPoolBuilder::new()
                .num_threads(jobs)
                .build_global()
                .map_err(|error| format!("`--jobs {jobs}`: {error}")),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct FitArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    /// Leave fit.json and the calibrated model in this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct DiagnoseArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    /// Leave the new model, report.json and report.html in this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SelftestArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    /// Seed of all random numbers; the diagnosis's if left out
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Sizes of planted effects: parts of their ranges, or multiples of what shows on this axis
    #[arg(
        long,
        value_name = "SIZES",
        value_delimiter = ',',
        default_value = "0.5x,0.05,0.3"
    )]
    pub(crate) sizes: Vec<String>,
    /// Sets of random numbers for each effect and size
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seeds: usize,
    /// Sets of records with nothing planted
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub(crate) empties: usize,
    /// These kinds of cases alone
    #[arg(long, value_enum, value_delimiter = ',', value_name = "KINDS")]
    pub(crate) only: Vec<CaseKind>,
    /// Plant these effects alone; all are still searched for
    #[arg(long, value_delimiter = ',', value_name = "EFFECTS")]
    pub(crate) effects: Vec<String>,
    /// At most so many planted cases, spread evenly over all
    #[arg(long, value_name = "N")]
    pub(crate) sample: Option<usize>,
    /// Keep finished cases in this folder: what is there is not done again
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Leave the simulated records of this case, as the report calls it, in the folder of `--out`, and do no more
    #[arg(long, value_name = "NAME", requires = "out")]
    pub(crate) case: Option<String>,
}

/// What is planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CaseKind {
    /// Effects
    Planted,
    /// Nothing
    Empty,
    /// Parameters further off than declared
    Parameters,
    /// Effects that the search is not told of
    Unknown,
    /// Faulty sensors
    Sensors,
}

#[derive(Debug, Args)]
pub(crate) struct TrendArgs {
    /// Folders that `diagnose --out` left, the oldest first; names that begin with a date, `2026-03-14`, give the time
    #[arg(required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}
