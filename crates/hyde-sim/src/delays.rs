//! [`Delays`]: the quantities that the model reads a time ago.
//!
//! No step is longer than the shortest delay, so what a step reads has been accepted before: a known function of the time
//! (the method of steps; Bellen and Zennaro, Numerical Methods for Delay Differential Equations, 2003, ch. 4). What is held
//! between events bounds no step: it is known until the next one, and what an event makes of it arrives later. Where the
//! quantity or its slope jumps, the same arrives later at a known instant, and the run ends a step there. At a jump it
//! starts anew. What a delayed value does to others is seen as theirs, so chains and loops of delays need no rule.

use crate::consistent::Consistent;
use crate::failure::Failure;
use crate::history::{History, PLACES, Step};
use crate::integrator::Integrator;
use crate::root_rates::rates_at;
use crate::setup::same_instant;
use hyde_program::{Function, Program};

/// Halvings of a step whose polynomials do not meet the quantity.
const MAX_HALVINGS: usize = 8;
/// Where they are compared, as parts of a step.
const BETWEEN: [f64; 2] = [0.15, 0.62];

/// The histories of all delayed quantities.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Delays {
    lines: Vec<Line>,
}

#[derive(Clone, serde::Serialize, serde::Deserialize)]
struct Line {
    time_s: f64,
    /// The equations read it: where it jumps they need new consistent values.
    read: bool,
    /// It changes at events alone.
    held: bool,
    history: History,
}

/// Values and slopes of the delayed quantities at an instant, from one side.
pub(crate) struct Limits {
    values: Vec<f64>,
    slopes: Vec<f64>,
}

/// What arrives at an instant.
#[derive(Clone, Copy, Default)]
pub(crate) struct Arrival {
    /// A value jumps.
    pub(crate) jump: bool,
    /// One that the equations read.
    pub(crate) read: bool,
}

impl Delays {
    /// All quantities zero until `t`.
    pub(crate) fn new(program: &Program, t: f64) -> Self {
        let line = |delay: &hyde_program::Delay| Line {
            time_s: delay.time_s,
            read: delay.read,
            held: delay.held,
            history: History::constant(t, 0.0),
        };
        Self {
            lines: program.delays.iter().map(line).collect(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Each quantity had one value until `t`.
    pub(crate) fn set_past(&mut self, t: f64, values: &[f64]) {
        for (line, &value) in self.lines.iter_mut().zip(values) {
            line.history = History::constant(t, value);
        }
    }

    /// The delayed values at a time.
    pub(crate) fn read(&self, t: f64, out: &mut [f64]) {
        for (line, value) in self.lines.iter().zip(out) {
            *value = line.history.value(t - line.time_s);
        }
    }

    /// The longest step.
    pub(crate) fn max_step_s(&self) -> f64 {
        let lines = self.lines.iter().filter(|line| !line.held);
        let times = lines.map(|line| line.time_s);
        times.fold(f64::INFINITY, f64::min)
    }

    /// The next instant at which a jump or a kink arrives.
    pub(crate) fn next(&self) -> f64 {
        let arrivals = self.lines.iter().filter_map(Line::arrival);
        arrivals.fold(f64::INFINITY, f64::min)
    }

    /// Whether one arrives now.
    pub(crate) fn due(&self, t: f64) -> bool {
        let mut arrivals = self.lines.iter().filter_map(Line::arrival);
        arrivals.any(|arrival| arrival <= t || same_instant(arrival, t))
    }

    /// From now on what is read lies behind what arrives now.
    fn arrive(&mut self, t: f64) -> Arrival {
        let mut arrival = Arrival::default();
        for line in &mut self.lines {
            while line
                .arrival()
                .is_some_and(|arrival| arrival <= t || same_instant(arrival, t))
            {
                let jumps = line.history.next_piece();
                arrival.jump |= jumps;
                arrival.read |= jumps && line.read;
            }
        }
        arrival
    }

    fn keep(&mut self, from: f64, to: f64, values: &[Vec<f64>; 7]) {
        for (number, line) in self.lines.iter_mut().enumerate() {
            let values = std::array::from_fn(|place| values[place][number]);
            line.history.push(Step { from, to, values });
            line.history.forget(to - line.time_s);
        }
    }
}

impl Line {
    fn arrival(&self) -> Option<f64> {
        self.history.end().map(|end| end + self.time_s)
    }
}

/// What is delayed, and its slopes, at the instant that has come; without a solver of consistent values it did not change
/// before. `None` without delays.
pub(crate) fn limits(
    integrator: &mut Integrator<'_>,
    consistent: Option<&mut Consistent>,
) -> Option<Limits> {
    let program = integrator.state().program;
    let count = program.delays.len();
    if count == 0 {
        return None;
    }
    let now = integrator.now.clone();
    let state = integrator.state_mut();
    let values = state.values(Function::Delayed, now.at());
    let slopes = consistent
        .and_then(|consistent| rates_at(Function::Delayed, state, consistent, now.at()))
        .map_or_else(|| vec![0.0; count], |(rates, ..)| rates);
    Some(Limits { values, slopes })
}

/// What arrives now of earlier jumps; consistent values follow one that the equations read.
pub(crate) fn arrive(
    integrator: &mut Integrator<'_>,
    consistent: &mut Consistent,
) -> Result<Arrival, Box<Failure>> {
    let t = integrator.now.t;
    let arrival = integrator.state_mut().delays.arrive(t);
    if arrival.read {
        integrator.be_consistent(consistent)?;
    }
    Ok(arrival)
}

/// Keeps in mind what jumps or bends at the instant that has come, to arrive later.
pub(crate) fn mark(
    integrator: &mut Integrator<'_>,
    consistent: &mut Consistent,
    left: Option<Limits>,
) {
    if let (Some(left), Some(right)) = (left, limits(integrator, Some(consistent))) {
        let t = integrator.now.t;
        let lines = &mut integrator.state_mut().delays.lines;
        for (number, line) in lines.iter_mut().enumerate() {
            line.history.mark(
                t,
                (left.values[number], left.slopes[number]),
                (right.values[number], right.slopes[number]),
            );
        }
    }
}

/// Adds the last step, up to `to`, to the histories: in parts where a polynomial does not meet the quantity to a hundredth
/// of the run's tolerance.
pub(crate) fn record(integrator: &mut Integrator<'_>, from: f64, to: f64) {
    if !integrator.state().delays.is_empty() && to > from {
        record_part(integrator, from, to, 0, f64::INFINITY);
    }
}

fn record_part(integrator: &mut Integrator<'_>, from: f64, to: f64, depth: usize, before: f64) {
    // The last point is the end to the last bit.
    let at = |part: f64| to - (1.0 - part) * (to - from);
    let values = PLACES.map(|part| now(integrator, at(part)));
    let (rtol, atol) = integrator.tolerances();
    let mut error = 0.0_f64;
    for part in BETWEEN {
        for (number, value) in now(integrator, at(part)).into_iter().enumerate() {
            let values = std::array::from_fn(|place| values[place][number]);
            let size = values
                .iter()
                .fold(value.abs(), |most, v: &f64| most.max(v.abs()));
            let miss = (Step { from, to, values }.value(at(part)) - value).abs();
            error = error.max(miss / (0.01 * (rtol * size + atol)));
        }
    }
    // What does not fall with the step is rounding, or jumps without an event.
    let middle = at(0.5);
    if error > 1.0 && error < 0.9 * before && depth < MAX_HALVINGS && middle > from && middle < to {
        record_part(integrator, from, middle, depth + 1, error);
        record_part(integrator, middle, to, depth + 1, error);
    } else {
        integrator.state_mut().delays.keep(from, to, &values);
    }
}

/// The quantities at a time within the last step.
fn now(integrator: &mut Integrator<'_>, t: f64) -> Vec<f64> {
    let mut then = integrator.room(t);
    integrator.solution(&mut then);
    let state = integrator.state_mut();
    state.values(Function::Delayed, then.at())
}
