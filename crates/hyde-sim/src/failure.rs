//! [`Failure`]: why a run could not go on, in the words of the model.

use crate::results::Results;
use hyde_diag::Origin;
use hyde_program::Program;

/// The kinds of failures.
#[derive(Clone, Debug, PartialEq)]
pub enum FailureKind {
    /// No consistent initial conditions or values after an event: the unknowns that are open where the equations depend
    /// on each other, and whether this is the start.
    Inconsistent {
        /// The unknowns that no equation determines here; none where the equations have no solution.
        singular: Vec<String>,
        /// At the start of the run.
        at_start: bool,
    },
    /// The solver gave up: its reason.
    Solver(String),
    /// An equation has no finite value.
    NotFinite,
    /// Events follow each other at one instant without end: the conditions involved.
    Chattering(Vec<String>),
    /// Both sides of a switch lead to it, but it cannot slide: its conditions, and why.
    CannotSlide(Vec<String>, &'static str),
    /// The events of a condition follow each other faster and faster: the condition, and the time in s that they add up to.
    Zeno {
        /// The condition, as written.
        cause: String,
        /// The time that its events do not reach.
        sum_s: f64,
    },
    /// Events without number in next to no time.
    TooManyEvents {
        /// Instants with events.
        count: u64,
        /// Within this time in s.
        span_s: f64,
    },
    /// A state jumps as a mode fixes it: its name, its value, and the value it is fixed to.
    Impact(String, f64, f64),
    /// Initial equations that nothing which may yield can meet: the fixed states that stand against them.
    Overdetermined(Vec<String>),
    /// A variable's start value, as given and as the other conditions make it.
    Start(String, f64, f64),
    /// An `assert` does not hold: its message.
    Assert(String),
    /// A record is missing or lacks a column.
    Input(String),
    /// There is no gradient of this run: what it would have to pass.
    NoGradient(String),
    /// No steady state was reached: a state that still changes, and its rate in SI.
    NotSteady(String, f64),
    /// A part that is not equations, an FMU, does not go on.
    Foreign {
        /// Full name of the component.
        component: String,
        /// Its file, as the model names it.
        file: String,
        /// What failed.
        what: String,
        /// What it logged last.
        log: Vec<String>,
    },
    /// It was ended from outside.
    Interrupted,
}

/// An unknown, or the rate of one, in an equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// Name of the unknown.
    pub name: String,
    /// Whether it is its derivative by time.
    pub is_rate: bool,
    /// Its value, SI.
    pub value: f64,
    /// What the left side minus the right side would lose if it were 0, SI.
    pub part: f64,
}

/// Why a run could not go on.
#[derive(Clone, Debug)]
pub struct Failure {
    /// What went wrong.
    pub kind: FailureKind,
    /// Time in s.
    pub t: f64,
    /// The equations involved, the most likely first.
    pub origins: Vec<Origin>,
    /// The unknowns involved, by name, with their values.
    pub unknowns: Vec<(String, f64)>,
    /// The residual of the first of these equations, in SI units of its sides, where it could not be made 0.
    pub residual: Option<f64>,
    /// What stands in that equation, the largest part first.
    pub terms: Vec<Reading>,
    /// Changes of unknowns and rates that together leave the equations as they are, the null space of their Jacobian: name and change, SI,
    /// the largest 1.
    pub null_space: Vec<(String, f64)>,
    /// The automata with the modes they are in, where that matters: name and mode.
    pub modes: Vec<(String, String)>,
    /// Everything up to the failure.
    pub results: Results,
}

impl Failure {
    pub(crate) fn new(kind: FailureKind, t: f64) -> Box<Self> {
        Box::new(Self {
            kind,
            t,
            origins: Vec::new(),
            unknowns: Vec::new(),
            residual: None,
            terms: Vec::new(),
            null_space: Vec::new(),
            modes: Vec::new(),
            results: Results::default(),
        })
    }

    /// Names the equation of a row and the unknown matched to it.
    pub(crate) fn at_row(
        mut self: Box<Self>,
        program: &Program,
        row: usize,
        y: &[f64],
    ) -> Box<Self> {
        if let Some(block) = program.block(row) {
            self.origins.extend(block.origins.iter().cloned());
        }
        self.at_unknown(program, row, y)
    }

    /// Tells the modes the automata are in by the memory.
    pub(crate) fn in_modes(mut self: Box<Self>, program: &Program, z: &[f64]) -> Box<Self> {
        for automaton in &program.automata {
            let number = z.get(automaton.place).copied().unwrap_or(0.0);
            let mode = automaton
                .modes
                .iter()
                .zip(0_u32..)
                .find(|&(_, place)| f64::from(place).total_cmp(&number).is_eq());
            if let Some((mode, _)) = mode {
                self.modes.push((automaton.name.clone(), mode.clone()));
            }
        }
        self
    }

    /// Names an unknown.
    pub(crate) fn at_unknown(
        mut self: Box<Self>,
        program: &Program,
        position: usize,
        y: &[f64],
    ) -> Box<Self> {
        let name = program.unknown_name(position);
        if !self.unknowns.iter().any(|(known, _)| *known == name) {
            self.unknowns
                .push((name, y.get(position).copied().unwrap_or(f64::NAN)));
        }
        self
    }

    pub(crate) fn at_origin(mut self: Box<Self>, origin: &Origin) -> Box<Self> {
        self.origins.push(origin.clone());
        self
    }
}
