//! [`Profile`]: how well the records determine one parameter, all others fitted again at every value of it.
//!
//! A value belongs to the 95 % interval if the least sum of squares with it is less than 3.84 above the least of all, in units
//! of what innovations vary by (Venzon and Moolgavkar, Appl. Stat. 37, 1988, 87). Unlike the interval of the curvature it need
//! not be symmetric, and may be open: where no value makes the records unlikely.

use super::calibration::Fit;
use super::descent::{MAX_STEPS, Objective};
use super::joint::Joint;
use super::linearised::Slopes;
use super::solution::Solution;
use crate::plant::Unsupported;

/// Of one freedom, 95 % lie below this.
pub const LIMIT: f64 = 3.841_458_820_694_124;
/// A side ends where the change is above this.
const FAR: f64 = 6.0;
/// Points of a side at most, the parts of the standard deviation between them, and from which point on these double.
const MOST: usize = 14;
const STEP: f64 = 0.5;
const DOUBLES: usize = 6;

/// The least sum of squares with one parameter held, over its values.
#[derive(Clone, Debug)]
pub struct Profile {
    /// The number of the parameter.
    pub parameter: usize,
    /// Values, SI, in ascending order, and how much the least sum of squares is above the least of all, over what innovations
    /// vary by.
    pub points: Vec<(f64, f64)>,
    /// The 95 % interval, SI; a side is `None` if the parameter's bound, or the last value tried, still belongs to it.
    pub interval: (Option<f64>, Option<f64>),
}

impl Joint<'_> {
    /// The profile of a parameter round a fit.
    ///
    /// # Errors
    /// A program has no fixed-step form.
    pub fn profile(&self, fit: &Fit, parameter: usize) -> Result<Profile, Unsupported> {
        let best = &fit.solution;
        let (below, above) = rayon::join(
            || self.side(fit, parameter, -1.0),
            || self.side(fit, parameter, 1.0),
        );
        let centre = (best.values[parameter], best.cost());
        let mut costs: Vec<(f64, f64)> = below?.into_iter().rev().collect();
        costs.push(centre);
        costs.extend(above?);
        let least = costs
            .iter()
            .map(|(_, cost)| *cost)
            .fold(f64::INFINITY, f64::min);
        let change = |(value, cost): (f64, f64)| (value, (cost - least) / best.weight);
        let points: Vec<(f64, f64)> = costs.into_iter().map(change).collect();
        Ok(Profile {
            interval: interval(&points),
            parameter,
            points,
        })
    }

    /// Values away from the best one, and the least cost with each.
    fn side(&self, fit: &Fit, parameter: usize, way: f64) -> Result<Vec<(f64, f64)>, Unsupported> {
        let best = &fit.solution;
        let own = &self.varied[parameter];
        let deviation = fit.parameters[parameter].deviation;
        let known = deviation.is_finite() && deviation > 0.0;
        let mut step = way * STEP * if known { deviation } else { own.scale() };
        let mut start = best.values.clone();
        let mut found = Vec::new();
        for number in 0..MOST {
            if number >= DOUBLES {
                step *= 2.0;
            }
            let value = (start[parameter] + step).clamp(own.bounds.0, own.bounds.1);
            if (value - start[parameter]).abs() < 1e-12 * step.abs() {
                break;
            }
            start[parameter] = value;
            let held = self.held(&start, parameter)?;
            let cost = held.data + best.weight * held.priors;
            found.push((value, cost));
            start = held.values;
            if (cost - best.cost()) / best.weight > FAR {
                break;
            }
        }
        Ok(found)
    }

    /// Fits all others.
    fn held(&self, start: &[f64], parameter: usize) -> Result<Solution, Unsupported> {
        let mut varied = self.varied.to_vec();
        let own = &mut varied[parameter];
        own.visible = Some(own.scale());
        own.bounds = (start[parameter], start[parameter]);
        self.with(&varied)
            .solve_in(start, MAX_STEPS, Slopes::Tangents)
    }
}

/// Where the changes cross the limit on either side of the least one: the root of a change goes nearly as a line.
fn interval(points: &[(f64, f64)]) -> (Option<f64>, Option<f64>) {
    let least = (0..points.len()).min_by(|&a, &b| points[a].1.total_cmp(&points[b].1));
    let Some(least) = least else {
        return (None, None);
    };
    let crossing = |inside: &(f64, f64), outside: &(f64, f64)| {
        let (low, high) = (inside.1.max(0.0).sqrt(), outside.1.sqrt());
        let part = (LIMIT.sqrt() - low) / (high - low);
        inside.0 + part * (outside.0 - inside.0)
    };
    let left: Vec<&(f64, f64)> = points[..=least].iter().rev().collect();
    let right: Vec<&(f64, f64)> = points[least..].iter().collect();
    let side = |list: &[&(f64, f64)]| {
        let pair = list.windows(2).find(|pair| pair[1].1 > LIMIT)?;
        Some(crossing(pair[0], pair[1]))
    };
    (side(&left), side(&right))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_a_parabola_is_that_of_its_curvature() {
        let points: Vec<(f64, f64)> = (-5..=5)
            .map(|i| {
                let away = 0.5 * f64::from(i);
                (10.0 + 0.2 * away, away * away)
            })
            .collect();
        let (low, high) = interval(&points);
        let half = 0.2 * LIMIT.sqrt();
        assert!((low.unwrap_or(0.0) - (10.0 - half)).abs() < 1e-9);
        assert!((high.unwrap_or(0.0) - (10.0 + half)).abs() < 1e-9);
    }

    #[test]
    fn a_side_that_stays_below_the_limit_is_open() {
        let points = [(-1.0, 9.0), (0.0, 0.0), (1.0, 1.0), (2.0, 2.0)];
        let (low, high) = interval(&points);
        assert!(low.is_some_and(|low| (low + LIMIT.sqrt() / 3.0).abs() < 1e-9));
        assert_eq!(high, None);
    }
}
