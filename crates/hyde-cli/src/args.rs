//! The command line.

mod batch;
mod study;

pub(crate) use batch::{Engine, SweepArgs, TableFormat};
pub(crate) use study::{CaseKind, DiagnoseArgs, FitArgs, SelftestArgs, StudyArgs, TrendArgs};

use clap::{Args, Parser, Subcommand, ValueEnum};
use hyde_study::Inputs;
use std::path::PathBuf;
use std::sync::Arc;

/// Hyde: feed drives as equations.
#[derive(Debug, Parser)]
#[command(name = "hyde", version, about, max_term_width = 100, after_help = AFTER)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const AFTER: &str = "Exit status: 0 done; 1 the model or its data are at fault; 2 the command line is; 3 the solver \
                     could not go on; 4 an `expect` did not hold; 130 interrupted.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Check a file, or the files of a package: every experiment and sweep, or the last model, without running it
    Check(CheckArgs),
    /// Run an experiment, compare it with its records, and test its expectations
    Run(RunArgs),
    /// Tell what each imperfection of a model contributes to the measures of an experiment
    Budget(BudgetArgs),
    /// Run the variants of a sweep, on all cores or on a cluster; run again to go on where it ended
    Sweep(SweepArgs),
    /// Print what a stage of the compiler makes of a model
    Emit(EmitArgs),
    /// Plot columns of results or of a record
    Plot(PlotArgs),
    /// Make the page of a batch: what its inputs do to its measures, what failed, and which cases to look at
    Report(ReportArgs),
    /// Frequency response: linearised, and as measured on the full model by the experiment's sweep or by stepped sines
    Bode(BodeArgs),
    /// Natural frequencies and dampings of the linearised model, and parameters from measured ones
    Modes(ModesArgs),
    /// List the parameters with their values, units, priors and sources
    Params(ParamsArgs),
    /// List the effects of the library and of the file, and where on the model each fits
    Effects(EffectsArgs),
    /// Calibrate a model on records: parameters with their intervals, errors before and after
    Fit(FitArgs),
    /// Find the effect that a model lacks: which, where, how large, how sure
    Diagnose(DiagnoseArgs),
    /// Plant every known effect in simulated records of this axis, and count what its diagnosis makes of them
    Selftest(SelftestArgs),
    /// How sizes and parameters went from one diagnosis to the next
    Trend(TrendArgs),
    /// Run every experiment of a file or a package, and test what it expects and that its effects vanish
    Test(TestArgs),
    /// Write the pages of a package, of a file, or of the library
    Doc(DocArgs),
    /// Explain a diagnostic code
    Explain(ExplainArgs),
    /// Print the completion script of a shell: `hyde completions bash > ~/.local/share/bash-completion/completions/hyde`
    Completions(CompletionsArgs),
    /// Write the manual pages of all commands: `hyde man --out ~/.local/share/man/man1`
    Man(ManArgs),
}

/// A model in a file, with what is set from outside.
#[derive(Clone, Debug, Args)]
pub(crate) struct ModelArgs {
    /// The model's file
    pub(crate) file: PathBuf,
    /// The experiment; the file's only one if left out
    pub(crate) experiment: Option<String>,
    /// The model; that of the experiment, or the last of the file, if left out
    #[arg(long, value_name = "NAME")]
    pub(crate) model: Option<String>,
    /// Set a parameter: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]")]
    pub(crate) settings: Vec<String>,
    /// Give a record of the experiment its file: `--record file=strokes.csv` (repeatable)
    #[arg(long = "record", value_name = "NAME=PATH")]
    pub(crate) records: Vec<String>,
    /// Look for the experiment's records below this folder instead of beside the model
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
    /// Every package of the library is known, named or not.
    #[arg(skip)]
    pub(crate) whole_library: bool,
    /// The files of the model where they are kept track of, or are not those of the disk.
    #[arg(skip)]
    pub(crate) inputs: Option<Arc<Inputs>>,
}

impl ModelArgs {
    /// A file with nothing set from outside.
    pub(crate) fn of_file(file: &std::path::Path) -> Self {
        Self {
            file: file.to_path_buf(),
            experiment: None,
            model: None,
            settings: Vec::new(),
            records: Vec::new(),
            data: None,
            json: false,
            quiet: false,
            whole_library: false,
            inputs: None,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
}

#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Stop at this time in s instead of the experiment's
    #[arg(long, value_name = "SECONDS")]
    pub(crate) stop: Option<f64>,
    /// Relative tolerance instead of the experiment's
    #[arg(long)]
    pub(crate) rtol: Option<f64>,
    /// Absolute tolerance in SI instead of the experiment's
    #[arg(long)]
    pub(crate) atol: Option<f64>,
    /// Leave results, events.csv, summary.json and report.html in this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Form of the results
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    pub(crate) format: Format,
    /// Tell where every joule came from and where it went
    #[arg(long)]
    pub(crate) ledger: bool,
    /// Tell the force, torque or current of every connection
    #[arg(long)]
    pub(crate) forces: bool,
    /// Leave the derivatives of every column by these parameters beside it
    #[arg(long, value_name = "PARAMETERS", value_delimiter = ',')]
    pub(crate) gradient: Vec<String>,
}

impl RunArgs {
    /// A run as its experiment says, that leaves no files.
    pub(crate) fn of_model(model: &ModelArgs) -> Self {
        Self {
            model: model.clone(),
            stop: None,
            rtol: None,
            atol: None,
            out: None,
            format: Format::Csv,
            ledger: false,
            forces: false,
            gradient: Vec::new(),
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct BudgetArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Leave budget.csv in this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// Form of results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// `results.csv`, a header of `name [unit]` columns
    Csv,
    /// `results.parquet`, the same numbers with the units in the metadata
    Parquet,
    /// `results.json`, one list a column
    Json,
}

#[derive(Debug, Args)]
pub(crate) struct EmitArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// The stage
    #[arg(long, value_enum)]
    pub(crate) stage: StageName,
    /// Show only the lines in which it differs from that of another model of the file
    #[arg(long, value_name = "MODEL")]
    pub(crate) against: Option<String>,
}

/// A stage of the compiler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StageName {
    /// The tree, as source text
    Ast,
    /// Every variable and equation of every instance
    Flat,
    /// What became of every variable, and the order of solution
    Structure,
    /// The system in full
    Dae,
    /// Cranelift IR, the same on every machine
    Clif,
    /// Assembly of this machine
    Asm,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// The folder that `sweep --out` left
    pub(crate) folder: PathBuf,
    /// The page's file; `report.html` in the folder if left out
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// A CSV, Parquet or JSON file of results, a record, a response that `bode --out` left, or a folder of `run
    /// --out` or `sweep --out`
    pub(crate) results: PathBuf,
    /// The columns of each panel, separated by commas: `motor.w,screw.w[0]`; a choice if left out
    pub(crate) panels: Vec<String>,
    /// The columns of each panel are pairs, the first over the second: `table.y,table.x`
    #[arg(long)]
    pub(crate) xy: bool,
    /// With `--xy`: both axes in one scale
    #[arg(long, requires = "xy")]
    pub(crate) equal: bool,
    /// Other results in the same panels, dashed (repeatable)
    #[arg(long, value_name = "RESULTS")]
    pub(crate) with: Vec<PathBuf>,
    /// Of a batch these cases, each a line; if left out all as quantiles over time, up to 8 as lines
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    pub(crate) cases: Vec<usize>,
    /// Whose modes stand below, separated by commas: `guide,nut.contact`; those that change most if left out
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) modes: Vec<String>,
    /// The figure's file, `.svg` or `.png`
    #[arg(long, value_name = "PATH", default_value = "plot.svg")]
    pub(crate) out: PathBuf,
    /// Title of the figure
    #[arg(long)]
    pub(crate) title: Option<String>,
    /// Width of the figure in mm; 169, or 122 with `--xy`, if left out
    #[arg(long, value_name = "MM")]
    pub(crate) width: Option<f64>,
    /// Height of each panel between its axes in mm
    #[arg(long, value_name = "MM")]
    pub(crate) height: Option<f64>,
    /// Pixels to the inch of a PNG
    #[arg(long, value_name = "N", default_value_t = 300.0)]
    pub(crate) dpi: f64,
    /// Only from this time in s
    #[arg(long, value_name = "SECONDS")]
    pub(crate) from: Option<f64>,
    /// Only to this time in s
    #[arg(long, value_name = "SECONDS")]
    pub(crate) to: Option<f64>,
    /// The records have no time column: time between their rows in s
    #[arg(long, value_name = "SECONDS")]
    pub(crate) every: Option<f64>,
}

/// About what a model is linearised.
#[derive(Debug, Args)]
pub(crate) struct AboutArgs {
    /// Linearise where the run is at a time, `--at '0.3 [s]'`, at `start`, or at the `steady` state
    #[arg(long, value_name = "TIME")]
    pub(crate) at: Option<String>,
    /// Take an automaton in a mode: `--in guide=slip` (repeatable)
    #[arg(long = "in", value_name = "NAME=MODE")]
    pub(crate) in_modes: Vec<String>,
}

#[derive(Debug, Args)]
pub(crate) struct BodeArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) about: AboutArgs,
    /// Leave bode.svg, bode.png, bode.csv and the page bode.html in this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// The linearised response only: do not run the experiment
    #[arg(long)]
    pub(crate) linear: bool,
    /// Draw the responses of another experiment of the file in the same figures, and tell where they part (repeatable)
    #[arg(long, value_name = "EXPERIMENT")]
    pub(crate) with: Vec<String>,
    /// The stability margins that the experiment asks for alone, without its responses and its run
    #[arg(long)]
    pub(crate) margins: bool,
    /// The margins of the loop cut at a signal: `--cut cnc.control.i_ref` (repeatable)
    #[arg(long, value_name = "SIGNAL")]
    pub(crate) cut: Vec<String>,
    /// Title of the figures instead of what the experiment says of itself
    #[arg(long)]
    pub(crate) title: Option<String>,
    /// Number of frequencies of the linearised response
    #[arg(long, default_value_t = 400)]
    pub(crate) points: usize,
}

#[derive(Debug, Args)]
pub(crate) struct ModesArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) about: AboutArgs,
    /// The plant alone: what clocks hold stays as it is
    #[arg(long)]
    pub(crate) open: bool,
    /// List the poles that do not oscillate as well
    #[arg(long)]
    pub(crate) real: bool,
    /// Only below this frequency in Hz
    #[arg(long, value_name = "HZ")]
    pub(crate) below: Option<f64>,
    /// Put those of another experiment of the file beside them (repeatable)
    #[arg(long, value_name = "EXPERIMENT")]
    pub(crate) with: Vec<String>,
    /// Over a parameter: `--over screw.xn='0.1 .. 0.9 [m]'`
    #[arg(long, value_name = "PATH=FROM..TO [UNIT]")]
    pub(crate) over: Option<String>,
    /// Number of its values
    #[arg(long, default_value_t = 17)]
    pub(crate) points: usize,
    /// Leave the page modes.html in this folder; with `--over` modes.svg, modes.png and modes.csv as well
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Find parameters from measured natural frequencies: `--measured 34.7,87.8:0.02`, damping ratios behind a colon
    #[arg(
        long,
        value_name = "HZ[:RATIO],…",
        value_delimiter = ',',
        conflicts_with = "at"
    )]
    pub(crate) measured: Vec<String>,
    /// The parameters to find: `--vary belt.k,screw.contact.k`
    #[arg(
        long,
        value_name = "PATH,…",
        value_delimiter = ',',
        requires = "measured"
    )]
    pub(crate) vary: Vec<String>,
    /// The number of the mode of each frequency, from 1 as `hyde modes` lists them; by order and nearness if left out
    #[arg(
        long,
        value_name = "NUMBER,…",
        value_delimiter = ',',
        requires = "measured"
    )]
    pub(crate) pair: Vec<usize>,
    /// Standard deviation of the measured frequencies in percent
    #[arg(
        long,
        value_name = "PERCENT",
        default_value_t = 1.0,
        requires = "measured"
    )]
    pub(crate) spread: f64,
    /// Standard deviation of the measured damping ratios in percent
    #[arg(
        long,
        value_name = "PERCENT",
        default_value_t = 20.0,
        requires = "measured"
    )]
    pub(crate) damping_spread: f64,
}

#[derive(Debug, Args)]
pub(crate) struct ParamsArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Only those without a source
    #[arg(long)]
    pub(crate) unsourced: bool,
}

#[derive(Debug, Args)]
pub(crate) struct EffectsArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Run the limit test of every size in the file's experiments: an effect has to vanish with its size
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TestArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
}

#[derive(Debug, Args)]
pub(crate) struct DocArgs {
    /// A file, or a folder with a manifest
    #[arg(required_unless_present = "library")]
    pub(crate) path: Option<PathBuf>,
    /// The packages of the library instead
    #[arg(long, conflicts_with = "path")]
    pub(crate) library: bool,
    /// Leave the pages in this folder
    #[arg(long, value_name = "DIR", default_value = "doc")]
    pub(crate) out: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct ExplainArgs {
    /// The code, `E0503`; all codes if left out
    pub(crate) code: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct CompletionsArgs {
    /// The shell
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManArgs {
    /// Write the pages into this folder
    #[arg(long, value_name = "DIR", default_value = "man1")]
    pub(crate) out: PathBuf,
}
