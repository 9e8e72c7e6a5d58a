//! [`Solution`]: where least squares have arrived, and how sharply.

use crate::observer::Innovations;
use nalgebra::DMatrix;

/// Where least squares have arrived.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Values of what was varied, SI.
    pub values: Vec<f64>,
    /// The sum of squares of innovations.
    pub data: f64,
    /// The sum of squares of what is known beforehand.
    pub priors: f64,
    /// By how much innovations tell less than as many independent ones: priors weigh so much more.
    pub weight: f64,
    /// Innovations of each record.
    pub innovations: Vec<Innovations>,
    /// Half the second derivatives of the cost, in units of [`crate::Varied`]'s scale: of the innovations and of the priors.
    pub curvature: (DMatrix<f64>, DMatrix<f64>),
    /// How much the gradients of blocks of a second scatter: the sum of their squares, in the same units, and how many they
    /// are.
    pub scatter: (DMatrix<f64>, usize),
    /// How many times as wide the interval of each number is as its curvature says: 1 unless its profile told otherwise.
    pub wider: Vec<f64>,
    /// Steps taken.
    pub steps: usize,
    /// Whether the last step gained nothing any more.
    pub converged: bool,
}

impl Solution {
    /// What was minimised.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.data + self.weight * self.priors
    }

    /// The inverse of the cost's curvature, in units of the scales: how everything follows one number. `None` where it is flat.
    pub(crate) fn inverse_curvature(&self) -> Option<DMatrix<f64>> {
        let (data, priors) = &self.curvature;
        (data + priors * self.weight).try_inverse()
    }

    /// What it gains over another, priors weighed as here.
    #[must_use]
    pub fn gain_over(&self, other: &Self) -> f64 {
        other.gained_by((self.data, self.priors, self.weight))
    }

    /// What a solution gains over this one: its sum of squares of innovations, that of what is known beforehand, and the weight
    /// of the latter.
    pub(super) fn gained_by(&self, (data, priors, weight): (f64, f64, f64)) -> f64 {
        self.data + weight * self.priors - (data + weight * priors)
    }
}
