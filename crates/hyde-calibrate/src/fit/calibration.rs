//! [`Fit`]: a calibration with what it is worth: intervals, correlations, what the data cannot tell apart.

use super::descent::Objective;
use super::joint::Joint;
use super::least_squares::Problem;
use super::solution::Solution;
use super::standstill::{Cause, audible, standstill};
use super::uncertainty::{covariance, inflation};
use super::varied::Varied;
use crate::observer::Innovations;
use crate::plant::Unsupported;
use hyde_signal::statistics::distributions::TWO_SIDED;
use nalgebra::DMatrix;

/// Parameters are of one group if some pair of their errors is correlated more than this.
const CORRELATED: f64 = 0.9;
/// The data say nothing of a parameter whose standard deviation stays above this part of what it was beforehand.
const UNTOLD: f64 = 0.9;
/// A parameter after calibration; numbers are SI.
#[derive(Clone, Debug)]
pub struct FittedParameter {
    /// Its name.
    pub name: String,
    /// Position in the parameter vector.
    pub place: usize,
    /// Declared value.
    pub nominal: f64,
    /// Calibrated value.
    pub value: f64,
    /// Its 95 % interval, by the effective number of samples.
    pub interval: (f64, f64),
    /// Standard deviation beforehand, if it has a prior.
    pub prior: Option<f64>,
    /// Standard deviation after.
    pub deviation: f64,
    /// It lies outside its declared range, by more than its interval: it may stand in for something that the model lacks.
    pub left_range: bool,
    /// It lies on a bound.
    pub at_bound: bool,
    /// What is known of it is what was known before.
    pub untold: bool,
    /// No innovation depends on it.
    pub silent: bool,
}

/// A calibration.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The parameters.
    pub parameters: Vec<FittedParameter>,
    /// Numbers of parameters whose errors go together.
    pub groups: Vec<Vec<usize>>,
    /// Correlation of the errors of each two parameters.
    pub correlation: Vec<Vec<f64>>,
    /// Mean square of the innovations of each part, and of how many.
    pub parts: Vec<(f64, usize)>,
    /// By how much innovations tell less than as many independent ones: mean square times correlation.
    pub inflation: f64,
    /// Steps of the least squares, of the best start.
    pub steps: usize,
    /// Whether they converged.
    pub converged: bool,
    /// How many of the starts ended within a unit of the lowest sum of squares, and how many there were.
    pub agreeing_starts: (usize, usize),
    /// Why there is nothing in it, or little, as far as its runs show it: each with the number of its part.
    pub causes: Vec<(usize, Cause)>,
    /// Where it ended.
    pub solution: Solution,
}

impl Fit {
    /// Whether innovations depend on anything that was varied.
    #[must_use]
    pub fn learned(&self) -> bool {
        self.parameters.iter().any(|parameter| !parameter.silent)
    }
}

/// Calibrates programs on the records of their parts.
///
/// # Errors
/// A program has no fixed-step form.
pub fn fit(joint: &Joint<'_>, starts: usize) -> Result<Fit, Unsupported> {
    let varied = joint.varied;
    let mut solutions = Vec::new();
    for start in 0..starts.max(1) {
        solutions.push(joint.solve(&start_values(varied, start))?);
    }
    let lowest = solutions
        .iter()
        .map(Solution::cost)
        .fold(f64::INFINITY, f64::min);
    let agreeing = solutions.iter().filter(|s| s.cost() < lowest + 1.0).count();
    let best = solutions
        .iter()
        .position(|s| s.cost() <= lowest)
        .unwrap_or(0);
    let solution = solutions.swap_remove(best);
    let inflation = inflation(&solution.innovations);
    let covariance = covariance(&solution, inflation);
    let (mut causes, mut parts, mut first) = (Vec::new(), Vec::new(), 0);
    for (number, part) in joint.parts.iter().enumerate() {
        let Problem {
            program,
            recordings,
            observer,
            varied,
            set,
            ..
        } = part.problem;
        let own = solution.innovations[first..first + recordings.len()].to_vec();
        first += recordings.len();
        let count = own.iter().map(Innovations::count).sum();
        let sum: f64 = own.iter().map(Innovations::sum_of_squares).sum();
        parts.push((sum / (count as f64).max(1.0), count));
        let own = Solution {
            values: part.values(&solution.values),
            innovations: own,
            ..solution.clone()
        };
        let found = standstill(program, recordings, observer, varied, set, &own)?;
        causes.extend(found.into_iter().map(|cause| (number, cause)));
    }
    Ok(Fit {
        parameters: parameters(varied, &solution, &covariance),
        groups: groups(&covariance),
        correlation: correlations(&covariance),
        parts,
        inflation,
        steps: solution.steps,
        converged: solution.converged,
        agreeing_starts: (agreeing, starts.max(1)),
        causes,
        solution,
    })
}

/// What a solution says of the parameters that were varied, each with its interval.
#[must_use]
pub fn fitted_parameters(varied: &[Varied], solution: &Solution) -> Vec<FittedParameter> {
    let inflation = inflation(&solution.innovations);
    parameters(varied, solution, &covariance(solution, inflation))
}

/// The declared values, then points spread evenly over what is known beforehand (additive recurrence of the roots of
/// x^(d+1) = x + 1; Roberts 2018, The unreasonable effectiveness of quasirandom sequences).
fn start_values(varied: &[Varied], number: usize) -> Vec<f64> {
    if number == 0 {
        return varied.iter().map(|varied| varied.nominal).collect();
    }
    let dimensions = varied.len() as f64;
    let mut root = 2.0_f64;
    for _ in 0..60 {
        root = (1.0 + root).powf(1.0 / (dimensions + 1.0));
    }
    let spread = |(axis, varied): (usize, &Varied)| {
        let part = (number as f64 * root.powi(-(i32::try_from(axis).unwrap_or(0) + 1))).fract();
        let width = varied.scale() * 3.0_f64.sqrt();
        varied.nominal + (2.0 * part - 1.0) * width
    };
    varied.iter().enumerate().map(spread).collect()
}

fn parameters(
    varied: &[Varied],
    solution: &Solution,
    covariance: &DMatrix<f64>,
) -> Vec<FittedParameter> {
    let audible = audible(solution);
    let each = varied.iter().zip(&solution.values).enumerate();
    each.map(|(number, (varied, &value))| {
        let deviation = covariance[(number, number)].max(0.0).sqrt() * varied.scale();
        let width = TWO_SIDED * deviation;
        let (low, high) = varied.bounds;
        let near = 1e-9 * varied.scale();
        // The normal distribution that stands for a uniform one has a standard deviation of half its width over sqrt(3).
        let outside = varied.prior.map_or(0.0, |sd| {
            (value - varied.nominal).abs() - 3.0_f64.sqrt() * sd
        });
        FittedParameter {
            name: varied.name.clone(),
            place: varied.place,
            nominal: varied.nominal,
            value,
            interval: (value - width, value + width),
            prior: varied.prior,
            deviation,
            left_range: outside > width,
            at_bound: value <= low + near || value >= high - near,
            untold: varied.prior.is_some_and(|sd| deviation > UNTOLD * sd),
            silent: !audible[number],
        }
    })
    .collect()
}

/// Correlations of a covariance; 0 where a parameter has none.
fn correlations(covariance: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let n = covariance.nrows();
    let of = |i: usize, j: usize| {
        let own = covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        match (i == j, own.is_finite()) {
            (true, _) => 1.0,
            (false, true) => own.clamp(-1.0, 1.0),
            (false, false) => 0.0,
        }
    };
    (0..n).map(|i| (0..n).map(|j| of(i, j)).collect()).collect()
}

/// Parameters whose errors go together: chains of correlated pairs.
fn groups(covariance: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = covariance.nrows();
    let mut found: Vec<Vec<usize>> = Vec::new();
    let correlated = |i: usize, j: usize| {
        covariance[(i, j)].abs() > CORRELATED * (covariance[(i, i)] * covariance[(j, j)]).sqrt()
    };
    for i in 0..n {
        let (mut joined, others): (Vec<_>, Vec<_>) = found
            .into_iter()
            .partition(|group: &Vec<usize>| group.iter().any(|&j| correlated(i, j)));
        let mut group: Vec<usize> = joined.drain(..).flatten().collect();
        group.push(i);
        found = others;
        found.push(group);
    }
    found.retain(|group| group.len() > 1);
    found.iter_mut().for_each(|group| group.sort_unstable());
    found.sort();
    found
}
