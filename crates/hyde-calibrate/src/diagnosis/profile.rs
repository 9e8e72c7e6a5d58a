//! [`profiled`]: the last of a fit with effects: each number of theirs at the bottom of its profile.
//!
//! ```text
//! cost(p + t d)      d: how all parameters follow one number of an effect, from the curvature, a standard deviation of it long
//! ```
//! Innovations of play and of sticking are not smooth: least squares by slopes end where the next step gains nothing, some
//! deviations of a weak direction from its bottom. A parabola through costs that are further apart finds it (Seber and
//! Wild, Nonlinear Regression, 1989, section 5.4, on profiles). Where the cost grows by far less than its curvature says, as
//! along a kink, intervals are those of the profile; where it does not grow at all, the fit has not converged and the
//! number has none.

use crate::fit::{Problem, Solution};
use crate::plant::Unsupported;
use nalgebra::{DMatrix, DVector};

/// Numerics: costs are compared this many standard deviations apart, and the bottom is looked for twice as far.
const APART: f64 = 2.0;
/// Numerics: a bottom so near is reached, in standard deviations.
const REACHED: f64 = 0.3;
/// Numerics: parabolas at most for one number, and doublings of the distance in which its cost is to grow.
const STEPS: i32 = 6;

/// The solution with some of what is varied, by number, at the bottom of their profiles. An interval is wider where the cost does
/// not grow by the part `grown` of what the curvature says.
pub(crate) fn profiled(
    problem: &Problem<'_>,
    mut solution: Solution,
    numbers: impl Iterator<Item = usize>,
    grown: f64,
) -> Result<Solution, Unsupported> {
    let Some(covariance) = solution.inverse_curvature() else {
        return Ok(solution);
    };
    for number in numbers {
        let Some(direction) = direction(&covariance, number) else {
            continue;
        };
        for _ in 0..STEPS {
            let (low, high) = rayon::join(
                || problem.moved_by(&solution, &(-APART * &direction)),
                || problem.moved_by(&solution, &(APART * &direction)),
            );
            let (low, high) = (low?, high?);
            let Some(bottom) = bottom(low.cost(), solution.cost(), high.cost()) else {
                break;
            };
            let there = problem.moved_by(&solution, &(bottom * &direction))?;
            let best = [low, high, there]
                .into_iter()
                .min_by(|a, b| a.cost().total_cmp(&b.cost()));
            match best {
                Some(best) if best.gain_over(&solution) > 0.0 => solution = best,
                Some(_) | None => break,
            }
        }
        solution.wider[number] = wider(problem, &solution, number, &direction, grown)?;
        solution.converged &= solution.wider[number].is_finite();
    }
    Ok(solution)
}

/// How many times as far as the curvature says the cost of a profile has grown by what it says; infinite where it does not.
/// What a bound keeps from moving says nothing.
fn wider(
    problem: &Problem<'_>,
    solution: &Solution,
    number: usize,
    direction: &DVector<f64>,
    part: f64,
) -> Result<f64, Unsupported> {
    let scale = problem.varied[number].scale();
    for doubling in 0..=STEPS {
        let times = 2.0_f64.powi(doubling);
        let grown = |far: f64| -> Result<f64, Unsupported> {
            let there = problem.moved_by(solution, &(far * direction))?;
            let moved = (there.values[number] - solution.values[number]) / scale;
            Ok(match moved.abs() < 0.5 * (far * direction[number]).abs() {
                true => f64::INFINITY,
                false => there.cost() - solution.cost(),
            })
        };
        let far = APART * times;
        let (low, high) = rayon::join(|| grown(-far), || grown(far));
        if low?.min(high?) >= part * APART * APART {
            return Ok(times);
        }
    }
    Ok(f64::INFINITY)
}

/// How everything follows one number, by a standard deviation of it.
pub(super) fn direction(covariance: &DMatrix<f64>, number: usize) -> Option<DVector<f64>> {
    let variance = covariance[(number, number)];
    (variance > 0.0).then(|| covariance.column(number) / variance.sqrt())
}

/// Where a parabola through three costs has its bottom, in standard deviations; `None` where that is reached.
fn bottom(low: f64, here: f64, high: f64) -> Option<f64> {
    let bend = low + high - 2.0 * here;
    let place = if bend > 0.0 {
        0.5 * APART * (low - high) / bend
    } else {
        // No bottom between them: on towards the lower one.
        2.0 * APART * (low - high).signum()
    };
    let place = place.clamp(-2.0 * APART, 2.0 * APART);
    (place.is_finite() && place.abs() > REACHED).then_some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_parabola_has_its_bottom_where_it_is() {
        let cost = |t: f64| 3.0 + 0.7 * (t - 1.3) * (t - 1.3);
        let found = bottom(cost(-APART), cost(0.0), cost(APART)).unwrap();
        assert!((found - 1.3).abs() < 1e-12, "{found}");
        assert_eq!(bottom(1.0, 0.5, 1.0), None);
        assert_eq!(bottom(3.0, 2.0, 1.0), Some(2.0 * APART));
    }
}
