//! [`operating_point`]: where a model is linearised: where a run comes to, with the modes that are asked for.

use crate::failure::Failure;
use crate::setup::Setup;
use crate::simulation::Simulation;
use hyde_program::{Point, Program};

/// At which instant of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PointTime {
    /// At the start, events and ticks there included.
    #[default]
    Start,
    /// At a time in s, events and ticks there included.
    At(f64),
    /// Where nothing changes any more, or all that does goes on evenly and nothing asks for it. It is looked for in 64 times
    /// the time of the run at most.
    Steady,
}

/// In which modes a model is taken at a point.
#[derive(Clone, Copy, Debug)]
pub enum PointModes<'a> {
    /// In those of the run.
    OfRun,
    /// Automata and modes as given; of the others one that holds a speed is left by its first exit that frees it: friction
    /// slips.
    Sliding(&'a [(usize, usize)]),
}

/// An automaton that is taken in another mode than the run has it in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TakenMode {
    /// The automaton.
    pub automaton: usize,
    /// Its mode in the run.
    pub of_run: usize,
    /// The mode it is taken in.
    pub taken: usize,
    /// Whether it was asked for.
    pub asked: bool,
}

/// Values of everything at a point.
#[derive(Clone, Debug)]
pub struct OperatingPoint {
    /// Time in s.
    pub t: f64,
    /// The solver's vector.
    pub y: Vec<f64>,
    /// Its derivative.
    pub yp: Vec<f64>,
    /// The memory.
    pub z: Vec<f64>,
    /// Record columns, two values each, then the delayed values.
    pub u: Vec<f64>,
    /// The delayed values.
    pub delayed: Vec<f64>,
    /// The parameters, with what initial equations found and what follows from it.
    pub p: Vec<f64>,
    /// Modes that are not those of the run.
    pub modes: Vec<TakenMode>,
    /// The conditions of the surfaces that the run slides on there; it is taken on one side of each.
    pub slides: Vec<String>,
}

impl OperatingPoint {
    /// The model there.
    #[must_use]
    pub fn at(&self) -> Point<'_> {
        Point {
            t: self.t,
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        }
    }
}

/// Values where a run comes to: relations, modes, discrete and held values are those of the run, and consistent with the
/// modes they are taken in.
///
/// # Errors
/// The run does not come there, or there are no consistent values in modes that are asked for.
pub fn operating_point(
    program: &Program,
    setup: &Setup<'_>,
    time: PointTime,
    modes: PointModes<'_>,
) -> Result<OperatingPoint, Box<Failure>> {
    let mut setup = setup.clone();
    if let PointTime::At(t) = time {
        setup.stop_s = t;
    }
    (setup.rows_s, setup.keep) = (Vec::new(), Some(Vec::new()));
    let mut run = Simulation::new(program, &setup)?;
    run.settle_start()?;
    match time {
        PointTime::Start => {}
        PointTime::At(t) => run.advance_to(t)?,
        PointTime::Steady => run.advance_to_steady()?,
    }
    run.point(modes)
}
