//! [`Problem`]: least squares on the innovations of one program's records.

use super::blocks::{Fold, gradients};
use super::descent::{self, Normal, Objective, sum_of_squares};
use super::linearised::{Linearised, Slopes};
use super::solution::Solution;
use super::varied::Varied;
use crate::observer::{Innovations, Observer};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;
use hyde_sim::Reached;
use nalgebra::DVector;
use rayon::prelude::*;

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

impl Objective for Problem<'_> {
    fn varied(&self) -> &[Varied] {
        self.varied
    }

    fn reached(&self) -> Option<&Reached> {
        self.reached
    }

    fn innovations_at(&self, values: &[f64]) -> Result<Vec<Innovations>, Unsupported> {
        let set = self.settings(values);
        let each = |recording: &Recording| self.run(recording, &set);
        self.recordings.par_iter().map(each).collect()
    }

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

    fn normal(
        &self,
        values: &[f64],
        slopes: Slopes,
    ) -> Result<(Vec<Innovations>, Normal), Unsupported> {
        let Linearised {
            innovations,
            derivatives,
        } = self.linearise(values, slopes)?;
        let mut normal = Normal::none(self.varied.len());
        let records = derivatives.iter().zip(&innovations);
        for (recording, (own, innovations)) in self.recordings.iter().zip(records) {
            normal.matrix += own.tr_mul(own);
            for block in gradients(own, innovations, recording) {
                normal.scatter.0.ger(1.0, &block, &block, 1.0);
                normal.scatter.1 += 1;
                normal.gradient += block;
            }
        }
        Ok((innovations, normal))
    }
}

impl Problem<'_> {
    /// Minimises from given values: by tangents until they gain nothing more, then by differences of runs.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn solve(&self, start: &[f64]) -> Result<Solution, Unsupported> {
        Objective::solve(self, start)
    }

    /// Innovations of every record.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn innovations(&self, values: &[f64]) -> Result<Vec<Innovations>, Unsupported> {
        self.innovations_at(values)
    }

    /// What is minimised, priors weighed so much.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub(crate) fn cost(&self, values: &[f64], weight: f64) -> Result<f64, Unsupported> {
        let priors = descent::known_beforehand(self.varied, values);
        Ok(sum_of_squares(&self.innovations(values)?) + weight * priors)
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
            priors: descent::known_beforehand(self.varied, &values),
            values,
            innovations,
            ..solution.clone()
        })
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

    /// Values moved by a step in units of the scales, inside their bounds.
    pub(crate) fn moved(&self, values: &[f64], step: &DVector<f64>) -> Vec<f64> {
        descent::moved(self.varied, values, step)
    }
}
