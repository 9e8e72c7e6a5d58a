//! [`Results`]: rows over time, the event log, and what the solver did.

use hyde_diag::Origin;
use hyde_program::{Firmness, Method};
use hyde_signal::Series;
use std::borrow::Cow;
use std::fmt;

/// What happened.
#[derive(Clone, Debug, PartialEq)]
pub enum EventKind {
    /// A mode was left for another.
    Transition {
        /// The automaton.
        automaton: usize,
        /// The mode before.
        from: usize,
        /// The mode after.
        to: usize,
    },
    /// A `when` condition became true.
    When,
    /// A relation in the equations changed its truth to this.
    Relation(bool),
    /// Sliding on a switching surface begins or ends.
    Slide {
        /// The automaton whose modes switch there; none for a relation in the equations.
        automaton: Option<usize>,
        /// The mode, or the truth as a number, before; none where sliding ends.
        before: Option<usize>,
        /// The same after; none where sliding begins.
        after: Option<usize>,
    },
}

/// An entry of the event log.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// Time in s.
    pub t: f64,
    /// What happened.
    pub kind: EventKind,
    /// The condition, as written.
    pub cause: String,
    /// Where it is written.
    pub origin: Origin,
}

/// Where `esdirk` took over from `ida`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeftIda {
    /// The time in the run, in s.
    pub at_s: f64,
    /// The reason.
    pub why: WhyLeft,
}

/// Why `ida` could not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WhyLeft {
    /// Half of its steps failed the error test.
    Creeps,
    /// No step was short enough for its iteration or its error test.
    Stuck,
}

impl fmt::Display for WhyLeft {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            Self::Creeps => "half of the steps of ida failed the error test",
            Self::Stuck => "no step was short enough for ida",
        })
    }
}

/// What the solver did.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Statistics {
    /// The method that was taken.
    pub method: Method,
    /// When and why `esdirk` took over from `ida`.
    pub left_ida: Option<LeftIda>,
    /// Accepted steps.
    pub steps: u64,
    /// Evaluations of the residual by the solver.
    pub residual_evaluations: u64,
    /// Evaluations of the Jacobian by the solver.
    pub jacobian_evaluations: u64,
    /// Newton iterations.
    pub nonlinear_iterations: u64,
    /// Steps repeated for their error.
    pub error_test_failures: u64,
    /// Steps repeated for Newton's method.
    pub nonlinear_failures: u64,
    /// Restarts at events.
    pub restarts: u64,
    /// Instants at which something other than a tick happened.
    pub events: u64,
    /// Ticks of clocks.
    pub ticks: u64,
}

/// A state or a parameter that initial equations determine.
#[derive(Clone, Debug, PartialEq)]
pub struct Yielded {
    /// Its name.
    pub name: String,
    /// How firm its start value was.
    pub firmness: Firmness,
    /// Its start value, SI.
    pub start: f64,
    /// What was found, SI.
    pub value: f64,
    /// Whether an equation determines it; a parameter that is to be found keeps its guess if none does.
    pub determined: bool,
}

/// What the energy ledger adds up, in J.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Energies {
    /// What entered through each port.
    pub received: Vec<f64>,
    /// Of each account the change of a stored energy between events, or the energy of a power.
    pub accounts: Vec<f64>,
    /// What a stored energy jumped by at events.
    pub jumps: Vec<f64>,
    /// What went through all ports, and what stored energies jumped by, without regard to sign.
    pub passed: f64,
}

/// What a signal over a run is as one number.
#[derive(Clone, Debug, PartialEq)]
pub enum Reduced {
    /// The number, SI.
    Value(f64),
    /// There is none: the condition never holds, or a signal that does not change has no resonance.
    Nothing,
    /// The signal has no value.
    NotANumber {
        /// When first, in s.
        t: f64,
        /// The variable that has none.
        variable: String,
    },
}

/// Why a gradient goes no further than to an instant.
#[derive(Clone, Debug, PartialEq)]
pub enum GradientEndKind {
    /// A root function touches zero there and hardly crosses it: the crossing comes or goes with the least change.
    Grazing,
    /// The run slides on a surface from there.
    Sliding,
    /// The linearised equations determine nothing there.
    Singular,
}

/// From when on there is no gradient.
#[derive(Clone, Debug, PartialEq)]
pub struct GradientEnd {
    /// Time in s.
    pub t: f64,
    /// Why.
    pub kind: GradientEndKind,
    /// The condition, as written.
    pub cause: String,
    /// Where it is written.
    pub origin: Option<Origin>,
}

/// The derivatives of the rows by parameters (S1), each row at its time: those of an event do not move with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gradient {
    /// Positions of the parameters in the parameter vector.
    pub parameters: Vec<usize>,
    /// For each parameter one column an output kept, SI; not a number behind its end.
    pub columns: Vec<Vec<Vec<f64>>>,
    /// From when on it is not known.
    pub end: Option<GradientEnd>,
}

/// Contradictions that are kept.
pub(crate) const MOST_CONTRADICTIONS: usize = 3;

/// Two reactions that gave one variable different values at an instant: the second one counts.
#[derive(Clone, Debug, PartialEq)]
pub struct Contradiction {
    /// The instant, s.
    pub t: f64,
    /// The conditions of both, as written.
    pub causes: [String; 2],
    /// The values that they gave, SI.
    pub values: [f64; 2],
}

/// What a run leaves.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// Numbers of the outputs kept, ascending.
    pub outputs: Vec<usize>,
    /// Times of the rows in s; an instant with an event has two rows, the left and the right limit.
    pub time: Vec<f64>,
    /// The column of each output kept: outputs with the same value share one.
    pub places: Vec<usize>,
    /// The columns, SI.
    pub columns: Vec<Series>,
    /// The derivatives by parameters, if they were asked for.
    pub gradient: Option<Gradient>,
    /// The event log.
    pub events: Vec<Event>,
    /// Where events gave a variable two values at once, the first few.
    pub contradictions: Vec<Contradiction>,
    /// What the solver did.
    pub statistics: Statistics,
    /// What initial equations determined at the start.
    pub yielded: Vec<Yielded>,
    /// The parameter vector, with what initial equations found.
    pub parameters: Vec<f64>,
    /// Surfaces that the run slid on, by the condition that is zero there, and the time it did in s.
    pub sliding: Vec<(String, f64)>,
    /// Time each automaton spent in each mode, in s; while it slides between two, each has its share.
    pub mode_times: Vec<Vec<f64>>,
    /// What was asked for as one number, in that order.
    pub reductions: Vec<Reduced>,
    /// The sums of the energy ledger, if it was asked for.
    pub energies: Option<Energies>,
    /// Final solver's vector and memory.
    pub last: (Vec<f64>, Vec<f64>),
}

impl Results {
    /// The column of an output; `None` if it was not kept.
    #[must_use]
    pub fn column(&self, output: usize) -> Option<Cow<'_, [f64]>> {
        self.series(output).map(Series::values)
    }

    /// The same without making its values; `None` if it was not kept.
    #[must_use]
    pub fn series(&self, output: usize) -> Option<&Series> {
        let at = self.outputs.binary_search(&output).ok()?;
        Some(&self.columns[self.places[at]])
    }

    /// The outputs kept, each with its column.
    pub fn kept(&self) -> impl Iterator<Item = (usize, &Series)> {
        let columns = self.places.iter().map(|&place| &self.columns[place]);
        self.outputs.iter().copied().zip(columns)
    }

    /// The rows of an instant: the left limit and the right one (the same row where nothing happened).
    #[must_use]
    pub fn rows_at(&self, t: f64) -> Option<(usize, usize)> {
        let near = |other: f64| crate::setup::same_instant(t, other);
        let first = self.time.partition_point(|&time| time < t && !near(time));
        let last = self
            .time
            .partition_point(|&time| time <= t || near(time))
            .checked_sub(1)?;
        (first <= last && near(self.time[first])).then_some((first, last))
    }
}
