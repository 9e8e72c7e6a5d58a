//! Arguments of `hyde excite`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct ExciteArgs {
    /// The kind of signal
    #[arg(long, value_enum, value_name = "KIND")]
    pub(crate) signal: SignalName,
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
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub(crate) speeds: usize,
    /// Number of places of reversals
    #[arg(long, value_name = "N", default_value_t = 3)]
    pub(crate) places: usize,
    /// Size of a reversal; it must be larger than the backlash [default: a thousandth of the travel]
    #[arg(long, value_name = "VALUE [UNIT]")]
    pub(crate) reversal: Option<String>,
    /// Name of the column [default: `r` of a motion, `u` of an effort]
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
    #[arg(long, value_name = "VALUE [UNIT]", conflicts_with = "effort")]
    pub(crate) travel: Option<String>,
    /// Largest speed: `--speed '200 [mm/s]'`
    #[arg(long, value_name = "VALUE [UNIT]", conflicts_with = "effort")]
    pub(crate) speed: Option<String>,
    /// Largest acceleration: `--acceleration '2 [m/s2]'`
    #[arg(long, value_name = "VALUE [UNIT]", conflicts_with = "effort")]
    pub(crate) acceleration: Option<String>,
    /// Largest jerk: `--jerk '50 [m/s3]'`
    #[arg(long, value_name = "VALUE [UNIT]", conflicts_with = "effort")]
    pub(crate) jerk: Option<String>,
    /// Largest current, force, torque or voltage, for a signal that is not a motion: `--current '10 [A]'`
    #[arg(long, value_name = "VALUE [UNIT]", visible_aliases = ["current", "force", "torque", "voltage"])]
    pub(crate) effort: Option<String>,
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
