//! Experiments.

use super::{Argument, Change, Expr, Measure, Name, Range, Reference, UnitText};
use hyde_diag::Span;

/// `experiment bench(record file) of Axis … end bench;`
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// Its name.
    pub name: Name,
    /// Its records.
    pub records: Vec<RecordItem>,
    /// Its model.
    pub model: Reference,
    /// With these changes.
    pub changes: Vec<Change>,
    /// Its documentation.
    pub doc: Option<String>,
    /// What is in it.
    pub items: Vec<ExperimentItem>,
    /// From the keyword to the end.
    pub span: Span,
}

/// `record file(time = "Timestamp" in [ms]) every 1 [ms] = "records/strokes.csv"`
#[derive(Clone, Debug, PartialEq)]
pub struct RecordItem {
    /// The name in the experiment.
    pub name: Name,
    /// How the file is to be read.
    pub layout: Vec<LayoutSetting>,
    /// The kind of its layout: `layout twincat`.
    pub kind: Option<Name>,
    /// Time between rows, where the record's own time is not to be used.
    pub every: Option<Expr>,
    /// The file used where no other is given, relative to the model's file.
    pub default: Option<Name>,
}

/// `time = "Timestamp" in [ms]`, `time = "cycle" in 125 [us] wraps 65536`, `header = 5`
#[derive(Clone, Debug, PartialEq)]
pub struct LayoutSetting {
    /// What is set.
    pub name: Name,
    /// To what.
    pub value: Name,
    /// The same if it is a number.
    pub number: Option<f64>,
    /// In so many of this unit.
    pub unit: Option<(Option<f64>, UnitText)>,
    /// The number of values after which it begins again.
    pub wraps: Option<f64>,
}

/// `target = value`, of a stimulus or a replay.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// What is driven.
    pub target: Reference,
    /// By what.
    pub value: Expr,
    /// Standard deviation of what its record is not known to.
    pub noise: Option<Expr>,
}

impl Drive {
    /// The target as written, `F[2]`, and the array of which it is an element, `F`; twice the same if it is none.
    #[must_use]
    pub fn names(&self) -> [String; 2] {
        [crate::format_reference(&self.target), self.target.dotted()]
    }

    /// Whether it drives what is named: `F[2]`, or all of `F` or an element of it.
    #[must_use]
    pub fn drives(&self, name: &str) -> bool {
        self.names().iter().any(|own| own == name)
    }
}

/// `file.i = motor.i ~ 0.02 [A]`
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The recorded signal.
    pub signal: Expr,
    /// What the model has for it.
    pub value: Expr,
    /// Standard deviation of its noise.
    pub noise: Option<Expr>,
    /// What it is called in reports.
    pub doc: Option<String>,
}

/// An element of an experiment.
#[derive(Clone, Debug, PartialEq)]
pub enum ExperimentItem {
    /// `stimulus r = file.r;`
    Stimulus(Vec<Drive>),
    /// `measured file.i = motor.i;`
    Measured(Vec<Channel>),
    /// `replay motor.i_ref = file.i_ref;`
    Replay(Vec<Drive>),
    /// `expect max(abs(v)) < 1 [m/s] "doc";`
    Expect(Expr, Option<String>),
    /// `measure Length peak = max(abs(e));`
    Measure(Measure),
    /// `solve ida(rtol = 1e-6)`
    Solve(Name, Vec<Argument>),
    /// `start 0 [s]`
    Start(Expr),
    /// `stop 10 [s]`
    Stop(Expr),
    /// `every 1 [ms]`
    Every(Expr),
    /// `skip 50 [ms]`
    Skip(Expr),
    /// `bode from u to y over 1 .. 50 [Hz] at 0.3 [s] in guide = slip;`
    Bode(Bode),
    /// `margins of cnc.control.i_ref over 1 .. 500 [Hz] at steady in guide = slip;`
    Margins(Margins),
    /// `figure lag = r - s, {guide.a.f, screw.F} in 0.8 [s] .. 1 [s] "the reversal";`
    Figure(Figure),
    /// `budget backlash(gap = 0) "no play", belt(belt.k = 1e9 [N/m]);`
    Budget(Vec<Ideal>),
}

/// `figure lag = r - s, {guide.a.f, screw.F} over time in 0.8 [s] .. 1 [s] "the reversal";`
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Its name, and that of its files.
    pub name: Name,
    /// One panel each: an expression, a list of them, or `circle(x, y, R)`.
    pub panels: Vec<Expr>,
    /// What they are drawn over; time if left out.
    pub over: Option<Expr>,
    /// The times shown.
    pub within: Option<Range>,
    /// Its title.
    pub doc: Option<String>,
}

/// `backlash(gap = 0) "no play"`: a part of the model as it would be without an imperfection.
#[derive(Clone, Debug, PartialEq)]
pub struct Ideal {
    /// What it is called in the budget.
    pub name: Name,
    /// What is changed in the model.
    pub changes: Vec<Change>,
    /// What that means.
    pub doc: Option<String>,
}

/// `bode from u to y over 1 .. 50 [Hz] at 0.3 [s] in guide = slip;`
#[derive(Clone, Debug, PartialEq)]
pub struct Bode {
    /// The driven input.
    pub input: Reference,
    /// The responses.
    pub outputs: Vec<Expr>,
    /// The band of frequencies.
    pub band: Range,
    /// `by stepped(…)`: the name and its arguments.
    pub steps: Option<(Name, Vec<Argument>)>,
    /// About what it is linearised: a time, `start` or `steady`; the start if left out.
    pub at: Option<Expr>,
    /// The modes in which the linearised system is taken: instance and mode.
    pub modes: Vec<(Reference, Name)>,
}

/// `margins of cnc.control.i_ref over 1 .. 500 [Hz] at steady in guide = slip;`
#[derive(Clone, Debug, PartialEq)]
pub struct Margins {
    /// The signals at which the loop is cut, one at a time.
    pub signals: Vec<Reference>,
    /// The band of frequencies that is searched; that of the loop's dynamics if left out.
    pub band: Option<Range>,
    /// About what it is linearised: a time, `start` or `steady`; the start if left out.
    pub at: Option<Expr>,
    /// The modes in which the linearised system is taken: instance and mode.
    pub modes: Vec<(Reference, Name)>,
}
