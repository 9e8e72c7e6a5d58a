//! [`Bode`]: a frequency response that an experiment asks for, [`MeasuredResponse`]: one to compare it with, and [`Cut`]: where it
//! asks for stability margins.

use crate::Quantity;
use crate::id::{AutomatonId, ClockId, ColumnId, ExprId, VarId};
use hyde_diag::Origin;

/// Where a run is when it is linearised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Moment {
    /// At the start.
    #[default]
    Start,
    /// At a time in s, of parameters alone.
    At(ExprId),
    /// At the steady state.
    Steady,
}

impl Moment {
    /// The time, if it is one.
    #[must_use]
    pub fn time(self) -> Option<ExprId> {
        match self {
            Self::At(time) => Some(time),
            Self::Start | Self::Steady => None,
        }
    }
}

/// `bode from input to outputs over f1 .. f2`.
#[derive(Clone, Debug)]
pub struct Bode {
    /// The driven input, and which element of it, from 0.
    pub input: (VarId, usize),
    /// The outputs, with their printed names.
    pub outputs: Vec<(String, ExprId, Quantity)>,
    /// From and to in Hz, of parameters alone; without them it is that of what was measured.
    pub band: Option<(ExprId, ExprId)>,
    /// Measured by stepped sines as well.
    pub stepped: Option<Stepped>,
    /// About what it is linearised.
    pub at: Moment,
    /// Modes of the linearised system: automaton and mode.
    pub modes: Vec<(AutomatonId, usize)>,
    /// Where it is written.
    pub origin: Origin,
}

/// `margins of signal over f1 .. f2`: a loop that is cut at a signal. Readers of the signal see it with a test signal added.
#[derive(Clone, Debug)]
pub struct Cut {
    /// The signal, as it is written.
    pub signal: String,
    /// Name of the parameter that is the test signal.
    pub input: String,
    /// What comes back: the signal without the test signal; of a clocked signal, with it.
    pub back: ExprId,
    /// The clock by which the signal is sampled; `None` of a continuous signal.
    pub clock: Option<ClockId>,
    /// From and to in Hz, of parameters alone.
    pub band: Option<(ExprId, ExprId)>,
    /// About what it is linearised.
    pub at: Moment,
    /// Modes of the linearised system: automaton and mode.
    pub modes: Vec<(AutomatonId, usize)>,
    /// Where it is written.
    pub origin: Origin,
}

/// `by stepped(…)`: one run a frequency, driven by a sine. All of parameters alone.
#[derive(Clone, Debug)]
pub struct Stepped {
    /// Amplitude of the input, at most.
    pub amplitude: ExprId,
    /// Number of frequencies.
    pub points: ExprId,
    /// Time in s before anything counts.
    pub settle: ExprId,
    /// Whole periods that count.
    pub periods: ExprId,
    /// The output, by its number in the response, whose amplitude is not to be above a level.
    pub keep: Option<(usize, ExprId)>,
}

/// A column times a factor, SI.
#[derive(Clone, Copy, Debug)]
pub struct ScaledColumn {
    /// The column.
    pub column: ColumnId,
    /// The factor.
    pub scale: f64,
}

/// Where a measured frequency response is.
#[derive(Clone, Copy, Debug)]
pub enum RecordedResponse {
    /// Real and imaginary part, over frequency.
    Complex(ScaledColumn, ScaledColumn),
    /// Magnitude and phase, over frequency.
    Polar(ScaledColumn, ScaledColumn),
    /// Input and output over time, periodic; and the period in s, to be found in the record without it.
    Periodic(ScaledColumn, ScaledColumn, Option<f64>),
}

/// `measured complex(frf.re, frf.im) = response(u, y) ~ frf.std`.
#[derive(Clone, Debug)]
pub struct MeasuredResponse {
    /// What reports call it.
    pub name: String,
    /// Where it is.
    pub source: RecordedResponse,
    /// Column of its standard deviation.
    pub deviation: Option<ScaledColumn>,
    /// What it is compared with: the number of a `bode`, and of its output.
    pub place: (usize, usize),
    /// Where it is written.
    pub origin: Origin,
}
