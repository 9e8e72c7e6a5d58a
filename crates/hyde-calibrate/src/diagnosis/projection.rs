//! [`Projection`]: what a change of innovations gains once the parameters have answered it.
//!
//! Most effects look like a change of parameters to begin with. With the derivatives J of the innovations r by the
//! parameters, and what is known of these beforehand, the least sum of squares near here is
//! `V(r) = r'r - h'A^-1 h`, `A = J'J + P`, `h = J'r + P(p - p0)`. An effect that changes r by d gains `V(r) - V(r + d)`. For
//! a small size s with d = s*c that is the score test of Rao (Proc. Camb. Phil. Soc. 44, 1948, 50) with nuisance
//! parameters: `b^2/M`.

use super::stage::{Stage, flat};
use crate::least_squares::Linearised;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Innovations, with what parameters can do about them.
pub(crate) struct Projection {
    pub(crate) innovations: Vec<f64>,
    derivatives: Vec<Vec<f64>>,
    factor: Cholesky<f64, Dyn>,
    h: DVector<f64>,
    least: f64,
}

/// A linear answer of innovations to some sizes.
pub(crate) struct Answer {
    /// The sizes that gain most, in units of the columns.
    pub(crate) sizes: Vec<f64>,
    /// What they gain.
    pub(crate) gain: f64,
    m: DMatrix<f64>,
    b: DVector<f64>,
}

impl Answer {
    /// What other sizes gain.
    pub(crate) fn gain_of(&self, sizes: &[f64]) -> f64 {
        let sizes = DVector::from_column_slice(sizes);
        2.0 * self.b.dot(&sizes) - sizes.dot(&(&self.m * &sizes))
    }
}

impl Projection {
    /// `None` if the parameters have no curvature at all.
    pub(crate) fn new(stage: &Stage, at: &Linearised) -> Option<Self> {
        let innovations = flat(&at.innovations);
        let derivatives: Vec<Vec<f64>> = at
            .derivatives
            .iter()
            .map(|records| records.concat())
            .collect();
        let n = derivatives.len();
        let mut a = DMatrix::zeros(n, n);
        let mut h = DVector::zeros(n);
        for i in 0..n {
            for j in 0..=i {
                a[(i, j)] = dot(&derivatives[i], &derivatives[j]);
                a[(j, i)] = a[(i, j)];
            }
            h[i] = dot(&derivatives[i], &innovations);
            let varied = &stage.varied[i];
            if let Some(sd) = varied.prior {
                let scale = varied.scale() / sd;
                a[(i, i)] += scale * scale;
                h[i] += scale * (stage.solution.values[i] - varied.nominal) / sd;
            }
        }
        let floor = 1e-12 * a.diagonal().iter().fold(1e-300_f64, |most, v| most.max(*v));
        for i in 0..n {
            a[(i, i)] += floor;
        }
        let factor = Cholesky::new(a)?;
        let least = dot(&innovations, &innovations) - h.dot(&factor.solve(&h));
        Some(Self {
            innovations,
            derivatives,
            factor,
            h,
            least,
        })
    }

    /// What a change of innovations gains.
    pub(crate) fn gain(&self, change: &[f64]) -> f64 {
        let pairs = self.innovations.iter().zip(change);
        let squares: f64 = pairs.map(|(r, d)| (r + d) * (r + d)).sum();
        let h = &self.h + self.onto(change);
        self.least - (squares - h.dot(&self.factor.solve(&h)))
    }

    /// The sizes that gain most if the answer is linear: columns are the changes of innovations a unit.
    pub(crate) fn answer(&self, columns: &[Vec<f64>]) -> Answer {
        let n = columns.len();
        let onto: Vec<DVector<f64>> = columns.iter().map(|column| self.onto(column)).collect();
        let solved: Vec<DVector<f64>> = onto.iter().map(|v| self.factor.solve(v)).collect();
        let mut m = DMatrix::zeros(n, n);
        let mut b = DVector::zeros(n);
        for i in 0..n {
            for j in 0..n {
                m[(i, j)] = dot(&columns[i], &columns[j]) - onto[i].dot(&solved[j]);
            }
            b[i] = -(dot(&columns[i], &self.innovations) - solved[i].dot(&self.h));
        }
        // What parameters answer to within rounding is no column of its own.
        for i in 0..n {
            m[(i, i)] += 1e-9 * dot(&columns[i], &columns[i]) + 1e-300;
        }
        let factor = Cholesky::new(m.clone());
        let sizes = factor.map_or_else(|| DVector::zeros(n), |factor| factor.solve(&b));
        Answer {
            gain: sizes.dot(&b),
            sizes: sizes.iter().copied().collect(),
            m,
            b,
        }
    }

    /// What columns gain of innovations that have nothing to do with them.
    pub(crate) fn by_chance(&self, columns: &[Vec<f64>], innovations: &[f64]) -> f64 {
        let n = columns.len();
        let h = self.factor.solve(&self.onto(innovations));
        let onto: Vec<DVector<f64>> = columns.iter().map(|column| self.onto(column)).collect();
        let solved: Vec<DVector<f64>> = onto.iter().map(|v| self.factor.solve(v)).collect();
        let m = DMatrix::from_fn(n, n, |i, j| {
            let own = dot(&columns[i], &columns[j]);
            own - onto[i].dot(&solved[j]) + if i == j { 1e-9 * own + 1e-300 } else { 0.0 }
        });
        let b = DVector::from_fn(n, |i, _| -(dot(&columns[i], innovations) - onto[i].dot(&h)));
        Cholesky::new(m).map_or(0.0, |factor| b.dot(&factor.solve(&b)))
    }

    fn onto(&self, change: &[f64]) -> DVector<f64> {
        DVector::from_iterator(
            self.derivatives.len(),
            self.derivatives.iter().map(|column| dot(column, change)),
        )
    }
}

pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    // Eight sums at a time, in a fixed order.
    let mut sums = [0.0; 8];
    let (x, y) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = x
        .remainder()
        .iter()
        .zip(y.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (x, y) in x.zip(y) {
        for i in 0..8 {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}
