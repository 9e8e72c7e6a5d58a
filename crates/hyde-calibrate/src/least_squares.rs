//! Bounded least squares on innovations: Gauss and Newton's steps, damped after Levenberg and Marquardt.
//!
//! The sum of squares of whitened innovations is, up to a constant, minus twice the logarithm of the likelihood (Ljung,
//! System Identification, 2nd ed. 1999, section 7.4); what is known of parameters beforehand stands beside it as rows
//! `(p - nominal)/sd`, weighed by how much less innovations tell than as many independent ones: where the model lacks
//! something, its sum of squares would else outweigh all that is known, and drive parameters where no part can be.
//! [Derivatives](crate::linearised) are those along one run, for the last steps differences of runs; intervals are of the
//! former. Sums are formed in a fixed order, so the number of threads changes nothing.

use crate::blocks::{Fold, gradients};
use crate::fit::inflation;
use crate::gain::Observer;
use crate::linearised::{Linearised, Slopes};
use crate::observer::Innovations;
use crate::plant::Unsupported;
use crate::recording::Recording;
use crate::solution::Solution;
use crate::varied::Varied;
use hyde_program::Program;
use hyde_sim::Reached;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Steps at most.
pub(crate) const MAX_STEPS: usize = 15;
/// A step that gains less than this of the sum of squares is the last: a standard deviation of one parameter gains 1.
const LEAST_GAIN: f64 = 0.5;
/// Steps by differences of runs at most, behind those by tangents.
pub(crate) const LAST_STEPS: usize = 10;

/// A program, records, and what may be varied.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// The program, in the observed form.
    pub program: &'a Program,
    /// The records.
    pub recordings: &'a [Recording],
    /// The observer, the same for every model that is compared.
    pub observer: &'a Observer,
    /// What may be varied.
    pub varied: &'a [Varied],
    /// Values of other parameters, SI: position and value.
    pub set: &'a [(usize, f64)],
    /// The rows that count; all where nothing is said.
    pub fold: Option<Fold>,
    /// Counts the steps that are done, of the most there may be.
    pub reached: Option<&'a Reached>,
}

/// The normal equations: half the second derivatives, of data and of priors, and half the gradients.
struct Normal {
    data: DMatrix<f64>,
    priors: DMatrix<f64>,
    of_data: DVector<f64>,
    of_priors: DVector<f64>,
    scatter: (DMatrix<f64>, usize),
}

impl Problem<'_> {
    /// Minimises from given values: by tangents until they gain nothing more, then by differences of runs.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn solve(&self, start: &[f64]) -> Result<Solution, Unsupported> {
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
    /// The program has no fixed-step form.
    pub(crate) fn solve_in(
        &self,
        start: &[f64],
        most: usize,
        slopes: Slopes,
    ) -> Result<Solution, Unsupported> {
        let mut values = self.inside(start);
        let mut lambda = 1e-3;
        let (mut steps, mut converged) = (0, false);
        let mut here = self.linearise(&values, slopes)?;
        let (mut data, mut priors) = (sum_of_squares(&here.innovations), self.priors(&values));
        let mut weight = inflation(&here.innovations);
        let mut normal = self.normal(&values, &here);
        while steps < most && !converged {
            let mut taken = false;
            for failed in 0..8 {
                let step = self.step(&values, &normal, weight, lambda);
                let new: Vec<f64> = self.moved(&values, &step);
                let new_priors = self.priors(&new);
                let limit = data + weight * (priors - new_priors);
                if let Some(innovations) = self.within(&new, limit)? {
                    let new_data = sum_of_squares(&innovations);
                    converged = limit - new_data < LEAST_GAIN * weight;
                    (values, data, priors) = (new, new_data, new_priors);
                    weight = inflation(&innovations).min(weight);
                    // A damping that was found only after others failed is kept.
                    if failed == 0 {
                        lambda = (lambda * 0.1).max(1e-9);
                    }
                    here.innovations = innovations;
                    taken = true;
                    break;
                }
                lambda *= 10.0;
            }
            steps += 1;
            if let Some(reached) = self.reached {
                let (before, _) = reached.get();
                reached.set(before + 1.0, (MAX_STEPS + LAST_STEPS) as f64);
            }
            if !taken {
                converged = true;
            }
            if !converged {
                here = self.linearise(&values, slopes)?;
                normal = self.normal(&values, &here);
            }
        }
        let found = Solution {
            wider: vec![1.0; values.len()],
            values,
            data,
            priors,
            weight,
            innovations: here.innovations,
            curvature: (normal.data, normal.priors),
            scatter: normal.scatter,
            steps,
            converged,
        };
        match slopes {
            Slopes::Tangents => Ok(found),
            Slopes::Differences => self.told(found),
        }
    }

    /// A solution with what tangents tell of how sharp it is. A difference of runs takes in events that happen in one of them
    /// alone. To each column they are a noise of its own, and columns that are nearly one and the same come apart.
    fn told(&self, found: Solution) -> Result<Solution, Unsupported> {
        let here = self.linearise(&found.values, Slopes::Tangents)?;
        let normal = self.normal(&found.values, &here);
        Ok(Solution {
            curvature: (normal.data, normal.priors),
            scatter: normal.scatter,
            ..found
        })
    }

    /// Innovations of every record.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn innovations(&self, values: &[f64]) -> Result<Vec<Innovations>, Unsupported> {
        let set = self.settings(values);
        let each = |recording: &Recording| self.run(recording, &set);
        self.recordings.par_iter().map(each).collect()
    }

    /// What is minimised, priors weighed so much.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub(crate) fn cost(&self, values: &[f64], weight: f64) -> Result<f64, Unsupported> {
        Ok(sum_of_squares(&self.innovations(values)?) + weight * self.priors(values))
    }

    /// A solution with its values moved, in units of the scales; what is known of slopes stays.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub(crate) fn moved_by(
        &self,
        solution: &Solution,
        step: &DVector<f64>,
    ) -> Result<Solution, Unsupported> {
        let values = self.moved(&solution.values, step);
        let innovations = self.innovations(&values)?;
        Ok(Solution {
            data: sum_of_squares(&innovations),
            priors: self.priors(&values),
            values,
            innovations,
            ..solution.clone()
        })
    }

    /// The same, as long as the sum of their squares does not exceed a limit.
    fn within(&self, values: &[f64], limit: f64) -> Result<Option<Vec<Innovations>>, Unsupported> {
        let set = self.settings(values);
        let run = |recording: &Recording| match self.fold {
            // Rows that do not count have no limit.
            Some(_) => self.run(recording, &set).map(Some),
            None => Innovations::within(self.program, recording, self.observer, &set, limit),
        };
        let each: Result<Vec<Option<Innovations>>, Unsupported> =
            self.recordings.par_iter().map(run).collect();
        let all: Option<Vec<Innovations>> = each?.into_iter().collect();
        Ok(all.filter(|all| sum_of_squares(all) <= limit))
    }

    pub(crate) fn run(
        &self,
        recording: &Recording,
        set: &[(usize, f64)],
    ) -> Result<Innovations, Unsupported> {
        let mut found = Innovations::of(self.program, recording, self.observer, set)?;
        if let Some(fold) = self.fold {
            fold.keep(&mut found, recording);
        }
        Ok(found)
    }

    /// The sum of squares of what is known beforehand.
    fn priors(&self, values: &[f64]) -> f64 {
        let pairs = self.varied.iter().zip(values);
        let known = pairs.filter_map(|(varied, value)| {
            let sd = varied.prior?;
            Some(((value - varied.nominal) / sd).powi(2))
        });
        known.sum()
    }

    pub(crate) fn settings(&self, values: &[f64]) -> Vec<(usize, f64)> {
        let mut set = self.set.to_vec();
        set.extend(
            self.varied
                .iter()
                .zip(values)
                .map(|(varied, &value)| (varied.place, value)),
        );
        set
    }

    /// The normal equations, in units of the scales.
    fn normal(&self, values: &[f64], at: &Linearised) -> Normal {
        let n = self.varied.len();
        let mut normal = Normal {
            data: DMatrix::zeros(n, n),
            priors: DMatrix::zeros(n, n),
            of_data: DVector::zeros(n),
            of_priors: DVector::zeros(n),
            scatter: (DMatrix::zeros(n, n), 0),
        };
        let records = at.derivatives.iter().zip(&at.innovations);
        for (recording, (own, innovations)) in self.recordings.iter().zip(records) {
            normal.data += own.tr_mul(own);
            for block in gradients(own, innovations, recording) {
                normal.scatter.0.ger(1.0, &block, &block, 1.0);
                normal.scatter.1 += 1;
                normal.of_data += block;
            }
        }
        for (i, varied) in self.varied.iter().enumerate() {
            if let Some(sd) = varied.prior {
                let scale = varied.scale() / sd;
                normal.priors[(i, i)] = scale * scale;
                normal.of_priors[i] = scale * (values[i] - varied.nominal) / sd;
            }
        }
        normal
    }

    /// A damped step, in units of the scales. Parameters at a bound that the step would leave stay.
    fn step(&self, values: &[f64], normal: &Normal, weight: f64, lambda: f64) -> DVector<f64> {
        let n = self.varied.len();
        let mut matrix = &normal.data + weight * &normal.priors;
        let largest = matrix.diagonal().max();
        for i in 0..n {
            matrix[(i, i)] += lambda * matrix[(i, i)] + 1e-12 * largest;
        }
        let mut right = -(&normal.of_data + weight * &normal.of_priors);
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
                let (low, high) = self.varied[i].bounds;
                free[i]
                    && ((values[i] <= low && step[i] < 0.0) || (values[i] >= high && step[i] > 0.0))
            });
            match blocked {
                Some(i) => free[i] = false,
                None => return step,
            }
        }
        DVector::zeros(n)
    }

    /// Values moved by a step in units of the scales, inside their bounds.
    pub(crate) fn moved(&self, values: &[f64], step: &DVector<f64>) -> Vec<f64> {
        let new: Vec<f64> = self
            .varied
            .iter()
            .zip(values)
            .zip(step.iter())
            .map(|((varied, value), step)| value + step * varied.scale())
            .collect();
        self.inside(&new)
    }

    fn inside(&self, values: &[f64]) -> Vec<f64> {
        let pairs = self.varied.iter().zip(values);
        pairs
            .map(|(varied, value)| value.clamp(varied.bounds.0, varied.bounds.1))
            .collect()
    }
}

pub(crate) fn sum_of_squares(innovations: &[Innovations]) -> f64 {
    innovations.iter().map(Innovations::sum_of_squares).sum()
}
