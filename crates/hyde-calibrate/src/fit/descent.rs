//! Bounded least squares on innovations: Gauss and Newton's steps, damped after Levenberg and Marquardt.
//!
//! The sum of squares of whitened innovations is, up to a constant, minus twice the logarithm of the likelihood (Ljung,
//! System Identification, 2nd ed. 1999, section 7.4); what is known of parameters beforehand stands beside it as rows
//! `(p - nominal)/sd`, weighed by how much less innovations tell than as many independent ones: where the model lacks
//! something, its sum of squares would else outweigh all that is known, and drive parameters where no part can be.
//! [Derivatives](super::linearised) are those along one run, for the last steps differences of runs; intervals are of the
//! former. Sums are formed in a fixed order, so the number of threads changes nothing.

use super::goal::Goal;
use super::linearised::Slopes;
use super::solution::Solution;
use super::uncertainty::inflation;
use super::varied::Varied;
use crate::observer::Innovations;
use crate::plant::Unsupported;
use hyde_sim::Reached;
use nalgebra::{DMatrix, DVector};

/// Steps at most.
pub(crate) const MAX_STEPS: usize = 15;
/// A step that gains less than this of the sum of squares is the last: a standard deviation of one parameter gains 1.
const LEAST_GAIN: f64 = 0.5;
/// Steps by differences of runs at most, behind those by tangents.
pub(crate) const LAST_STEPS: usize = 10;

/// A sum of squares of innovations that parameters minimise: of one program's records, or of several programs'.
pub(crate) trait Objective {
    /// What may be varied.
    fn varied(&self) -> &[Varied];
    /// Counts the steps that are done, of the most there may be.
    fn reached(&self) -> Option<&Reached>;
    /// Innovations of every record.
    fn innovations_at(&self, values: &[f64]) -> Result<Vec<Innovations>, Unsupported>;
    /// The same, as long as the sum of their squares does not exceed a limit.
    fn within(&self, values: &[f64], limit: f64) -> Result<Option<Vec<Innovations>>, Unsupported>;
    /// Innovations, and the normal equations of the data in units of the scales.
    fn normal(
        &self,
        values: &[f64],
        slopes: Slopes,
    ) -> Result<(Vec<Innovations>, Normal), Unsupported>;

    /// Minimises from given values: by tangents until they gain nothing more, then by differences of runs.
    ///
    /// # Errors
    /// A program has no fixed-step form.
    fn solve(&self, start: &[f64]) -> Result<Solution, Unsupported>
    where
        Self: Sized,
    {
        let near = self.solve_in(start, MAX_STEPS, Slopes::Tangents)?;
        let end = self.solve_in(&near.values, LAST_STEPS, Slopes::Differences)?;
        Ok(Solution {
            steps: near.steps + end.steps,
            ..end
        })
    }

    /// Minimises in a few steps.
    ///
    /// # Errors
    /// A program has no fixed-step form.
    fn solve_in(&self, start: &[f64], most: usize, slopes: Slopes) -> Result<Solution, Unsupported>
    where
        Self: Sized,
    {
        self.solve_for(None, start, most, slopes)
    }

    /// The same, as long as a goal is in reach.
    ///
    /// # Errors
    /// A program has no fixed-step form.
    fn solve_for(
        &self,
        goal: Option<Goal<'_>>,
        start: &[f64],
        most: usize,
        slopes: Slopes,
    ) -> Result<Solution, Unsupported>
    where
        Self: Sized,
    {
        descend(self, start, most, slopes, goal)
    }
}

/// The normal equations of the data: half the second derivatives, half the gradient, and how much the gradients of blocks
/// scatter: the sum of their squares, and how many they are.
pub(crate) struct Normal {
    pub(crate) matrix: DMatrix<f64>,
    pub(crate) gradient: DVector<f64>,
    pub(crate) scatter: (DMatrix<f64>, usize),
}

impl Normal {
    /// Of nothing, for so many parameters.
    pub(crate) fn none(n: usize) -> Self {
        Self {
            matrix: DMatrix::zeros(n, n),
            gradient: DVector::zeros(n),
            scatter: (DMatrix::zeros(n, n), 0),
        }
    }
}

/// Minimises in a few steps, as long as a goal is in reach.
fn descend(
    objective: &impl Objective,
    start: &[f64],
    most: usize,
    slopes: Slopes,
    goal: Option<Goal<'_>>,
) -> Result<Solution, Unsupported> {
    let varied = objective.varied();
    let mut values = inside(varied, start);
    let mut lambda = 1e-3;
    let (mut steps, mut converged, mut behind) = (0, false, false);
    let (mut innovations, mut normal) = objective.normal(&values, slopes)?;
    let mut known = Known::at(varied, &values);
    let (mut data, mut priors) = (
        sum_of_squares(&innovations),
        known_beforehand(varied, &values),
    );
    let mut weight = inflation(&innovations);
    while steps < most && !converged && !behind {
        let mut taken = false;
        for failed in 0..8 {
            let step = step(varied, &values, &normal, &known, weight, lambda);
            let new: Vec<f64> = moved(varied, &values, &step);
            let new_priors = known_beforehand(varied, &new);
            let limit = data + weight * (priors - new_priors);
            if let Some(there) = objective.within(&new, limit)? {
                let new_data = sum_of_squares(&there);
                let gained = limit - new_data;
                converged = gained < LEAST_GAIN * weight;
                (values, data, priors) = (new, new_data, new_priors);
                weight = inflation(&there).min(weight);
                behind = goal.is_some_and(|goal| {
                    goal.is_out_of_reach((data, priors, weight), gained, most - steps - 1)
                });
                // A damping that was found only after others failed is kept.
                if failed == 0 {
                    lambda = (lambda * 0.1).max(1e-9);
                }
                innovations = there;
                taken = true;
                break;
            }
            lambda *= 10.0;
        }
        steps += 1;
        if let Some(reached) = objective.reached() {
            let (before, _) = reached.get();
            reached.set(before + 1.0, (MAX_STEPS + LAST_STEPS) as f64);
        }
        if !taken {
            converged = true;
        }
        // How sharp a solution is, slopes before the last step tell as well.
        if steps < most && !converged && !behind {
            (innovations, normal) = objective.normal(&values, slopes)?;
            known = Known::at(varied, &values);
        }
    }
    let found = Solution {
        wider: vec![1.0; values.len()],
        values,
        data,
        priors,
        weight,
        innovations,
        curvature: (normal.matrix, known.matrix),
        scatter: normal.scatter,
        steps,
        converged,
    };
    match slopes {
        Slopes::Tangents => Ok(found),
        Slopes::Differences => told(objective, found),
    }
}

/// A solution with what tangents tell of how sharp it is. A difference of runs takes in events that happen in one of them
/// alone. To each column they are a noise of its own, and columns that are nearly one and the same come apart.
fn told(objective: &impl Objective, found: Solution) -> Result<Solution, Unsupported> {
    let (_, normal) = objective.normal(&found.values, Slopes::Tangents)?;
    let known = Known::at(objective.varied(), &found.values);
    Ok(Solution {
        curvature: (normal.matrix, known.matrix),
        scatter: normal.scatter,
        ..found
    })
}

/// The normal equations of what is known beforehand, in units of the scales.
pub(crate) struct Known {
    pub(crate) matrix: DMatrix<f64>,
    gradient: DVector<f64>,
}

impl Known {
    pub(crate) fn at(varied: &[Varied], values: &[f64]) -> Self {
        let n = varied.len();
        let mut known = Self {
            matrix: DMatrix::zeros(n, n),
            gradient: DVector::zeros(n),
        };
        for (i, varied) in varied.iter().enumerate() {
            if let Some(sd) = varied.prior {
                let scale = varied.scale() / sd;
                known.matrix[(i, i)] = scale * scale;
                known.gradient[i] = scale * (values[i] - varied.nominal) / sd;
            }
        }
        known
    }
}

/// The sum of squares of what is known beforehand.
pub(crate) fn known_beforehand(varied: &[Varied], values: &[f64]) -> f64 {
    let pairs = varied.iter().zip(values);
    let known = pairs.filter_map(|(varied, value)| {
        let sd = varied.prior?;
        Some(((value - varied.nominal) / sd).powi(2))
    });
    known.sum()
}

/// A damped step, in units of the scales. Parameters at a bound that the step would leave stay.
fn step(
    varied: &[Varied],
    values: &[f64],
    normal: &Normal,
    known: &Known,
    weight: f64,
    lambda: f64,
) -> DVector<f64> {
    let n = varied.len();
    let mut matrix = &normal.matrix + weight * &known.matrix;
    let largest = matrix.diagonal().max();
    for i in 0..n {
        matrix[(i, i)] += lambda * matrix[(i, i)] + 1e-12 * largest;
    }
    let mut right = -(&normal.gradient + weight * &known.gradient);
    let mut free = vec![true; n];
    for _ in 0..=n {
        let mut reduced = matrix.clone();
        for i in (0..n).filter(|&i| !free[i]) {
            reduced.row_mut(i).fill(0.0);
            reduced.column_mut(i).fill(0.0);
            reduced[(i, i)] = 1.0;
            right[i] = 0.0;
        }
        let step = reduced
            .cholesky()
            .map_or_else(|| DVector::zeros(n), |c| c.solve(&right));
        let blocked = (0..n).find(|&i| {
            let (low, high) = varied[i].bounds;
            free[i] && ((values[i] <= low && step[i] < 0.0) || (values[i] >= high && step[i] > 0.0))
        });
        match blocked {
            Some(i) => free[i] = false,
            None => return step,
        }
    }
    DVector::zeros(n)
}

/// Values moved by a step in units of the scales, inside their bounds.
pub(crate) fn moved(varied: &[Varied], values: &[f64], step: &DVector<f64>) -> Vec<f64> {
    let new: Vec<f64> = varied
        .iter()
        .zip(values)
        .zip(step.iter())
        .map(|((varied, value), step)| value + step * varied.scale())
        .collect();
    inside(varied, &new)
}

fn inside(varied: &[Varied], values: &[f64]) -> Vec<f64> {
    let pairs = varied.iter().zip(values);
    pairs
        .map(|(varied, value)| value.clamp(varied.bounds.0, varied.bounds.1))
        .collect()
}

pub(crate) fn sum_of_squares(innovations: &[Innovations]) -> f64 {
    innovations.iter().map(Innovations::sum_of_squares).sum()
}
