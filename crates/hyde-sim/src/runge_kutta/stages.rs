//! The stages of a step, each solved by Newton's method, and the estimated error.
//!
//! ```text
//! Y[i] = y + h*sum(a[i][j]*K[j] for j in 0..i),   0 = F(t + c[i]*h, Y[i], K[i])
//! ```
//!
//! K[0] is y' where the step begins. All stages share one matrix, `dF/dy + 1/(h*gamma) dF/dy'`: it is factored when the
//! step changes, and when the iteration contracts slowly. A linear system is solved by the first iteration, so the
//! contraction measured last decides whether one is enough. The last stage is iterated twice, which measures it; but for an
//! affine system it is what it was where the run started. A first correction is one of all unknowns, a second one of those
//! that follow slowly, such as the current of a diode whose slope has changed since the factorization: their ratio says
//! nothing of these where the second is not small itself, so that the last stage is iterated once more. The corrections of
//! all unknowns count, whether their errors do or not: a short step would find the states whatever the voltage of the diode
//! is, and the next one would begin with that voltage.

use super::RungeKutta;
use super::passes::{Along, are_finite, correct, estimate, predict, sum_of_squares};
use super::tableau::{A, C, GAMMA, STAGES};
use hyde_ida::System;

/// Newton iterations of a stage at most.
const MAX_ITERATIONS: usize = 7;
/// What the iteration may leave, in units of the tolerance of a step.
const LEFT: f64 = 0.02;
/// What it may have left where it trusted a contraction that was better than the next one measured.
const MOST_LEFT: f64 = 0.1;
/// Corrections below this, in the same units, are rounding.
const ROUNDING: f64 = 1e-8;
/// A contraction slower than this asks for a new matrix, one slower than that gives up.
const SLOW: f64 = 0.2;
const TOO_SLOW: f64 = 0.9;

/// Inside a step what is stiff or algebraic may be wrong by this part of the largest value it had: guards are found, and
/// located where a step ends.
const SEEN: f64 = 1e-2;

/// Why a step cannot be as long as tried.
pub(super) enum Obstacle {
    /// The residual has no value: that of an equation, if it is known.
    Residual(Option<usize>),
    /// The Jacobian has no value.
    Jacobian,
    /// The matrix has no pivot for an unknown.
    Singular(usize),
    /// Newton's method does not converge; the unknown corrected most, and the residual of its equation, if it is known.
    Convergence(usize, Option<f64>),
    /// The estimated error is too large; the unknown with the largest.
    Error(usize),
}

impl<S: System> RungeKutta<S> {
    /// The stages of a step of `h` s from where it begins. Leaves its end in `stage`; returns the estimated error in units
    /// of the tolerance, and the unknown with the largest if that is more than 1.
    pub(super) fn attempt(&mut self, h: f64) -> Result<(f64, usize), Obstacle> {
        self.fresh = false;
        loop {
            if !self.factors.are_for(h, self.system.coefficients()) {
                self.factor(h)?;
            }
            match self.stages(h) {
                Ok(()) => break,
                Err(obstacle) => {
                    self.factors.forget();
                    self.contraction = None;
                    if self.fresh {
                        return Err(obstacle);
                    }
                }
            }
        }
        if self.contraction.is_some_and(|rate| rate > SLOW) && !self.fresh {
            self.factors.forget();
        }
        self.error(h)
    }

    fn factor(&mut self, h: f64) -> Result<(), Obstacle> {
        self.statistics.jacobian_evaluations += 1;
        let cj = 1.0 / (GAMMA * h);
        let (y, yp) = (&self.before, &self.slopes[0]);
        let evaluated = self.system.jacobian(self.from, cj, y, yp, &mut self.matrix);
        if evaluated.is_err() || self.matrix.iter().any(|entry| !entry.is_finite()) {
            return Err(Obstacle::Jacobian);
        }
        self.factors
            .factor(h, self.system.coefficients(), &self.matrix)
            .map_err(|singular| Obstacle::Singular(singular.unknown))?;
        self.fresh = true;
        Ok(())
    }

    fn stages(&mut self, h: f64) -> Result<(), Obstacle> {
        // Once more if the contraction turns out to be less than the one that earlier stages trusted.
        for _ in 0..2 {
            let mut last = 0.0_f64;
            for i in 1..STAGES {
                self.predict(i, h);
                last = last.max(self.iterate(i, h)?);
            }
            let left = self.contraction.map_or(0.0, |rate| rate * last);
            if left <= MOST_LEFT {
                let affine = self.factors.are_of(self.system.coefficients());
                self.exact = affine || self.finds_all();
                return Ok(());
            }
        }
        Err(Obstacle::Convergence(self.most_corrected(), None))
    }

    /// What the earlier stages say of a stage, and a first guess: a slope that goes on as in the first two.
    fn predict(&mut self, i: usize, h: f64) {
        let (earlier, slope) = self.slopes.split_at_mut(i);
        let along = Along {
            factors: A[i].map(|weight| h * weight),
            part: C[i] / C[1],
            diagonal: h * GAMMA,
        };
        let (stage, slope) = (self.stage.whole_mut(), slope[0].whole_mut());
        predict(stage, slope, self.before.whole(), earlier, &along);
    }

    /// Newton's method for a stage. Returns the size of the last correction, or 0 if that is rounding.
    fn iterate(&mut self, i: usize, h: f64) -> Result<f64, Obstacle> {
        let (t, cj) = (self.from + C[i] * h, 1.0 / (GAMMA * h));
        let mut last = f64::INFINITY;
        for iteration in 0..MAX_ITERATIONS {
            self.statistics.residual_evaluations += 1;
            self.statistics.nonlinear_iterations += 1;
            let slope = &mut self.slopes[i];
            self.system
                .residual(t, &self.stage, slope, &mut self.correction)
                .map_err(|_| Obstacle::Residual(None))?;
            if !are_finite(&self.correction) {
                let row = self.correction.iter().position(|value| !value.is_finite());
                return Err(Obstacle::Residual(row));
            }
            self.factors.solve(&mut self.correction);
            let square = correct(
                (&mut self.stage, slope),
                &self.correction,
                (&self.weights, &self.weights),
                cj,
            );
            let size = (square / self.count).sqrt();
            if !size.is_finite() {
                break;
            }
            if iteration > 0 {
                // It falls slowly, for the next stage may be worse.
                let before = self.contraction.unwrap_or(0.0);
                self.contraction = Some((size / last).max(0.5 * before));
                // What no longer contracts but is small is rounding.
                if size > TOO_SLOW * last {
                    if size > LEFT {
                        break;
                    }
                    return Ok(0.0);
                }
            }
            let measures = i + 1 == STAGES
                && (iteration == 0 || iteration == 1 && size > MOST_LEFT)
                && self.system.coefficients().is_none();
            let converged = self
                .contraction
                .is_some_and(|rate| rate < TOO_SLOW && rate * size <= LEFT * (1.0 - rate));
            if size <= ROUNDING || converged && !measures {
                return Ok(size);
            }
            last = size;
        }
        // What the equation of that unknown leaves where the iteration ends.
        let unknown = self.most_corrected();
        let Self {
            system,
            stage,
            slopes,
            correction,
            ..
        } = self;
        let left = system.residual(t, stage, &slopes[i], correction);
        let left = left.ok().map(|()| correction[unknown]);
        Err(Obstacle::Convergence(unknown, left))
    }

    /// The root mean square of the estimated errors that count, and the unknown with the largest if that is more than 1.
    ///
    /// The difference of the two formulas is one of states, and too large where they are stiff (L. F. Shampine, Math. Comp.
    /// 33 (1979) 521: it grows with h times the Jacobian). What Newton's method makes of it as a change of y' is right
    /// there, and is the error of algebraic variables as well, as far as it comes from states.
    fn error(&mut self, h: f64) -> Result<(f64, usize), Obstacle> {
        let cj = 1.0 / (GAMMA * h);
        let estimated = estimate(
            (&mut self.base, &mut self.correction),
            &self.slopes,
            (&self.largest, &self.stage),
            (&self.atol, &self.weights, &self.counted),
            (h, cj, SEEN),
        );
        let most = estimated.inside;
        let of_most = || self.correction.iter().position(|part| *part >= most);
        let most_at = (most > 1.0).then(of_most).flatten();
        self.smooth = estimated.rough <= 1.0;
        self.statistics.residual_evaluations += 1;
        self.system
            .residual(self.from + h, &self.stage, &self.base, &mut self.correction)
            .map_err(|_| Obstacle::Residual(None))?;
        self.factors.solve(&mut self.correction);
        let error = (sum_of_squares(&self.correction, &self.counted) / self.count).sqrt();
        if !error.is_finite() {
            return Err(Obstacle::Residual(None));
        }
        Ok(match most_at {
            Some(unknown) if most > error => (most, unknown),
            _ if error > 1.0 => (error, self.most_corrected()),
            _ => (error.max(most), 0),
        })
    }

    fn most_corrected(&self) -> usize {
        let sizes = self.correction.iter().zip(self.weights.iter());
        let largest = sizes
            .map(|(correction, weight)| (correction * weight).abs())
            .enumerate()
            .max_by(|a, b| a.1.total_cmp(&b.1));
        largest.map_or(0, |(index, _)| index)
    }
}
