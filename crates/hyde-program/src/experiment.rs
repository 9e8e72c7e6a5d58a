//! What an experiment asks of a run, as plain data.

use crate::ledger::Ledger;
use hyde_diag::Origin;
use hyde_ir::flat::{Method, Preparation, ReductionKind};
use hyde_units::NamedUnit;

/// A measured channel.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Its name.
    pub name: String,
    /// Record and column.
    pub source: (String, String),
    /// What is done to the column first.
    pub preparation: Vec<Preparation>,
    /// The output that the model has for it.
    pub output: usize,
    /// Compared after the tick rather than before.
    pub clocked: bool,
    /// In the observed form, how much later than the output the column shows it, s, and the parameters that decide that.
    pub late: Option<(f64, Vec<String>)>,
    /// Unit for printing.
    pub unit: NamedUnit,
    /// Where it is written.
    pub origin: Origin,
}

/// A variable that a record takes the place of, in the observed form: a command, if clocked parts put it out.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// Its name.
    pub name: String,
    /// The number of the recorded column among those of the program, if it is one alone.
    pub column: Option<usize>,
    /// The output that the model has for it.
    pub output: usize,
    /// The output that takes its place.
    pub recorded: usize,
    /// The equation `u = pre(w)` that alone decides it, where there is one.
    pub register: Option<Origin>,
    /// Where the replay is written.
    pub origin: Origin,
}

/// A reduction of an output.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// How.
    pub kind: ReductionKind,
    /// As written: `max(abs(e))`.
    pub text: String,
    /// Of which output.
    pub output: usize,
    /// The output that is 1 where the value counts; none where it always does.
    pub condition: Option<usize>,
    /// The outputs that are a - b of each comparison of `a` with `b` in what it reads.
    pub margins: Vec<usize>,
}

/// A measure or expectation; its value is of the same number in [`crate::Kernels::measures`].
#[derive(Clone, Debug)]
pub struct Measure {
    /// Its name, or the expectation as written.
    pub name: String,
    /// Whether it must hold.
    pub expectation: bool,
    /// The reductions that it reads, by number.
    pub reductions: Vec<usize>,
    /// Unit for printing.
    pub unit: NamedUnit,
    /// Where it is written.
    pub origin: Origin,
}

/// A column of a record times a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct ScaledColumn {
    /// The record.
    pub record: String,
    /// The column.
    pub column: String,
    /// The factor, SI.
    pub scale: f64,
}

/// Where a measured frequency response is.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordedResponse {
    /// Real and imaginary part, over frequency.
    Complex(ScaledColumn, ScaledColumn),
    /// Magnitude and phase in rad, over frequency.
    Polar(ScaledColumn, ScaledColumn),
    /// Input and output over time, periodic; and the period in s, to be found in the record without it.
    Periodic(ScaledColumn, ScaledColumn, Option<f64>),
}

/// A measured frequency response.
#[derive(Clone, Debug)]
pub struct MeasuredResponse {
    /// Its name.
    pub name: String,
    /// Where it is.
    pub source: RecordedResponse,
    /// Its standard deviation.
    pub deviation: Option<ScaledColumn>,
    /// The number in [`Experiment::bodes`] of what it is compared with, and of the output there.
    pub place: (usize, usize),
    /// Where it is written.
    pub origin: Origin,
}

/// Where a run is when it is linearised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Moment {
    /// At the start.
    #[default]
    Start,
    /// At a time, which is a [`crate::Constant`].
    At,
    /// At the steady state.
    Steady,
}

/// A frequency response. Its band is a [`crate::Constant`]; without one it is that of what was measured.
#[derive(Clone, Debug)]
pub struct Bode {
    /// Name of the driven input.
    pub input: String,
    /// The output that reports the input's value.
    pub input_output: Option<usize>,
    /// Printed name and output of each response.
    pub outputs: Vec<(String, usize)>,
    /// About what it is linearised.
    pub at: Moment,
    /// Modes of the linearised system: automaton and mode.
    pub modes: Vec<(usize, usize)>,
    /// Measured by stepped sines as well.
    pub stepped: Option<Stepped>,
    /// Where it is written.
    pub origin: Origin,
}

/// A loop that is cut at a signal for its margins: the readers of the signal see it with a test signal added. The band that is
/// searched is a [`crate::Constant`].
#[derive(Clone, Debug)]
pub struct Cut {
    /// The signal, as it is written.
    pub signal: String,
    /// The parameter that is the test signal.
    pub input: String,
    /// The output that reports what comes back: the signal without the test signal; of a clocked signal, with it.
    pub back: usize,
    /// The clock by which the signal is sampled; `None` of a continuous signal.
    pub clock: Option<usize>,
    /// About what it is linearised.
    pub at: Moment,
    /// Modes of the linearised system: automaton and mode.
    pub modes: Vec<(usize, usize)>,
    /// Where it is written.
    pub origin: Origin,
}

/// Something that a figure shows over time.
#[derive(Clone, Debug)]
pub struct Curve {
    /// As it is written.
    pub name: String,
    /// The output.
    pub output: usize,
}

/// What kind of figure.
#[derive(Clone, Debug)]
pub enum FigureKind {
    /// Panels one above the other, over time or over a curve.
    Panels(Vec<Vec<Curve>>, Option<Curve>),
    /// A contour about the origin, x and y, whose deviation from a circle is magnified; the radius is a
    /// [`crate::Constant`].
    Circle([Curve; 2]),
}

/// A figure asked for; the times shown are [`crate::Constant`]s.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Its name, and that of its files.
    pub name: String,
    /// Its title.
    pub title: String,
    /// What it shows.
    pub kind: FigureKind,
}

/// What goes from one component to another where they are connected: a force, a torque, a current.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Flow {
    /// `motor.shaft to belt.a`, or `into belt.a` where more than two connectors meet.
    pub name: String,
    /// The output that goes into the connector named last.
    pub output: usize,
}

/// A response measured by stepped sines: one run a frequency. Its numbers are [`crate::Constant`]s.
///
/// A program that is compiled with a value for its parameter `INPUT.frequency` has the input driven by a sine of that
/// frequency and the amplitude `INPUT.amplitude`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stepped {
    /// The output, by its number in the response, whose amplitude is not to be above a level.
    pub keep: Option<usize>,
}

/// What an experiment asks of a run.
#[derive(Clone, Debug, Default)]
pub struct Experiment {
    /// Its name; empty for a model run as it stands.
    pub name: String,
    /// The records it names.
    pub records: Vec<String>,
    /// Measured channels.
    pub measured: Vec<Measured>,
    /// Variables that a record takes the place of.
    pub replayed: Vec<Replayed>,
    /// Reductions.
    pub reductions: Vec<Reduction>,
    /// Measures and expectations.
    pub measures: Vec<Measure>,
    /// Frequency responses.
    pub bodes: Vec<Bode>,
    /// Where loops are cut for their margins.
    pub cuts: Vec<Cut>,
    /// Free inputs and test signals whose derivative by the time the equations need, and take for zero: no response to
    /// them is known.
    pub differentiated: Vec<String>,
    /// Figures asked for.
    pub figures: Vec<Figure>,
    /// Measured frequency responses.
    pub measured_responses: Vec<MeasuredResponse>,
    /// The energy ledger; empty unless it was asked for.
    pub ledger: Ledger,
    /// The flows of the connections.
    pub flows: Vec<Flow>,
    /// The method asked for.
    pub method: Method,
    /// Whether the tolerance of a step falls over long smooth stretches.
    pub conserve: bool,
}
