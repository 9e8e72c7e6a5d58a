//! Arguments of studies on records: calibrations and diagnoses.

use super::{LimitArgs, ModelArgs};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// A study in a file, with what is set from outside.
#[derive(Clone, Debug, Args)]
pub(crate) struct StudyArgs {
    /// File of the model
    pub(crate) file: PathBuf,
    /// Name of the calibration or diagnosis; optional if the file has only one
    pub(crate) study: Option<String>,
    /// Set a parameter: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]")]
    pub(crate) settings: Vec<String>,
    /// Folder of the records [default: the folder of the model]
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    /// Number of threads [default: all]; the result does not depend on it
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
    /// Profile likelihood of a parameter: fit all others again at values around the calibrated one (repeatable)
    #[arg(long = "profile", value_name = "NAME")]
    pub(crate) profiles: Vec<String>,
    /// Print the correlations of the parameters as a table
    #[arg(long)]
    pub(crate) correlation: bool,
    /// Write fit.json, fit.html, plots and the calibrated model to this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct DiagnoseArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    /// Write the new model, report.json and report.html to this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct SelftestArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,
    /// Seed of all random numbers [default: that of the diagnosis]
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,
    /// Sizes of planted effects: fractions of their ranges, or multiples (`2x`) of the smallest detectable size
    #[arg(
        long,
        value_name = "SIZES",
        value_delimiter = ',',
        default_value = "0.5x,0.05,0.3"
    )]
    pub(crate) sizes: Vec<String>,
    /// Number of random draws for each effect and size
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(crate) seeds: usize,
    /// Number of data sets with no effect planted
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub(crate) empties: usize,
    /// Run only these kinds of cases
    #[arg(long, value_enum, value_delimiter = ',', value_name = "KINDS")]
    pub(crate) only: Vec<CaseKind>,
    /// Plant, or withhold, only these effects; a diagnosis still searches for all, without the one withheld
    #[arg(long, value_delimiter = ',', value_name = "EFFECTS")]
    pub(crate) effects: Vec<String>,
    /// Maximum number of planted cases, chosen evenly from all
    #[arg(long, value_name = "N")]
    pub(crate) sample: Option<usize>,
    /// Write finished cases to this folder; cases already there are not run again
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Only write the simulated records of this case, named as in the report, to the folder of `--out`
    #[arg(
        long,
        value_name = "NAME",
        requires = "out",
        conflicts_with = "designed"
    )]
    pub(crate) case: Option<String>,
    /// Diagnose each planted effect with the verdict `one of` again, with one more record: the signal that best distinguishes
    /// the effects, as `hyde excite` designs it
    #[arg(long)]
    pub(crate) designed: bool,
    /// Length of the designed record [default: 20 s]
    #[arg(long, value_name = "TIME", requires = "designed")]
    pub(crate) duration: Option<String>,
    /// Band of a multisine or chirp of the designed record: `--band '1 .. 100 [Hz]'`
    #[arg(long, value_name = "FROM..TO [Hz]", requires = "designed")]
    pub(crate) band: Option<String>,
    /// Column of the designed record [default: the first one that a stimulus reads in the unit of the limits]
    #[arg(long, value_name = "NAME", requires = "designed")]
    pub(crate) column: Option<String>,
    #[command(flatten, next_help_heading = "Limits of the designed record")]
    pub(crate) limits: LimitArgs,
}

/// What is planted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CaseKind {
    /// Effects
    Planted,
    /// Nothing
    Empty,
    /// Parameters outside their declared range
    Parameters,
    /// Effects that the search does not know
    Unknown,
    /// Faulty sensors
    Sensors,
}

#[derive(Debug, Args)]
pub(crate) struct TrendArgs {
    /// Folders written by `diagnose --out`, the oldest first; names that begin with a date, `2026-03-14`, set the time
    #[arg(required = true)]
    pub(crate) folders: Vec<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}
