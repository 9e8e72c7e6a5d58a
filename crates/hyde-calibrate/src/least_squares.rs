//! Bounded least squares on innovations: Gauss and Newton's steps, damped after Levenberg and Marquardt.
//!
//! The sum of squares of whitened innovations is, up to a constant, minus twice the logarithm of the likelihood (Ljung,
//! System Identification, 2nd ed. 1999, section 7.4); what is known of parameters beforehand stands beside it as rows
//! `(p - nominal)/sd`. Derivatives are differences over a small part of what the data tell about a parameter, each an
//! observer's run of its own: all of them, and all records, at the same time. Sums are formed in a fixed order, so the
//! number of threads changes nothing.

use crate::gain::Observer;
use crate::observer::Innovations;
use crate::plant::Unsupported;
use crate::recording::Recording;
use crate::varied::Varied;
use hyde_program::Program;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Differences are taken over this part of a parameter's scale.
const DIFFERENCE: f64 = 0.1;
/// Steps at most.
const MAX_STEPS: usize = 15;
/// A step that gains less than this part of a unit of the sum of squares is the last.
const LEAST_GAIN: f64 = 0.05;

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
}

/// Every other block of a second, of each record: what one half has been fitted to, the other judges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fold {
    /// Whether the odd blocks count.
    pub odd: bool,
}

impl Fold {
    /// The other half.
    #[must_use]
    pub fn other(self) -> Self {
        Self { odd: !self.odd }
    }

    /// Takes what does not count out of a record's innovations.
    pub(crate) fn keep(self, innovations: &mut Innovations, recording: &Recording) {
        let block = ((1.0 / recording.step_s).round() as usize).max(1);
        for list in &mut innovations.channels {
            for (number, value) in list.iter_mut().enumerate() {
                if ((number / block) % 2 == 1) != self.odd {
                    *value = 0.0;
                }
            }
        }
    }
}

/// Where least squares have arrived.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Values of what was varied, SI.
    pub values: Vec<f64>,
    /// The sum of squares: innovations and priors.
    pub cost: f64,
    /// Innovations of each record.
    pub innovations: Vec<Innovations>,
    /// Half the second derivatives of the cost, in units of [`Varied`]'s scale: of the innovations and of the priors.
    pub curvature: (DMatrix<f64>, DMatrix<f64>),
    /// Steps taken.
    pub steps: usize,
    /// Whether the last step gained nothing any more.
    pub converged: bool,
}

/// Innovations and their derivatives, record by record.
pub(crate) struct Linearised {
    pub(crate) innovations: Vec<Innovations>,
    /// By varied parameter, in units of its scale, then by record; channels one behind the other.
    pub(crate) derivatives: Vec<Vec<Vec<f64>>>,
}

impl Problem<'_> {
    /// Minimises from given values.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn solve(&self, start: &[f64]) -> Result<Solution, Unsupported> {
        self.solve_in(start, MAX_STEPS)
    }

    /// The same in a few steps.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub(crate) fn solve_in(&self, start: &[f64], most: usize) -> Result<Solution, Unsupported> {
        let mut values = self.inside(start);
        let mut lambda = 1e-3;
        let (mut steps, mut converged) = (0, false);
        let mut here = self.linearise(&values)?;
        let mut cost = self.cost(&values, &here.innovations);
        let mut curvature = self.normal(&values, &here).0;
        while steps < most && !converged {
            let (matrix, gradient) = self.normal(&values, &here);
            curvature = matrix;
            let mut taken = false;
            for _ in 0..8 {
                let step = self.step(&values, &curvature, &gradient, lambda);
                let new: Vec<f64> = self.moved(&values, &step);
                let innovations = self.innovations(&new)?;
                let new_cost = self.cost(&new, &innovations);
                let gain = cost - new_cost;
                if gain >= 0.0 && new_cost.is_finite() {
                    converged = gain < LEAST_GAIN;
                    (values, cost, taken) = (new, new_cost, true);
                    lambda = (lambda * 0.1).max(1e-9);
                    here.innovations = innovations;
                    break;
                }
                lambda *= 10.0;
            }
            steps += 1;
            if !taken {
                converged = true;
            }
            if !converged {
                here = self.linearise(&values)?;
            }
        }
        Ok(Solution {
            values,
            cost,
            innovations: here.innovations,
            curvature,
            steps,
            converged,
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

    fn run(&self, recording: &Recording, set: &[(usize, f64)]) -> Result<Innovations, Unsupported> {
        let mut found = Innovations::of(self.program, recording, self.observer, set)?;
        if let Some(fold) = self.fold {
            fold.keep(&mut found, recording);
        }
        Ok(found)
    }

    /// The sum of squares of innovations and priors.
    #[must_use]
    pub fn cost(&self, values: &[f64], innovations: &[Innovations]) -> f64 {
        let data: f64 = innovations.iter().map(Innovations::sum_of_squares).sum();
        let priors = self
            .varied
            .iter()
            .zip(values)
            .filter_map(|(varied, value)| {
                let sd = varied.prior?;
                Some(((value - varied.nominal) / sd).powi(2))
            });
        data + priors.sum::<f64>()
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

    pub(crate) fn linearise(&self, values: &[f64]) -> Result<Linearised, Unsupported> {
        let count = self.recordings.len();
        // Run 0 of a record is where the parameters are, run j + 1 with parameter j moved.
        let runs: Vec<(usize, usize)> = (0..=self.varied.len())
            .flat_map(|run| (0..count).map(move |record| (run, record)))
            .collect();
        let moves: Vec<f64> = self
            .varied
            .iter()
            .zip(values)
            .map(|(varied, &value)| difference(varied, value))
            .collect();
        let results: Result<Vec<Innovations>, Unsupported> = runs
            .par_iter()
            .map(|&(run, record)| {
                let mut values = values.to_vec();
                if let Some(varied) = run.checked_sub(1) {
                    values[varied] += moves[varied];
                }
                self.run(&self.recordings[record], &self.settings(&values))
            })
            .collect();
        let mut results = results?;
        let moved = results.split_off(count);
        let derivatives = self
            .varied
            .iter()
            .enumerate()
            .map(|(number, varied)| {
                let factor = varied.scale() / moves[number];
                let of_record = |record: usize| {
                    let (new, old) = (&moved[number * count + record], &results[record]);
                    let pairs = new
                        .channels
                        .iter()
                        .flatten()
                        .zip(old.channels.iter().flatten());
                    pairs.map(|(new, old)| (new - old) * factor).collect()
                };
                (0..count).map(of_record).collect()
            })
            .collect();
        Ok(Linearised {
            innovations: results,
            derivatives,
        })
    }

    /// Half the second derivatives, of data and of priors, and half the gradient of the cost, in units of the scales.
    fn normal(
        &self,
        values: &[f64],
        at: &Linearised,
    ) -> ((DMatrix<f64>, DMatrix<f64>), DVector<f64>) {
        let n = self.varied.len();
        let rows: Vec<(Vec<f64>, f64)> = (0..n)
            .into_par_iter()
            .map(|i| {
                let products = (0..=i)
                    .map(|j| dot(&at.derivatives[i], &at.derivatives[j]))
                    .collect();
                let own = at.derivatives[i].iter().zip(&at.innovations);
                let slope = own
                    .map(|(derivative, innovations)| {
                        let pairs = derivative.iter().zip(innovations.channels.iter().flatten());
                        pairs.map(|(d, r)| d * r).sum::<f64>()
                    })
                    .sum();
                (products, slope)
            })
            .collect();
        let mut data = DMatrix::zeros(n, n);
        let mut priors = DMatrix::zeros(n, n);
        let mut gradient = DVector::zeros(n);
        for (i, (products, slope)) in rows.into_iter().enumerate() {
            for (j, product) in products.into_iter().enumerate() {
                data[(i, j)] = product;
                data[(j, i)] = product;
            }
            gradient[i] = slope;
            let varied = &self.varied[i];
            if let Some(sd) = varied.prior {
                let scale = varied.scale() / sd;
                priors[(i, i)] = scale * scale;
                gradient[i] += scale * (values[i] - varied.nominal) / sd;
            }
        }
        ((data, priors), gradient)
    }

    /// A damped step, in units of the scales. Parameters at a bound that the step would leave stay.
    fn step(
        &self,
        values: &[f64],
        curvature: &(DMatrix<f64>, DMatrix<f64>),
        gradient: &DVector<f64>,
        lambda: f64,
    ) -> DVector<f64> {
        let n = self.varied.len();
        let mut matrix = &curvature.0 + &curvature.1;
        let largest = matrix.diagonal().max();
        for i in 0..n {
            matrix[(i, i)] += lambda * matrix[(i, i)] + 1e-12 * largest;
        }
        let mut right = -gradient;
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

    fn moved(&self, values: &[f64], step: &DVector<f64>) -> Vec<f64> {
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

/// How far a parameter is moved for a difference: inwards where it is at its upper bound.
fn difference(varied: &Varied, value: f64) -> f64 {
    let size = DIFFERENCE * varied.scale();
    if value + size > varied.bounds.1 {
        -size
    } else {
        size
    }
}

fn dot(a: &[Vec<f64>], b: &[Vec<f64>]) -> f64 {
    let of_record =
        |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    a.iter().zip(b).map(of_record).sum()
}
