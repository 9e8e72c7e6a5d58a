//! The first step after a start or an event: as long as the curvature of the solution allows.
//!
//! And it must not step over what has just begun: where a root function leaves zero and turns back, as the height of a ball
//! does, it returns after 2|g'/g''|, in a flight that may be lower than the tolerance.

use crate::active::is_active;
use crate::consistent::{Consistent, Flow};
use crate::integrator::Integrator;
use crate::moment::At;
use crate::norms::mean_over_tolerances;
use crate::setup::Setup;
use crate::solver::FirstStep;
use crate::state::State;
use crate::zero::{ROUNDING, located_s};
use hyde_program::{Function, Wrt};

/// The part of the way back to zero that the first step may be.
const PART_OF_RETURN: f64 = 0.02;

/// The first step from consistent values. The algebraic variables get their slopes along the flow, which the
/// solver's first guess of them follows.
pub(crate) fn first_step(
    integrator: &mut Integrator<'_>,
    consistent: &mut Consistent,
    setup: &Setup<'_>,
) -> FirstStep {
    let t = integrator.now.t;
    let span = (setup.stop_s - t).max(1e-12);
    let (state, at) = integrator.state_now();
    let (mut by_curvature_s, mut longest_s) = (1e-2 * span, f64::INFINITY);
    if let Some(flow) = consistent.flow(state, at) {
        // The first step is of order 1: its error is half the square of the step times the second derivative.
        let norm = mean_over_tolerances(&flow.dyp, at.y, (setup.rtol, setup.atol));
        if norm.is_finite() && norm > 0.0 {
            by_curvature_s = by_curvature_s.min((0.5 / norm).sqrt());
        }
        longest_s = PART_OF_RETURN * shortest_return(state, at, flow);
        integrator.set_slopes(&flow.dy);
    }
    let least = 64.0 * f64::EPSILON * (1e-3 + t.abs());
    FirstStep {
        by_curvature_s: by_curvature_s.max(least),
        longest_s: longest_s.max(least),
    }
}

/// The shortest time in s after which a root function that is zero now, and leaves zero, comes back.
fn shortest_return(state: &mut State<'_>, at: At<'_>, flow: &Flow) -> f64 {
    let program = state.program;
    let n = program.relations.len();
    if n == 0 {
        return f64::INFINITY;
    }
    let roots = state.values(Function::Roots, at);
    let Flow { dy, dyp } = flow;
    let (mut rates, mut bends, mut sizes) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let partials = state.partials(Function::Roots, at);
    for (entry, value) in program.partials(Function::Roots).iter().zip(partials) {
        match entry.wrt {
            Wrt::Unknown(column) => {
                rates[entry.row] += value * dy[column];
                if state.differential[column] {
                    bends[entry.row] += value * dyp[column];
                }
                sizes[entry.row] += (value * at.y[column]).abs();
            }
            Wrt::Derivative(column) => rates[entry.row] += value * dyp[column],
            Wrt::Time => rates[entry.row] += value,
            Wrt::Delayed(_) | Wrt::Parameter(_) | Wrt::Memory(_) => {}
        }
    }
    // The instant was located to rounding of the time.
    let moment = located_s(at.t);
    let at_zero = |k: &usize| {
        let near = rates[*k].abs() * moment + ROUNDING * sizes[*k];
        is_active(state, *k) && roots[*k].abs() <= near
    };
    (0..n)
        .filter(at_zero)
        .map(|k| -2.0 * rates[k] / bends[k])
        .filter(|back| *back > moment)
        .fold(f64::INFINITY, f64::min)
}
