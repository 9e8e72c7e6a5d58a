//! The command line.

mod batch;
mod editor;
mod excite;
mod export;
mod fmus;
mod si;
mod study;
mod traces;

pub(crate) use batch::{Engine, SweepArgs};
pub(crate) use editor::{ExplainArgs, FmtArgs, LiveArgs, LspArgs, McpArgs};
pub(crate) use excite::{Criterion, ExciteArgs, LimitArgs, SignalFormat, SignalName};
pub(crate) use export::{
    CArgs, ExportArgs, ExportKind, FmiVersion, FmuArgs, ModelicaArgs, ReferenceRun, StateSpaceArgs,
};
pub(crate) use fmus::FmuProcessArgs;
pub(crate) use study::{CaseKind, DiagnoseArgs, FitArgs, SelftestArgs, StudyArgs, TrendArgs};
pub(crate) use traces::{LookArgs, NewArgs, TemplateName};

use clap::{Args, Parser, Subcommand, ValueEnum};
use hyde_study::Inputs;
use si::{hertz, seconds};
use std::path::PathBuf;
use std::sync::Arc;

/// Hyde: an equation language and compiler for machine-tool feed drives.
#[derive(Debug, Parser)]
#[command(name = "hyde", version, max_term_width = 100, after_help = AFTER)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const AFTER: &str = "Exit status: 0 success; 1 error in the model or its data; 2 error in the command line, or a \
                     file cannot be written; 3 the solver failed; 4 an `expect` did not hold; 130 interrupted.";

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Check a file or a package without running it: every experiment and sweep, or the last model
    Check(CheckArgs),
    /// Run an experiment, compare it with its records, and check its expectations
    Run(RunArgs),
    /// List the contribution of each imperfection of a model to the measures of an experiment
    Budget(BudgetArgs),
    /// Run the cases of a sweep on all cores or on a cluster; run the command again to resume
    Sweep(SweepArgs),
    /// Print a model after one stage of the compiler
    Emit(EmitArgs),
    /// Plot columns of results or of a record
    Plot(PlotArgs),
    /// Write the HTML page of a batch: influence of inputs on measures, failed cases, notable cases
    Report(ReportArgs),
    /// Compute frequency responses: linearised, and measured on the full model by a sweep or by stepped sines
    Bode(BodeArgs),
    /// List natural frequencies and damping ratios of the linearised model, or find parameters from measured ones
    Modes(ModesArgs),
    /// List the parameters with their values, units, priors and sources
    Params(ParamsArgs),
    /// List the effects of the library and of the file, and the sites of the model where each fits
    Effects(EffectsArgs),
    /// Calibrate a model on records: parameters with confidence intervals, errors before and after
    Fit(FitArgs),
    /// Find the effects that are missing in a model: their sites, sizes and confidence intervals
    Diagnose(DiagnoseArgs),
    /// Measure how reliable a diagnosis is: plant known effects in simulated records and count the correct verdicts
    Selftest(SelftestArgs),
    /// Track effect sizes and parameters across diagnoses
    Trend(TrendArgs),
    /// Run every experiment of a file or a package; check its expectations and that its effects vanish at size 0
    Test(TestArgs),
    /// Show what is in traces: layout, channels, rates, gaps, noise, delays, and the line for a model file
    Look(LookArgs),
    /// Design what to record next within the limits of the axis: multisine, chirp, jogs, reversals
    Excite(ExciteArgs),
    /// Write a first model of an axis, from a trace or from guesses; every line with a guess ends with `// confirm`
    New(NewArgs),
    /// Show an experiment in the browser, run again whenever its file or a slider changes
    Live(LiveArgs),
    /// Format model files: indentation, spaces, line breaks; comments and meaning stay as they are
    Fmt(FmtArgs),
    /// Serve an editor by the Language Server Protocol, on standard input and output
    Lsp(LspArgs),
    /// Serve an assistant by the Model Context Protocol, on standard input and output: tools that give summaries and paths
    Mcp(McpArgs),
    /// Write HTML documentation of a package, of a file, or of the library
    Doc(DocArgs),
    /// Explain a diagnostic code
    Explain(ExplainArgs),
    /// Export a model for other simulation tools
    Export(ExportArgs),
    /// Print the completion script of a shell: `hyde completions bash > ~/.local/share/bash-completion/completions/hyde`
    Completions(CompletionsArgs),
    /// Write the manual pages of all commands: `hyde man --out ~/.local/share/man/man1`
    Man(ManArgs),
    /// Run an FMU for another process, as `--sandbox` asks
    #[command(hide = true)]
    FmuHost,
}

/// A model in a file, with what is set from outside.
#[derive(Clone, Debug, Args)]
pub(crate) struct ModelArgs {
    /// File of the model
    pub(crate) file: PathBuf,
    /// Name of the experiment; optional if the file has only one
    pub(crate) experiment: Option<String>,
    /// Name of the model [default: the model of the experiment, or the last of the file]
    #[arg(long, value_name = "NAME")]
    pub(crate) model: Option<String>,
    /// Set a parameter: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]")]
    pub(crate) settings: Vec<String>,
    /// Set the file of a record of the experiment: `--record file=strokes.csv` (repeatable); settings may follow:
    /// `--record 'file=log.csv (time = "t" in [ms])'`
    #[arg(long = "record", value_name = "NAME=PATH")]
    pub(crate) records: Vec<String>,
    /// Folder of the records [default: the folder of the model]
    #[arg(long, value_name = "DIR")]
    pub(crate) data: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
    /// Each FMU runs in a process of its own: as [`FmuProcessArgs`] of the command say.
    #[arg(skip)]
    pub(crate) sandbox: bool,
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
            sandbox: false,
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
    #[command(flatten)]
    pub(crate) fmus: FmuProcessArgs,
    /// Stop time, in s or with its unit, instead of that of the experiment
    #[arg(
        long,
        value_name = "TIME",
        value_parser = seconds,
        allow_negative_numbers = true
    )]
    pub(crate) stop: Option<f64>,
    /// Relative tolerance, instead of that of the experiment
    #[arg(long)]
    pub(crate) rtol: Option<f64>,
    /// Absolute tolerance in SI units, instead of that of the experiment
    #[arg(long)]
    pub(crate) atol: Option<f64>,
    /// Write results, events.csv, summary.json and report.html to this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// File format of the results
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    pub(crate) format: Format,
    /// Print the energy balance of every component
    #[arg(long)]
    pub(crate) ledger: bool,
    /// Print the force, torque or current of every connection
    #[arg(long)]
    pub(crate) forces: bool,
    /// Add the derivatives of every column with respect to these parameters to the results
    #[arg(long, value_name = "PARAMETERS", value_delimiter = ',')]
    pub(crate) gradient: Vec<String>,
}

impl RunArgs {
    /// A run as its experiment says, that leaves no files.
    pub(crate) fn of_model(model: &ModelArgs) -> Self {
        Self {
            model: model.clone(),
            fmus: FmuProcessArgs::default(),
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
    #[command(flatten)]
    pub(crate) fmus: FmuProcessArgs,
    /// Write budget.csv to this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// File format of results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// `results.csv`, with a header of `name [unit]` columns
    Csv,
    /// `results.parquet`, the same numbers, with units in the metadata
    Parquet,
    /// `results.json`, one list per column
    Json,
    /// `results.mat`, trajectories as Dymola and OpenModelica write them
    Mat,
}

#[derive(Debug, Args)]
pub(crate) struct EmitArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Stage of the compiler
    #[arg(long, value_enum)]
    pub(crate) stage: StageName,
    /// Show only the differences from another model of the file
    #[arg(long, value_name = "MODEL")]
    pub(crate) against: Option<String>,
}

/// A stage of the compiler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum StageName {
    /// The syntax tree, printed as source text
    Ast,
    /// All variables and equations of all instances
    Flat,
    /// The role of each variable, and the order of solution
    Structure,
    /// The complete DAE
    Dae,
    /// Cranelift IR, identical on every machine
    Clif,
    /// Assembly code for this machine
    Asm,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    /// Folder written by `sweep --out`
    pub(crate) folder: PathBuf,
    /// File of the page [default: `report.html` in the folder]
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    /// Results (CSV, Parquet or JSON), a record, a response from `bode --out`, or a folder from `run --out` or
    /// `sweep --out`
    pub(crate) results: PathBuf,
    /// Columns of each panel, separated by commas: `motor.w,screw.w[0]` [default: a selection]
    pub(crate) panels: Vec<String>,
    /// Plot pairs of columns, the first of a pair over the second: `table.y,table.x`
    #[arg(long)]
    pub(crate) xy: bool,
    /// With `--xy`: use the same scale on both axes
    #[arg(long, requires = "xy")]
    pub(crate) equal: bool,
    /// Plot other results in the same panels, dashed (repeatable)
    #[arg(long, value_name = "RESULTS")]
    pub(crate) with: Vec<PathBuf>,
    /// For a batch: plot these cases as lines [default: quantiles over time; lines for up to 8 cases]
    #[arg(long, value_name = "N,…", value_delimiter = ',')]
    pub(crate) cases: Vec<usize>,
    /// Show the modes of these components below the plot: `guide,nut.contact` [default: those that change most]
    #[arg(long, value_name = "NAMES", value_delimiter = ',')]
    pub(crate) modes: Vec<String>,
    /// File of the figure, `.svg` or `.png`
    #[arg(long, value_name = "PATH", default_value = "plot.svg")]
    pub(crate) out: PathBuf,
    /// Title of the figure
    #[arg(long)]
    pub(crate) title: Option<String>,
    /// Width of the figure in mm [default: 169, or 122 with `--xy`]
    #[arg(long, value_name = "MM")]
    pub(crate) width: Option<f64>,
    /// Height of each panel in mm, between its axes
    #[arg(long, value_name = "MM")]
    pub(crate) height: Option<f64>,
    /// Resolution of a PNG in pixels per inch
    #[arg(long, value_name = "N", default_value_t = 300.0)]
    pub(crate) dpi: f64,
    /// Start of the plot, in s or with its unit
    #[arg(
        long,
        value_name = "TIME",
        value_parser = seconds,
        allow_negative_numbers = true
    )]
    pub(crate) from: Option<f64>,
    /// End of the plot, in s or with its unit
    #[arg(
        long,
        value_name = "TIME",
        value_parser = seconds,
        allow_negative_numbers = true
    )]
    pub(crate) to: Option<f64>,
    /// Sampling period, in s or with its unit, of records without a time column
    #[arg(long, value_name = "TIME", value_parser = seconds)]
    pub(crate) every: Option<f64>,
}

/// The operating point of a linearisation.
#[derive(Debug, Args)]
pub(crate) struct AboutArgs {
    /// Operating point: a time of the run, `--at '0.3 [s]'`, or `start`, or `steady`
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub(crate) at: Option<String>,
    /// Linearise with a component in this mode: `--in guide=slip` (repeatable)
    #[arg(long = "in", value_name = "NAME=MODE")]
    pub(crate) in_modes: Vec<String>,
}

#[derive(Debug, Args)]
pub(crate) struct BodeArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) about: AboutArgs,
    /// Write bode.svg, bode.png, bode.csv and the page bode.html to this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Compute only the linearised response; do not run the experiment
    #[arg(long)]
    pub(crate) linear: bool,
    /// Plot the responses of another experiment of the file in the same figures, and list the differences (repeatable)
    #[arg(long, value_name = "EXPERIMENT")]
    pub(crate) with: Vec<String>,
    /// Compute only the stability margins of the experiment, without its responses and its run
    #[arg(long)]
    pub(crate) margins: bool,
    /// Compute the margins of the loop opened at this signal: `--cut cnc.control.i_ref` (repeatable)
    #[arg(long, value_name = "SIGNAL")]
    pub(crate) cut: Vec<String>,
    /// Title of the figures [default: the description of the experiment]
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
    /// Analyse only the plant; outputs of clocked controllers stay constant
    #[arg(long)]
    pub(crate) open: bool,
    /// Also list real poles, which do not oscillate
    #[arg(long)]
    pub(crate) real: bool,
    /// List only modes below this frequency, in Hz or with its unit
    #[arg(long, value_name = "FREQUENCY", value_parser = hertz)]
    pub(crate) below: Option<f64>,
    /// Also list the modes of another experiment of the file (repeatable)
    #[arg(long, value_name = "EXPERIMENT")]
    pub(crate) with: Vec<String>,
    /// List the modes over a range of a parameter: `--over screw.xn='0.1 .. 0.9 [m]'`
    #[arg(long, value_name = "PATH=FROM..TO [UNIT]")]
    pub(crate) over: Option<String>,
    /// Number of values in the range of `--over`
    #[arg(long, default_value_t = 17)]
    pub(crate) points: usize,
    /// Write the page modes.html to this folder; with `--over` also modes.svg, modes.png and modes.csv
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Find parameters from measured natural frequencies and, after a colon, damping ratios: `--measured 34.7,87.8:0.02`
    #[arg(
        long,
        value_name = "HZ[:RATIO],…",
        value_delimiter = ',',
        conflicts_with_all = ["at", "over", "with", "below", "real", "out"]
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
    /// Mode number of each frequency, counted from 1 as in the list of `hyde modes` [default: the nearest, in order]
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
    /// List only parameters without a source
    #[arg(long)]
    pub(crate) unsourced: bool,
}

#[derive(Debug, Args)]
pub(crate) struct EffectsArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    /// Test in the experiments of the file that every effect vanishes as its size goes to 0
    #[arg(long)]
    pub(crate) check: bool,
}

#[derive(Debug, Args)]
pub(crate) struct TestArgs {
    #[command(flatten)]
    pub(crate) model: ModelArgs,
    #[command(flatten)]
    pub(crate) fmus: FmuProcessArgs,
}

#[derive(Debug, Args)]
pub(crate) struct DocArgs {
    /// A file, or a folder with a manifest
    #[arg(required_unless_present = "library")]
    pub(crate) path: Option<PathBuf>,
    /// Document the packages of the library instead
    #[arg(long, conflicts_with = "path")]
    pub(crate) library: bool,
    /// Write the pages to this folder
    #[arg(long, value_name = "DIR", default_value = "doc")]
    pub(crate) out: PathBuf,
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
