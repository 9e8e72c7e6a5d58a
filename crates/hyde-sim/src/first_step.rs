//! The first step after a start: as long as the curvature of the solution allows.

use crate::consistent::Consistent;
use crate::integrator::Integrator;
use crate::setup::Setup;

/// The first step in s from consistent values. The algebraic variables get their slopes along the flow, which the
/// solver's first guess of them follows.
pub(crate) fn first_step(
    integrator: &mut Integrator<'_>,
    consistent: &mut Consistent,
    setup: &Setup<'_>,
) -> f64 {
    let t = integrator.t;
    let span = (setup.stop_s - t).max(1e-12);
    let (y, yp) = (integrator.y.clone(), integrator.yp.clone());
    let flow = consistent.flow(integrator.state_mut(), t, &y, &yp);
    let mut step = 1e-2 * span;
    if let Some((dy, dyp)) = flow {
        for (index, slope) in dy.iter().enumerate() {
            if !integrator.state().differential[index] && slope.is_finite() {
                integrator.yp[index] = *slope;
            }
        }
        // The first step is of order 1: its error is half the square of the step times the second derivative.
        let mut square = 0.0;
        for (value, rate) in y.iter().zip(&dyp) {
            let weighted = rate / (setup.rtol * value.abs() + setup.atol);
            square += weighted * weighted;
        }
        let norm = (square / y.len().max(1) as f64).sqrt();
        if norm.is_finite() && norm > 0.0 {
            step = step.min((0.5 / norm).sqrt());
        }
    }
    let least = 64.0 * f64::EPSILON * (1e-3 + t.abs());
    step.max(least)
}
