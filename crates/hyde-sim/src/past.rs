//! Keeps what is delayed along a run: each step as polynomials, and at an instant the limits on both sides, which arrive
//! later.

use crate::consistent::Consistent;
use crate::delays::{Arrival, Limits};
use crate::failure::Failure;
use crate::history::{PLACES, Step};
use crate::integrator::Integrator;
use crate::root_rates::rates_at;
use hyde_program::Function;

/// Halvings of a step whose polynomials do not meet the quantity.
const MAX_HALVINGS: usize = 8;
/// Where they are compared, as parts of a step.
const BETWEEN: [f64; 2] = [0.15, 0.62];

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
        .map_or_else(|| vec![0.0; count], |(rates, _)| rates);
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
        integrator.state_mut().delays.mark(t, &left, &right);
    }
}

/// Adds the last step, up to `to`, to the histories: in parts where a polynomial does not meet the quantity to a hundredth
/// of the run's tolerance.
pub(crate) fn record(
    integrator: &mut Integrator<'_>,
    consistent: &mut Consistent,
    (from, to): (f64, f64),
) {
    if !integrator.state().delays.is_empty() && to > from {
        record_part((integrator, consistent), (from, to), 0, f64::INFINITY);
        // What lies inside this step is solved for by steps that begin where it does.
        integrator.state_mut().delays.forget(from);
    }
}

fn record_part(
    (integrator, consistent): (&mut Integrator<'_>, &mut Consistent),
    (from, to): (f64, f64),
    depth: usize,
    before: f64,
) {
    // The last point is the end to the last bit.
    let at = |part: f64| to - (1.0 - part) * (to - from);
    let values = PLACES.map(|part| now(integrator, consistent, at(part)));
    let (rtol, atol) = integrator.tolerances();
    let mut error = 0.0_f64;
    for part in BETWEEN {
        for (number, value) in now(integrator, consistent, at(part))
            .into_iter()
            .enumerate()
        {
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
        for half in [(from, middle), (middle, to)] {
            record_part((integrator, consistent), half, depth + 1, error);
        }
    } else {
        integrator.state_mut().delays.keep(from, to, &values);
    }
}

/// The quantities at a time within the last step.
fn now(integrator: &mut Integrator<'_>, consistent: &mut Consistent, t: f64) -> Vec<f64> {
    let mut then = integrator.room(t);
    integrator.solution(consistent, &mut then);
    let state = integrator.state_mut();
    state.values(Function::Delayed, then.at())
}
