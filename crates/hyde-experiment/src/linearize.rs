//! The system linearised about an operating point, in chosen modes: `x' = A x + B_u u + B_h h`, outputs and samples beside it.
//!
//! With delays there are delayed values d beside the inputs, and what they are the delay of beside the outputs.
//!
//! The states x are those of the solver's vector; its algebraic variables are solved for. Inputs u are the free inputs of
//! the model, h the values that clocks hold. The clocked parts are linearised as they are: what a tick writes depends on
//! the memory before it and on the samples, with quantisers as the identity (S3): [`Sampled`].

use crate::assumptions::{Assumption, assumptions};
use crate::common_period::common_period;
use crate::run::setup_with;
use crate::sampled::{Sampled, sampled};
use hyde_program::{Function, Point, Program, Workspace, Wrt};
use hyde_signal::Table;
use hyde_sim::{Failure, OperatingPoint, PointModes, PointTime, Reached};
use nalgebra::DMatrix;
use std::collections::BTreeMap;
use std::sync::Arc;

/// More unknowns than this are refused: the matrices are dense.
const MAX_UNKNOWNS: usize = 2000;

/// How exactly values at the start are known, relative and absolute: initial equations are solved to this.
const START: (f64, f64) = (1e-9, 1e-11);

/// A linearised system. Rows of `c` and `d` matrices are the program's outputs.
#[derive(Clone, Debug)]
pub struct Linear {
    /// Positions of the states in the solver's vector.
    pub states: Vec<usize>,
    /// States by states.
    pub a: DMatrix<f64>,
    /// States by inputs.
    pub b_input: DMatrix<f64>,
    /// States by held values.
    pub b_held: DMatrix<f64>,
    /// Outputs by states, inputs, held values.
    pub c: DMatrix<f64>,
    /// Outputs by inputs.
    pub d_input: DMatrix<f64>,
    /// Outputs by held values.
    pub d_held: DMatrix<f64>,
    /// The clocked parts, if there are any.
    pub sampled: Option<Sampled>,
    /// The whole solver's vector by states.
    pub unknowns: DMatrix<f64>,
    /// About what it is linearised.
    pub point: OperatingPoint,
    /// The delays, if there are any.
    pub delayed: Option<Delayed>,
    /// What is taken otherwise than it is at the point, or is open there.
    pub assumptions: Vec<Assumption>,
}

/// The linearised delays: `d(t) = now(t - time)` with `now = by_state*x + by_input*u + by_delayed*d`.
#[derive(Clone, Debug)]
pub struct Delayed {
    /// The time of each delay in s.
    pub times: Vec<f64>,
    /// States by delayed values.
    pub b: DMatrix<f64>,
    /// Outputs by delayed values.
    pub d: DMatrix<f64>,
    /// What is delayed, by states.
    pub by_state: DMatrix<f64>,
    /// What is delayed, by inputs.
    pub by_input: DMatrix<f64>,
    /// What is delayed, by delayed values.
    pub by_delayed: DMatrix<f64>,
}

/// Why there is no linearised system.
#[derive(Clone, Debug)]
pub enum LinearizeError {
    /// An input that is not a free input of the model.
    NoInput(String),
    /// Too many unknowns for dense matrices.
    TooLarge(usize),
    /// Clocks whose ticks never come together again, or after thousands of ticks only.
    NoCommonPeriod,
    /// Held values that change more than a period after their tick.
    LongDelay,
    /// A delay beside a clock: between ticks such a plant has no finite state.
    DelayAndClock,
    /// The algebraic variables are not determined at the operating point.
    Singular,
    /// The run begins at the second time in s, behind the operating point that is asked for.
    BeforeStart(f64, f64),
    /// No operating point was found.
    Failed(Box<Failure>),
}

/// Linearises a program that was compiled with free inputs about its start, in the modes given (automaton and mode); of
/// automata not given, one that holds a speed leaves its mode for that of the first exit that frees it: friction slips.
///
/// # Errors
/// See [`LinearizeError`].
pub fn linearize(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
    inputs: &[String],
    modes: &[(usize, usize)],
) -> Result<Linear, LinearizeError> {
    let about = About {
        modes,
        ..About::default()
    };
    linearize_about(program, records, parameters, inputs, about)
}

/// About what a program is linearised, and how much of it.
#[derive(Clone, Copy, Debug, Default)]
pub struct About<'a> {
    /// The instant of the experiment's run.
    pub time: PointTime,
    /// Automata and the modes they are taken in.
    pub modes: &'a [(usize, usize)],
    /// The plant alone: what clocks hold stays as it is.
    pub open: bool,
    /// Where the run to the instant says how far it is.
    pub reached: Option<&'a Arc<Reached>>,
}

/// The same about any point of the experiment's run.
///
/// # Errors
/// See [`LinearizeError`].
pub fn linearize_about(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
    inputs: &[String],
    about: About<'_>,
) -> Result<Linear, LinearizeError> {
    let n = program.n_unknowns;
    if n > MAX_UNKNOWNS {
        return Err(LinearizeError::TooLarge(n));
    }
    let mut places = Vec::new();
    for name in inputs {
        let (parameter, element) = program
            .parameter(name)
            .ok_or_else(|| LinearizeError::NoInput(name.clone()))?;
        places.push(parameter.place + element);
    }
    let mut setup = setup_with(program, records, parameters.to_vec());
    setup.reached = about.reached.cloned().unwrap_or_default();
    if let PointTime::At(t) = about.time
        && t < setup.start_s
    {
        return Err(LinearizeError::BeforeStart(t, setup.start_s));
    }
    let modes = PointModes::Sliding(about.modes);
    let point = hyde_sim::operating_point(program, &setup, about.time, modes)
        .map_err(LinearizeError::Failed)?;
    let tolerances = match about.time {
        PointTime::Start => START,
        PointTime::At(_) | PointTime::Steady => (setup.rtol, setup.atol),
    };
    let assumptions = assumptions(program, &places, &point, tolerances);
    let mut work = Workspace::new(program.n_work);
    let at = point.at();
    let differential = program.differential(&point.z);
    let states: Vec<usize> = (0..n).filter(|&i| differential[i]).collect();
    let algebraic: Vec<usize> = (0..n).filter(|&i| !differential[i]).collect();
    let held: Vec<usize> = program
        .holds
        .iter()
        .flat_map(|hold| hold.target..hold.target + hold.len)
        .collect();

    let residual = Dense::of(program, Function::Residual, at, &mut work, &places, &held);
    // [dF/dx' | dF/dy_a] (x', y_a) = -(dF/dx x + dF/du u + dF/dh h + dF/dd d)
    let mut left = DMatrix::zeros(n, n);
    for (column, &state) in states.iter().enumerate() {
        left.set_column(column, &residual.by_derivative.column(state));
    }
    for (column, &unknown) in algebraic.iter().enumerate() {
        left.set_column(states.len() + column, &residual.by_unknown.column(unknown));
    }
    let (nx, nu, nh, nd) = (states.len(), places.len(), held.len(), program.delays.len());
    let mut right = DMatrix::zeros(n, nx + nu + nh + nd);
    for (column, &state) in states.iter().enumerate() {
        right.set_column(column, &(-residual.by_unknown.column(state)));
    }
    right.columns_mut(nx, nu).copy_from(&-&residual.by_input);
    right
        .columns_mut(nx + nu, nh)
        .copy_from(&-&residual.by_held);
    right
        .columns_mut(nx + nu + nh, nd)
        .copy_from(&-&residual.by_delayed);
    let solved = if n == 0 {
        right
    } else {
        left.lu().solve(&right).ok_or(LinearizeError::Singular)?
    };
    let parts = Parts {
        solved: &solved,
        states: &states,
        algebraic: &algebraic,
        nu,
        nh,
        nd,
    };

    let outputs = Dense::of(program, Function::Outputs, at, &mut work, &places, &held);
    let outputs = parts.through(&outputs);
    let sampled = match about.open {
        true => None,
        false => clocked(program, at, &mut work, &parts, (&places, &held))?,
    };
    let delayed = if nd == 0 {
        None
    } else if sampled.is_some() {
        return Err(LinearizeError::DelayAndClock);
    } else {
        let now = Dense::of(program, Function::Delayed, at, &mut work, &places, &held);
        let now = parts.through(&now);
        Some(Delayed {
            times: program.delays.iter().map(|delay| delay.time_s).collect(),
            b: solved.view((0, nx + nu + nh), (nx, nd)).into_owned(),
            d: outputs.by_delayed,
            by_state: now.by_state,
            by_input: now.by_input,
            by_delayed: now.by_delayed,
        })
    };
    Ok(Linear {
        a: solved.view((0, 0), (nx, nx)).into_owned(),
        b_input: solved.view((0, nx), (nx, nu)).into_owned(),
        b_held: solved.view((0, nx + nu), (nx, nh)).into_owned(),
        c: outputs.by_state,
        d_input: outputs.by_input,
        d_held: outputs.by_held,
        unknowns: parts.unknowns(n),
        states,
        sampled,
        delayed,
        point,
        assumptions,
    })
}

/// The clocked parts, if their clocks have a common period.
fn clocked(
    program: &Program,
    at: Point<'_>,
    work: &mut Workspace,
    parts: &Parts<'_>,
    (inputs, held): (&[usize], &[usize]),
) -> Result<Option<Sampled>, LinearizeError> {
    let Some(found) = sampled(program, at, work, parts, (inputs, held)) else {
        return Ok(None);
    };
    if found.clocks.iter().any(|clock| clock.delay > clock.period) {
        return Err(LinearizeError::LongDelay);
    }
    match common_period(&found.clocks) {
        Some(_) => Ok(Some(found)),
        None => Err(LinearizeError::NoCommonPeriod),
    }
}

/// How the unknowns depend on states, inputs, held and delayed values.
pub(crate) struct Parts<'a> {
    solved: &'a DMatrix<f64>,
    states: &'a [usize],
    algebraic: &'a [usize],
    pub(crate) nu: usize,
    nh: usize,
    pub(crate) nd: usize,
}

/// A function by states, inputs, held and delayed values.
pub(crate) struct Through {
    pub(crate) by_state: DMatrix<f64>,
    pub(crate) by_input: DMatrix<f64>,
    pub(crate) by_held: DMatrix<f64>,
    pub(crate) by_delayed: DMatrix<f64>,
}

impl Parts<'_> {
    /// The whole solver's vector by states.
    fn unknowns(&self, n: usize) -> DMatrix<f64> {
        let nx = self.states.len();
        let mut all = DMatrix::zeros(n, nx);
        for (number, &state) in self.states.iter().enumerate() {
            all[(state, number)] = 1.0;
        }
        for (number, &unknown) in self.algebraic.iter().enumerate() {
            let row = self.solved.view((nx + number, 0), (1, nx));
            all.row_mut(unknown).copy_from(&row);
        }
        all
    }

    /// A function of unknowns and their derivatives, by what these depend on.
    pub(crate) fn through(&self, dense: &Dense) -> Through {
        let (nx, rows) = (self.states.len(), dense.by_unknown.nrows());
        let mut total = DMatrix::zeros(rows, nx + self.nu + self.nh + self.nd);
        for (number, &state) in self.states.iter().enumerate() {
            let mut column = total.column_mut(number);
            column += dense.by_unknown.column(state);
            total += dense.by_derivative.column(state) * self.solved.row(number);
        }
        for (number, &unknown) in self.algebraic.iter().enumerate() {
            total += dense.by_unknown.column(unknown) * self.solved.row(nx + number);
        }
        Through {
            by_state: total.columns(0, nx).into_owned(),
            by_input: total.columns(nx, self.nu) + &dense.by_input,
            by_held: total.columns(nx + self.nu, self.nh) + &dense.by_held,
            by_delayed: total.columns(nx + self.nu + self.nh, self.nd) + &dense.by_delayed,
        }
    }
}

/// The derivatives of a function as dense matrices.
pub(crate) struct Dense {
    pub(crate) by_unknown: DMatrix<f64>,
    pub(crate) by_derivative: DMatrix<f64>,
    pub(crate) by_input: DMatrix<f64>,
    pub(crate) by_held: DMatrix<f64>,
    pub(crate) by_delayed: DMatrix<f64>,
}

impl Dense {
    pub(crate) fn zeros(rows: usize, n: usize, inputs: usize, held: usize, delayed: usize) -> Self {
        Self {
            by_unknown: DMatrix::zeros(rows, n),
            by_derivative: DMatrix::zeros(rows, n),
            by_input: DMatrix::zeros(rows, inputs),
            by_held: DMatrix::zeros(rows, held),
            by_delayed: DMatrix::zeros(rows, delayed),
        }
    }

    pub(crate) fn of(
        program: &Program,
        function: Function,
        at: Point<'_>,
        work: &mut Workspace,
        inputs: &[usize],
        held: &[usize],
    ) -> Self {
        let rows = program.rows(function);
        let delayed = program.delays.len();
        let mut dense = Self::zeros(rows, program.n_unknowns, inputs.len(), held.len(), delayed);
        let entries = program.partials(function);
        let mut values = vec![0.0; entries.len()];
        program.kernels.partials(function, at, work, &mut values);
        for (entry, value) in entries.iter().zip(values) {
            match entry.wrt {
                Wrt::Unknown(column) => dense.by_unknown[(entry.row, column)] += value,
                Wrt::Derivative(column) => dense.by_derivative[(entry.row, column)] += value,
                Wrt::Delayed(column) => dense.by_delayed[(entry.row, column)] += value,
                Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Time => {}
            }
        }
        for (entry, value) in program
            .kernels
            .parameter_partials(function, inputs, at, work)
        {
            if let Wrt::Parameter(place) = entry.wrt
                && let Some(column) = inputs.iter().position(|&input| input == place)
            {
                dense.by_input[(entry.row, column)] += value;
            }
        }
        let entries = program.kernels.still_entries(function);
        let mut values = vec![0.0; entries.len()];
        let kernels = &program.kernels;
        kernels.still_partials(function, at, work, &mut values);
        for (entry, value) in entries.iter().zip(values) {
            if let Wrt::Memory(place) = entry.wrt
                && let Some(column) = held.iter().position(|&held| held == place)
            {
                dense.by_held[(entry.row, column)] += value;
            }
        }
        dense
    }
}
