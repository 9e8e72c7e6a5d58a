//! [`whole`]: an order that may be a whole number is one.
//!
//! ```text
//! order = 0.9998 ± 0.0003    ->    order = 1 ± 0.0003, everything else fitted with that
//! ```
//! What is fixed to a shaft comes back with each of its turns, so the orders of wobble, eccentricity and magnets are whole
//! numbers; those of balls and cages are not, and are told apart where the data say so. An order that is a little off runs
//! out of step over many turns, which shows where a model is used beyond what it was fitted to.

use super::hypothesis::Hypothesis;
use super::search::chi_squared;
use super::stage::{Ground, Stage};
use crate::fit::{covariance, inflation};
use crate::plant::Unsupported;

/// Half the width of a 95 % interval, in standard deviations.
const TWO_SIDED: f64 = 1.96;
/// The fit with the whole number may be worse by what chance makes of it in one of so many records.
const CHANCE: f64 = 0.01;

/// The stage with every order at a whole number whose interval holds one, where that fits as well.
pub(crate) fn whole(
    ground: &Ground<'_>,
    hypotheses: &[Hypothesis],
    mut stage: Stage,
) -> Result<Stage, Unsupported> {
    let inflation = inflation(&stage.solution.innovations);
    for name in orders(hypotheses, &stage) {
        let Some(number) = stage.varied.iter().position(|varied| varied.name == name) else {
            continue;
        };
        let variance = covariance(&stage.solution, inflation)[(number, number)];
        let half = TWO_SIDED * variance.max(0.0).sqrt() * stage.varied[number].scale();
        let Some(order) = whole_within(stage.solution.values[number], half) else {
            continue;
        };
        let mut fixed = stage.clone();
        fixed.varied[number].bounds = (order, order);
        let fixed = fixed.polished(ground)?;
        let loss = -fixed.solution.gain_over(&stage.solution);
        if loss <= inflation * chi_squared(1, CHANCE) {
            stage = fixed;
        }
    }
    Ok(stage)
}

/// Full names of the orders of an angle among the shapes of what was taken in; periods in space have a unit.
fn orders(hypotheses: &[Hypothesis], stage: &Stage) -> Vec<String> {
    let each = stage.effects.iter().filter_map(|(effect, path)| {
        let hypothesis = &hypotheses[*effect];
        let shape = &hypothesis.shapes[hypothesis.periodic?];
        let order = matches!(shape.unit.as_str(), "" | "1");
        order.then(|| format!("{path}.{}", shape.name))
    });
    each.collect()
}

/// The whole number from 1 on that is so near, if there is one alone.
fn whole_within(value: f64, half: f64) -> Option<f64> {
    let order = value.round();
    (order >= 1.0 && half < 0.5 && (value - order).abs() <= half).then_some(order)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_whole_number_alone_is_within() {
        assert_eq!(whole_within(0.9998, 0.0003), Some(1.0));
        assert_eq!(whole_within(0.9998, 0.0001), None);
        assert_eq!(whole_within(7.4, 0.6), None);
        assert_eq!(whole_within(0.1, 0.2), None);
        assert_eq!(whole_within(4.0, f64::NAN), None);
    }
}
