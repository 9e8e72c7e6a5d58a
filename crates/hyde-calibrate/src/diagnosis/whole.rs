//! [`whole`]: an order that is likelier a whole number is one.
//!
//! ```text
//! order = 0.9998 ± 0.0003    ->    order = 1 ± 0.0003, everything else fitted with that
//! ```
//! What is fixed to a shaft comes back with each of its turns, so the orders of wobble, eccentricity and magnets are whole
//! numbers; those of balls and cages are not. Beforehand an order is as likely a whole number as any other, and there is one
//! of them to a unit: it is one where the density of what the records tell of it exceeds 1 there (the Bayes factor of a point
//! against an even spread; Jeffreys, Theory of Probability, 3rd ed. 1961, chapter 5). An order that is a little off runs out of
//! step over many turns, which shows where a model is used beyond what it was fitted to.

use super::hypothesis::Hypothesis;
use super::profile::direction;
use super::stage::{Ground, Stage};
use crate::fit::{Solution, covariance, inflation};
use crate::plant::Unsupported;

/// The stage with every order at the whole number beside it where that is likelier.
pub(crate) fn whole(
    ground: &Ground<'_>,
    hypotheses: &[Hypothesis],
    mut stage: Stage,
) -> Result<Stage, Unsupported> {
    for name in orders(hypotheses, &stage) {
        let place = stage.varied.iter().position(|varied| varied.name == name);
        let Some((number, (deviation, overstated))) =
            place.and_then(|number| Some((number, told(&stage, number)?)))
        else {
            continue;
        };
        let value = stage.solution.values[number];
        let order = value.round().max(1.0);
        let apart = (value - order).abs() / deviation;
        if !likelier(apart * apart, deviation) {
            continue;
        }
        let fixed = fixed(ground, &stage, number, order)?;
        let loss = -fixed.solution.gain_over(&stage.solution);
        if likelier(loss / overstated, deviation) {
            stage = fixed;
        }
    }
    Ok(stage)
}

/// The stage with a number at a value, fitted from where the others follow it.
fn fixed(
    ground: &Ground<'_>,
    stage: &Stage,
    number: usize,
    value: f64,
) -> Result<Stage, Unsupported> {
    let Solution { values, .. } = &stage.solution;
    let mut fixed = stage.clone();
    fixed.varied[number].bounds = (value, value);
    let set = ground.set_in(&fixed.program, &fixed.kept);
    let problem = ground.problem(&fixed.program, &fixed.varied, &set, None);
    let inverse = stage.solution.inverse_curvature();
    let direction = inverse.and_then(|inverse| direction(&inverse, number));
    let way = (value - values[number]) / stage.varied[number].scale();
    let start = direction.map_or_else(
        || values.clone(),
        |direction| problem.moved(values, &(way / direction[number] * &direction)),
    );
    fixed.solution = problem.solve(&start)?;
    Ok(fixed)
}

/// Full names of the orders of an angle among the shapes of what was taken in; periods in space have a unit.
fn orders(hypotheses: &[Hypothesis], stage: &Stage) -> Vec<String> {
    let each = stage.effects.iter().filter_map(|(effect, path)| {
        let hypothesis = &hypotheses[*effect];
        let shape = &hypothesis.shapes[hypothesis.periodic?];
        shape.is_number().then(|| format!("{path}.{}", shape.name))
    });
    each.collect()
}

/// The standard deviation of a number, and by how much sums of squares overstate what is known of it.
fn told(stage: &Stage, number: usize) -> Option<(f64, f64)> {
    let independent = stage.solution.inverse_curvature()?[(number, number)];
    let inflation = inflation(&stage.solution.innovations);
    let variance = covariance(&stage.solution, inflation)[(number, number)];
    let deviation = variance.sqrt() * stage.varied[number].scale();
    (deviation > 0.0 && independent > 0.0).then(|| (deviation, variance / independent))
}

/// Whether a point is likelier than an even spread of one to a unit: its squared distance in deviations, and the deviation.
fn likelier(squared: f64, deviation: f64) -> bool {
    (-0.5 * squared).exp() > std::f64::consts::TAU.sqrt() * deviation
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_likelier_the_better_it_is_known() {
        // exp(-z^2/2) = sqrt(2 pi) s at z = 3.99 for s = 1.4e-4, at z = 2.04 for s = 0.05; never where s > 0.4.
        assert!(likelier(3.9_f64.powi(2), 1.4e-4) && !likelier(4.1_f64.powi(2), 1.4e-4));
        assert!(likelier(2.0_f64.powi(2), 0.05) && !likelier(2.1_f64.powi(2), 0.05));
        assert!(!likelier(0.0, 0.4));
    }
}
