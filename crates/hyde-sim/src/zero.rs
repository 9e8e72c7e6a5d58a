//! What counts as the zero of a root function g: how far from 0 its sign says nothing, or not yet.
//!
//! ```text
//! g of                              counts as 0 up to                                           by
//! any relation at an instant        rounding of all that it reads                               rounding
//! a relation that led here          twice the value that it was located with                    is_still_at
//!   located as a guard of states    what it moves in the time to which an instant is known      moved
//!   crossed, and short of 0 here    half of that                                                located_s
//!   in a circle of guards           half of what it moves while rounding of an instant reaches  reach_s
//! a relation after an instant       twice its value there, and the way until it turns           doubt
//! a relation that is followed       many times rounding and the tolerance of the run            followed
//! guards in a circle, at rest       a part of the tolerance of the run                          beneath
//! a surface that is met             moved, and rounding of the states that it reads             of_surface
//! a surface that is slid on         a billionth of the states that it reads                     is_off_surface
//! ```
//! In a step, the sign of g counts beyond the band that `doubt` left ([`guards`](crate::guards)). Where a root function
//! that counts as 0 goes is found in [`root_rates`](crate::root_rates).

use crate::moment::At;
use crate::state::State;
use hyde_program::{Function, Wrt};

/// Rounding of an argument, relative.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;
/// To this an instant is located, relative to the time and absolute in s.
const LOCATED: f64 = 1e-12;
/// So far the rounding of an instant may reach, likewise.
const REACH: f64 = 1e-9;
/// Rounding of a surface, relative to the size of its arguments.
const SURFACE: f64 = 64.0 * f64::EPSILON;
/// A surface is left by an event that takes the root function this far from zero, over the size of its arguments.
const OFF: f64 = 1e-9;
/// How many times rounding, and how many times the tolerance, a root function goes until its relation is located again.
const FAR: f64 = 1e3;
const FAR_OF_TOLERANCE: f64 = 100.0;
/// A part of the tolerance that no result shows.
const BENEATH: f64 = 1e-3;

/// How far from zero rounding of its arguments alone takes each root function: two modes that meet at a point, one with a
/// guard `g > 0` and the other with `g < 0`, must not both see theirs true. A state that has come to zero from afar, as the
/// height of a ball that lies down, is known to rounding of what it was; one that has just left it, to rounding of its
/// tolerance.
pub(crate) fn rounding(state: &mut State<'_>, at: At<'_>, largest: &[f64]) -> Vec<f64> {
    let At { t, y, yp } = at;
    let program = state.program;
    let mut rounding = vec![0.0; program.relations.len()];
    let partials = state.partials(Function::Roots, at);
    let delayed = state.delayed().to_vec();
    let (_, atol) = state.tolerances;
    for (entry, value) in program.partials(Function::Roots).iter().zip(partials) {
        let argument = match entry.wrt {
            Wrt::Unknown(column) if state.differential[column] => {
                let most = largest.get(column).copied().unwrap_or(0.0);
                most.max(y[column].abs()).max(atol)
            }
            Wrt::Unknown(column) => y[column],
            Wrt::Derivative(column) => yp[column],
            Wrt::Delayed(number) => delayed[number],
            Wrt::Time => t,
            Wrt::Parameter(_) | Wrt::Memory(_) => 0.0,
        };
        rounding[entry.row] += ROUNDING * (value * argument).abs();
    }
    rounding
}

/// The time to which an instant is known, in s.
pub(crate) fn located_s(t: f64) -> f64 {
    LOCATED * (1.0 + t.abs())
}

/// How far the rounding of an instant may reach, in s.
pub(crate) fn reach_s(t: f64) -> f64 {
    REACH * (1.0 + t.abs())
}

/// How far what has a rate moves in the time to which an instant is known.
pub(crate) fn moved(rate: f64, t: f64) -> f64 {
    rate.abs() * LOCATED * (1.0 + t.abs())
}

/// Whether a relation is one that led here, and has not moved from there since.
pub(crate) fn is_still_at(located: &[(usize, f64)], relation: usize, root: f64) -> bool {
    let mut located = located.iter();
    located.any(|(other, value)| *other == relation && root.abs() <= 2.0 * value.abs())
}

/// Whether the sign of a root function contradicts a truth.
pub(crate) fn contradicts(root: f64, truth: bool) -> bool {
    root != 0.0 && (root > 0.0) != truth
}

/// How far from zero a relation with this truth says nothing after an instant, where its root function may be so far on the
/// other side before it goes where it goes.
pub(crate) fn doubt(root: f64, truth: bool, detour: f64) -> f64 {
    let band = match contradicts(root, truth) {
        true => 2.0 * root.abs(),
        false => 0.0,
    };
    band + detour
}

/// How far from zero each root function is when its relation is followed no longer.
pub(crate) fn followed(state: &mut State<'_>, at: At<'_>) -> Vec<f64> {
    let rounding = rounding(state, at, &[]);
    let pairs = rounding.into_iter().zip(of_tolerance(state, at));
    pairs
        .map(|(rounding, tolerance)| FAR * rounding + FAR_OF_TOLERANCE * tolerance)
        .collect()
}

/// How far from zero the results of the run do not show a root function.
pub(crate) fn beneath(state: &mut State<'_>, at: At<'_>) -> Vec<f64> {
    let tolerances = of_tolerance(state, at).into_iter();
    tolerances.map(|tolerance| BENEATH * tolerance).collect()
}

/// What the tolerances of the unknowns that it reads amount to, for each root function.
fn of_tolerance(state: &mut State<'_>, at: At<'_>) -> Vec<f64> {
    let (rtol, atol) = state.tolerances;
    let mut found = vec![0.0; state.program.relations.len()];
    let partials = state.partials(Function::Roots, at);
    for (entry, value) in state.program.partials(Function::Roots).iter().zip(partials) {
        if let Wrt::Unknown(column) = entry.wrt {
            let tolerance = rtol * at.y[column].abs() + atol;
            found[entry.row] += (value * tolerance).abs();
        }
    }
    found
}

/// How far from a surface rounding of its arguments, of this size together, may lead.
pub(crate) fn of_surface(size: f64) -> f64 {
    SURFACE * size
}

/// Whether an event has led away from a surface, to this root function.
pub(crate) fn is_off_surface(root: f64, size: f64) -> bool {
    root.abs() > OFF * size
}
