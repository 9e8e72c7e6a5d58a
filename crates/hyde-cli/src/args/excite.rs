//! Arguments of `hyde excite`.

use clap::{Args, ValueEnum};
use hyde_study::excitation::{PLACES, SIZE, SPEEDS};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ExciteArgs {
    /// File of a model: all kinds of signals are compared by how closely they determine its parameters
    pub(crate) file: Option<PathBuf>,
    /// Name of the calibration or diagnosis; optional if the file has only one calibration
    pub(crate) study: Option<String>,
    /// The kind of signal; with a model the kinds to compare (repeatable) [default: all]
    #[arg(
        long,
        value_enum,
        value_name = "KIND",
        required_unless_present = "file"
    )]
    pub(crate) signal: Vec<SignalName>,
    /// What makes a signal the best one for the parameters of a model
    #[arg(long, value_enum, default_value_t = Criterion::D, requires = "file")]
    pub(crate) criterion: Criterion,
    /// Choose the signal that best distinguishes these effects: `--between Backlash@nut,Cogging@motor.shaft`
    #[arg(
        long,
        value_name = "EFFECT[@SITE],…",
        value_delimiter = ',',
        requires = "file"
    )]
    pub(crate) between: Vec<String>,
    /// Size of the effects of `--between`, as a part of their range
    #[arg(long, value_name = "PART", default_value_t = SIZE, requires = "between")]
    pub(crate) size: f64,
    /// Set a parameter of the model: `--set saddle.M='320 [kg]'` (repeatable)
    #[arg(long = "set", value_name = "PATH=VALUE [UNIT]", requires = "file")]
    pub(crate) settings: Vec<String>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
    /// Band of a multisine or chirp: `--band '1 .. 100 [Hz]'`
    #[arg(long, value_name = "FROM..TO [Hz]")]
    pub(crate) band: Option<String>,
    /// Length of the record [default: 20 s]
    #[arg(long, value_name = "TIME")]
    pub(crate) duration: Option<String>,
    /// Sampling period [default: 1 ms]
    #[arg(long, value_name = "TIME")]
    pub(crate) every: Option<String>,
    /// Position of the axis before the record; half of the travel must be free on both sides [default: 0]
    #[arg(long, value_name = "VALUE [UNIT]", allow_hyphen_values = true)]
    pub(crate) start: Option<String>,
    /// Number of speeds of jogs, or of sizes of pulses
    #[arg(long, value_name = "N", default_value_t = SPEEDS)]
    pub(crate) speeds: usize,
    /// Number of places of reversals
    #[arg(long, value_name = "N", default_value_t = PLACES)]
    pub(crate) places: usize,
    /// Size of a reversal; it must be larger than the backlash [default: a thousandth of the travel]
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) reversal: Option<String>,
    /// Name of the column [default: `r` of a motion, `u` of an effort; with a model the first one that a stimulus reads]
    #[arg(long, value_name = "NAME")]
    pub(crate) column: Option<String>,
    /// Unit of the column [default: the unit of the first limit]
    #[arg(long, value_name = "UNIT")]
    pub(crate) unit: Option<String>,
    /// Write the signal to this file
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,
    /// Format of the file [default: G-code for `.nc`, `.ngc`, `.mpf` and `.gcode`, CSV for others]
    #[arg(long, value_enum)]
    pub(crate) format: Option<SignalFormat>,
    /// Letter of the axis in G-code
    #[arg(long, value_name = "LETTER", default_value_t = 'X')]
    pub(crate) axis: char,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
    /// Print nothing but errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

/// What must not be exceeded.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct LimitArgs {
    /// Travel from end to end: `--travel '300 [mm]'`, of a rotary axis `'90 [deg]'`
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) travel: Option<String>,
    /// Largest speed: `--speed '200 [mm/s]'`
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) speed: Option<String>,
    /// Largest acceleration: `--acceleration '2 [m/s2]'`
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) acceleration: Option<String>,
    /// Largest jerk: `--jerk '50 [m/s3]'`
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) jerk: Option<String>,
    /// Largest current, force, torque or voltage, for a signal that is not a motion: `--current '10 [A]'`
    #[arg(long, value_name = "VALUE [UNIT]", visible_aliases = ["current", "force", "torque", "voltage"])]
    pub(crate) effort: Option<String>,
}

impl LimitArgs {
    /// Those of a motion: travel, speed, acceleration, jerk.
    pub(crate) fn motion(&self) -> [Option<String>; 4] {
        [&self.travel, &self.speed, &self.acceleration, &self.jerk].map(Clone::clone)
    }
}

/// What makes a signal the best one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Criterion {
    /// The smallest volume of the confidence ellipsoid
    D,
    /// The smallest mean square of the standard deviations
    A,
}

/// A kind of signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SignalName {
    /// Sines at all lines of a band, with phases of low crest factor
    Multisine,
    /// One sine through a band
    Chirp,
    /// Strokes both ways at several speeds, for friction; of a current or force: pulses of several sizes
    Jogs,
    /// Small moves both ways at several places, for backlash
    Reversals,
}

/// A format of set points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SignalFormat {
    /// `t [s]` and the column; `hyde look` and records read it
    Csv,
    /// Position, velocity, acceleration and direction per cycle, for `MC_ExtSetPointGenFeed`
    Twincat,
    /// Blocks for one axis; comments say what the controller changes
    Gcode,
}
