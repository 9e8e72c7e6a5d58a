//! [`Joint`]: least squares on records of several experiments and models at once, parameters shared or of some records alone.
//!
//! Innovations are divided by the standard deviations that the observer of their experiment expects, so each experiment
//! weighs by its noise. A [`Part`] is records of one experiment that share all values: each of its own parameters is a number
//! of the whole, and what is shared is the same number in several parts.

use super::descent::{Normal, Objective, sum_of_squares};
use super::least_squares::Problem;
use super::linearised::Slopes;
use super::varied::Varied;
use crate::observer::Innovations;
use crate::plant::Unsupported;
use hyde_sim::Reached;
use rayon::prelude::*;

/// Records of one experiment with the same values of all parameters.
#[derive(Clone)]
pub struct Part<'a> {
    /// The program, its records, and the parameters that it has of the whole, at its own places.
    pub problem: Problem<'a>,
    /// Which number of the whole each of these parameters is.
    pub of: Vec<usize>,
}

/// Several parts, and what may be varied of them.
#[derive(Clone)]
pub struct Joint<'a> {
    /// The parts.
    pub parts: Vec<Part<'a>>,
    /// What may be varied; only a part knows the place.
    pub varied: &'a [Varied],
    /// Counts the steps that are done, of the most there may be.
    pub reached: Option<&'a Reached>,
}

impl<'a> Joint<'a> {
    /// A problem as the only part.
    #[must_use]
    pub fn of(problem: &Problem<'a>) -> Self {
        Self {
            parts: vec![Part {
                problem: *problem,
                of: (0..problem.varied.len()).collect(),
            }],
            varied: problem.varied,
            reached: problem.reached,
        }
    }

    /// The same with other bounds.
    pub(crate) fn with<'b>(&self, varied: &'b [Varied]) -> Joint<'b>
    where
        'a: 'b,
    {
        Joint {
            parts: self.parts.clone(),
            varied,
            reached: None,
        }
    }
}

impl Part<'_> {
    /// The values of its own parameters.
    #[must_use]
    pub fn values(&self, all: &[f64]) -> Vec<f64> {
        self.of.iter().map(|&number| all[number]).collect()
    }
}

impl Objective for Joint<'_> {
    fn varied(&self) -> &[Varied] {
        self.varied
    }

    fn reached(&self) -> Option<&Reached> {
        self.reached
    }

    fn innovations_at(&self, values: &[f64]) -> Result<Vec<Innovations>, Unsupported> {
        let each = self.parts.par_iter();
        let each = each.map(|part| part.problem.innovations_at(&part.values(values)));
        let each: Result<Vec<Vec<Innovations>>, Unsupported> = each.collect();
        Ok(each?.concat())
    }

    fn within(&self, values: &[f64], limit: f64) -> Result<Option<Vec<Innovations>>, Unsupported> {
        let each = self.parts.par_iter();
        let each = each.map(|part| part.problem.within(&part.values(values), limit));
        let each: Result<Vec<Option<Vec<Innovations>>>, Unsupported> = each.collect();
        let all: Option<Vec<Vec<Innovations>>> = each?.into_iter().collect();
        let all = all.map(|all| all.concat());
        Ok(all.filter(|all| sum_of_squares(all) <= limit))
    }

    fn normal(
        &self,
        values: &[f64],
        slopes: Slopes,
    ) -> Result<(Vec<Innovations>, Normal), Unsupported> {
        let each = self.parts.par_iter();
        let each = each.map(|part| part.problem.normal(&part.values(values), slopes));
        let each: Result<Vec<(Vec<Innovations>, Normal)>, Unsupported> = each.collect();
        let mut all = Normal::none(self.varied.len());
        let mut innovations = Vec::new();
        for (part, (own, normal)) in self.parts.iter().zip(each?) {
            innovations.extend(own);
            all.scatter.1 += normal.scatter.1;
            for (i, &row) in part.of.iter().enumerate() {
                all.gradient[row] += normal.gradient[i];
                for (j, &column) in part.of.iter().enumerate() {
                    all.matrix[(row, column)] += normal.matrix[(i, j)];
                    all.scatter.0[(row, column)] += normal.scatter.0[(i, j)];
                }
            }
        }
        Ok((innovations, all))
    }
}
