//! [`Kernels`]: the numbers of a program.

use crate::program::{PartialEntry, Wrt};
use hyde_ir::dae::Function;
use std::collections::BTreeMap;

/// Where functions are evaluated. Lengths are those of the [`crate::Program`].
#[derive(Clone, Copy, Debug)]
pub struct Point<'a> {
    /// Time in s.
    pub t: f64,
    /// The solver's vector.
    pub y: &'a [f64],
    /// Its derivative.
    pub yp: &'a [f64],
    /// The memory.
    pub z: &'a [f64],
    /// Record columns at this time, two values each, then the delayed values.
    pub u: &'a [f64],
    /// Parameters, complete.
    pub p: &'a [f64],
}

/// Room for what kernels compute on the way; one a thread.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    /// Values of explicit variables, overwritten by every call.
    pub work: Vec<f64>,
    /// What the parts of a long kernel keep for later ones; a kernel makes it as long as it needs.
    pub kept: Vec<f64>,
}

impl Workspace {
    /// Room for `n` explicit variables.
    #[must_use]
    pub fn new(n: usize) -> Self {
        Self {
            work: vec![0.0; n],
            kept: Vec::new(),
        }
    }
}

/// By what a tick is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TickWrt {
    /// The memory before the tick, by position.
    Memory(usize),
    /// An unknown.
    Unknown(usize),
    /// The derivative of an unknown.
    Derivative(usize),
    /// A delayed value, by its number.
    Delayed(usize),
    /// A number of the parameter vector.
    Parameter(usize),
}

/// A number that parameters alone determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constant {
    /// Period of a clock in s.
    Period(usize),
    /// From the tick of a clock to the change of what it holds, in s.
    Delay(usize),
    /// First tick of a clock in s.
    Phase(usize),
    /// How late a delayed value is, by its number, in s.
    Lateness(usize),
    /// Instant of a relation that is scheduled, in s.
    TimeEvent(usize),
    /// How fast the argument of a sine of the time turns, by its number, in rad/s.
    Turning(usize),
    /// Begin of the run in s.
    Start,
    /// End of the run in s.
    Stop,
    /// Time between rows of the results in s.
    Every,
    /// Time from the begin of the run in which measured channels are not compared, in s.
    Skip,
    /// Relative tolerance.
    Rtol,
    /// Absolute tolerance, SI.
    Atol,
    /// Largest step in s.
    MaxStep,
    /// Standard deviation of a measured channel's noise, SI.
    Noise(usize),
    /// Width of the uniform error of a measured channel's quantiser, SI; known in the observed form.
    Rounding(usize),
    /// The period with which a measured channel begins again, SI.
    Wrap(usize),
    /// Lower end of a frequency response in Hz.
    BandFrom(usize),
    /// Upper end of a frequency response in Hz.
    BandTo(usize),
    /// The time at which the system of a frequency response is linearised, in s.
    RespondsAt(usize),
    /// The time at which a loop is linearised, in s.
    CutAt(usize),
    /// Lower end of the band that is searched for a loop's crossovers, in Hz.
    SearchedFrom(usize),
    /// Upper end of that band in Hz.
    SearchedTo(usize),
    /// Amplitude of a stepped response's input, at most.
    Amplitude(usize),
    /// Number of its frequencies.
    Points(usize),
    /// Time in s before anything counts, at each frequency.
    Settle(usize),
    /// Whole periods that count.
    Periods(usize),
    /// What the amplitude of the output that is kept is not to be above.
    Level(usize),
    /// Radius of the circle that a figure shows, in m.
    Radius(usize),
    /// First time that a figure shows, in s.
    ShownFrom(usize),
    /// Last time that a figure shows, in s.
    ShownTo(usize),
}

/// Some values of a function, alone: see [`Kernels::some_rows`].
pub trait SomeRows: Send + Sync {
    /// The values where the model is, in the order in which their rows were asked for.
    fn evaluate(&self, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]);
}

/// What the derivatives of the residual by unknowns and their rates depend on: see [`Kernels::coefficients`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Coefficients {
    /// Rows that are not affine in the unknowns and their rates while modes, truths of relations and parameters stay, or with
    /// a coefficient that time, a record column or another value of the memory changes; ascending.
    pub curved: Vec<usize>,
    /// Positions in the memory of the modes and the truths of relations that coefficients read, ascending.
    pub modes: Vec<usize>,
    /// Positions in the parameter vector that coefficients read, ascending.
    pub parameters: Vec<usize>,
}

/// The numbers of a program.
///
/// `out` is always completely written. Explicit variables lie in the workspace during a call.
pub trait Kernels: Send + Sync {
    /// Fills the whole parameter vector: declared values, those in `set` (position, SI value) replaced, then everything
    /// that is derived from them.
    fn parameters(&self, set: &[(usize, f64)], p: &mut [f64]);

    /// Start values of the solver's vector and the memory.
    fn start(&self, p: &[f64], y: &mut [f64], z: &mut [f64]);

    /// A number that parameters alone determine; `None` if the model does not say.
    fn constant(&self, which: Constant, p: &[f64]) -> Option<f64>;

    /// The values of a function.
    fn evaluate(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    );

    /// Some rows of a function as a kernel of their own, which computes nothing but what they read: for what is evaluated
    /// very often. They are bitwise what [`Kernels::evaluate`] writes there.
    fn some_rows(&self, function: Function, rows: &[usize]) -> Box<dyn SomeRows + '_>;

    /// The rows of the residual that bend, rising. All others are linear in the unknowns and their rates, with coefficients
    /// that nothing but modes and relations changes, and read no time, record column or delayed value.
    fn bending_rows(&self) -> &[usize];

    /// What a matrix of the residual's derivatives by unknowns and their rates depends on, for those who keep one.
    fn coefficients(&self) -> Coefficients;

    /// The places of a function's derivatives, in the order in which [`Kernels::partials`] writes them.
    fn entries(&self, function: Function) -> Vec<PartialEntry>;

    /// Entries of the Jacobian, row and column, that sliding on switching surfaces may take beside the residual's own.
    fn sliding_cells(&self) -> Vec<(usize, usize)> {
        Vec::new()
    }

    /// The derivatives of a function, in the order of [`Kernels::entries`].
    fn partials(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    );

    /// The places of a function's derivatives by what is constant between events, [`crate::Wrt::Parameter`] and
    /// [`crate::Wrt::Memory`], in the order in which [`Kernels::still_partials`] writes them. Every number of the parameter
    /// vector counts on its own, derived ones too.
    fn still_entries(&self, function: Function) -> Vec<PartialEntry>;

    /// The derivatives of a function by parameters and memory, in the order of [`Kernels::still_entries`]. Made when first
    /// asked for.
    fn still_partials(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    );

    /// Some of those derivatives, by their numbers among [`Kernels::still_entries`], as a kernel of their own. They are bitwise
    /// what [`Kernels::still_partials`] writes there.
    fn some_still_partials(&self, function: Function, numbers: &[usize]) -> Box<dyn SomeRows + '_>;

    /// The derivative of the whole parameter vector by each of the `chosen` numbers of it, plain ones. Those are
    /// independent of each other; every other parameter whose value uses them follows.
    fn parameter_directions(&self, chosen: &[usize], p: &[f64]) -> Vec<Vec<f64>>;

    /// Derivatives of the start values by parameters: row (the solver's vector, then the memory), position in `p`, value.
    fn start_partials(&self, p: &[f64]) -> Vec<(usize, usize, f64)>;

    /// Derivatives of an instant ([`Constant::Period`], [`Constant::Delay`], [`Constant::Phase`], [`Constant::TimeEvent`]) by
    /// parameters: position in `p`, value.
    fn instant_partials(&self, which: Constant, p: &[f64]) -> Vec<(usize, f64)>;

    /// The derivatives of a function by `parameters` (positions in `p`, plain ones), those by way of derived ones included,
    /// with their places.
    fn parameter_partials(
        &self,
        function: Function,
        parameters: &[usize],
        at: Point<'_>,
        workspace: &mut Workspace,
    ) -> Vec<(PartialEntry, f64)> {
        let entries = self.still_entries(function);
        let mut values = vec![0.0; entries.len()];
        self.still_partials(function, at, workspace, &mut values);
        let directions = self.parameter_directions(parameters, at.p);
        let mut sums: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for (entry, value) in entries.iter().zip(values) {
            let Wrt::Parameter(place) = entry.wrt else {
                continue;
            };
            for (&parameter, direction) in parameters.iter().zip(&directions) {
                if direction[place] != 0.0 {
                    *sums.entry((entry.row, parameter)).or_default() += value * direction[place];
                }
            }
        }
        let entry = |((row, parameter), value)| {
            let wrt = Wrt::Parameter(parameter);
            (PartialEntry { row, wrt }, value)
        };
        sums.into_iter().map(entry).collect()
    }

    /// Truth (1 or 0) of the condition of every reaction, from the truths in the memory.
    fn conditions(&self, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]);

    /// The memory after a tick of a clock; `after` comes in as a copy of the memory before.
    fn tick(&self, clock: usize, at: Point<'_>, workspace: &mut Workspace, after: &mut [f64]);

    /// Derivatives of what a tick of a clock writes to the memory: position, with respect to what, value. Quantisers count
    /// as the identity (S3).
    fn tick_partials(
        &self,
        clock: usize,
        at: Point<'_>,
        workspace: &mut Workspace,
    ) -> Vec<(usize, TickWrt, f64)>;

    /// Every position in the memory that a tick of a clock writes.
    fn tick_targets(&self, clock: usize) -> Vec<usize>;

    /// Values of the experiment's measures and expectations (1 or 0), from its reductions.
    fn measures(&self, p: &[f64], reductions: &[f64], out: &mut [f64]);
}
