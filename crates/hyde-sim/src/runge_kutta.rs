//! [`RungeKutta`]: a one-step method for `0 = F(t, y, y')`, which starts anew at an event at no cost.
//!
//! Backward differentiation begins at order 1 with small steps wherever something jumps; where a clock ticks every few
//! milliseconds that is most of its work. A one-step method has no past to lose: it goes on with the step it had.
//!
//! Six implicit stages ([`stages`]) of order 5; the last stage is the end of the step, so algebraic variables satisfy
//! their equations there, and what is infinitely stiff is damped out at once ([`tableau`]). The step follows the estimated
//! errors ([`step_size`]), but is kept while it is nearly right, for each new one takes a factorization.

mod factors;
mod lanes;
mod passes;
mod stages;
mod step_size;
mod tableau;

use crate::moment::At;
pub(crate) use factors::Factors;
use hyde_ida::{Error, Failure, FailureKind, Statistics, System};
use lanes::Lanes;
use passes::{correct, inside, keep_largest, sum_of_squares, weights};
use stages::Obstacle;
use step_size::StepSize;
use tableau::{BUBBLE, GAMMA, STAGES};

/// So many steps at most before a stop are made to fit; and how much longer they might be without being so.
const MOST_FITTED: f64 = 8.0;
const SERVES: f64 = 1.25;
/// Lengths that are to come back are so many in each octave.
const RUNGS: f64 = 4.0;
/// What an obstacle other than the error makes of a step.
const RETREAT: f64 = 0.25;
/// A correction of the states that is no more of the tolerance leaves the solution.
const NEARLY: f64 = 0.5;
/// All else is found where a correction is no more of it, of so many: what follows from a voltage by the steep line of a diode
/// is to be exact as well.
const FOUND: f64 = 1e-2;
const MOST_CORRECTIONS: usize = 4;
/// Attempts at a step.
const MAX_ATTEMPTS: usize = 40;
/// The last slope: y' at the end of the step.
const LAST: usize = STAGES - 1;

/// A solver of one system, standing at the end of a step. Time runs forward.
pub(crate) struct RungeKutta<S> {
    system: S,
    factors: Factors,
    /// Factors for the steps to rows: what rows are asked for must not change the run.
    for_rows: Option<Factors>,
    matrix: Vec<f64>,
    /// Whether the factors are of the point where the step begins.
    fresh: bool,
    /// What an iteration of Newton's method leaves of the error, as last measured.
    contraction: Option<f64>,
    rtol: f64,
    atol: Lanes,
    /// The unknowns whose errors count, how many there are, and those that are states.
    counts: Vec<bool>,
    count: f64,
    differential: Vec<bool>,
    /// The largest value of each unknown at the end of a step.
    largest: Lanes,
    max_step_s: f64,
    next_step_s: f64,
    step_size: StepSize,
    from: f64,
    before: Lanes,
    t: f64,
    y: Lanes,
    /// y' of each stage, and room for those of another step.
    slopes: Vec<Lanes>,
    others: Vec<Lanes>,
    /// Whether the interpolant of the last step is as exact as its end: so it is for what is neither stiff nor algebraic.
    smooth: bool,
    /// Whether at the end of the last step Newton's method has found all else as exactly as states.
    exact: bool,
    /// 1 over the tolerance of each unknown; the same, and 0 where an error does not count.
    weights: Lanes,
    counted: Lanes,
    stage: Lanes,
    base: Lanes,
    correction: Lanes,
    statistics: Statistics,
}

impl<S: System> RungeKutta<S> {
    /// A solver that stands at consistent values at `t` (in s). The errors of states count, those of algebraic variables
    /// where they are `watched`.
    pub(crate) fn new(
        system: S,
        factors: Factors,
        differential: Vec<bool>,
        watched: bool,
        max_step_s: f64,
        At { t, y, yp }: At<'_>,
    ) -> Self {
        let (n, entries) = (factors.pattern().n(), factors.pattern().n_entries());
        let mut slopes = vec![Lanes::zeros(n); STAGES];
        slopes[LAST].copy_from_slice(yp);
        let mut largest = Lanes::from(y);
        largest.iter_mut().for_each(|value| *value = value.abs());
        let counts: Vec<bool> = differential.iter().map(|is| *is || watched).collect();
        let count = counts.iter().filter(|counts| **counts).count();
        Self {
            system,
            factors,
            for_rows: None,
            matrix: vec![0.0; entries],
            fresh: false,
            contraction: None,
            rtol: 0.0,
            atol: Lanes::zeros(n),
            counts,
            count: count.max(1) as f64,
            differential,
            largest,
            max_step_s,
            next_step_s: f64::INFINITY,
            step_size: StepSize::default(),
            from: t,
            before: Lanes::from(y),
            t,
            y: Lanes::from(y),
            others: slopes.clone(),
            slopes,
            smooth: true,
            exact: true,
            weights: Lanes::zeros(n),
            counted: Lanes::zeros(n),
            stage: Lanes::zeros(n),
            base: Lanes::zeros(n),
            correction: Lanes::zeros(n),
            statistics: Statistics::default(),
        }
    }

    /// What another method counted before counts too.
    pub(crate) fn count_on(&mut self, before: Statistics) {
        self.statistics = before;
    }

    pub(crate) fn system(&self) -> &S {
        &self.system
    }

    pub(crate) fn system_mut(&mut self) -> &mut S {
        &mut self.system
    }

    /// Time in s, unknowns and their derivatives at the end of the last step.
    pub(crate) fn end(&self) -> At<'_> {
        let (t, y, yp) = (self.t, &*self.y, &*self.slopes[LAST]);
        At { t, y, yp }
    }

    /// Whether all but the states, and all rates, are as exact there as they.
    pub(crate) fn end_is_exact(&self) -> bool {
        self.exact
    }

    pub(crate) fn statistics(&self) -> Statistics {
        self.statistics
    }

    /// The relative tolerance, and the absolute one of each unknown.
    pub(crate) fn set_tolerances(&mut self, rtol: f64, atol: &[f64]) {
        self.rtol = rtol;
        self.atol.copy_from_slice(atol);
    }

    /// Goes on from other values, or with other equations. The next step is the one it had, unless one of two others is
    /// shorter: the first step that goes with a step of order 1 of `by_curvature_s`, and `longest_s`.
    pub(crate) fn restart(&mut self, At { t, y, yp }: At<'_>, by_curvature_s: f64, longest_s: f64) {
        self.t = t;
        self.y.copy_from_slice(y);
        self.slopes[LAST].copy_from_slice(yp);
        // What was 0 until now and is no longer has a size.
        keep_largest(&mut self.largest, &self.y);
        let first_s = self.step_size.first(by_curvature_s);
        self.next_step_s = self.next_step_s.min(first_s).min(longest_s);
        // The factors may serve on: where only a held value has changed they do. The contraction tells of the others.
        if !self.factors.are_of(self.system.coefficients()) {
            self.contraction = None;
        }
        self.statistics.restarts += 1;
    }

    /// One step, never past `stop` (in s).
    pub(crate) fn step(&mut self, stop: f64) -> Result<(), Error> {
        self.from = self.t;
        std::mem::swap(&mut self.before, &mut self.y);
        self.slopes.swap(0, LAST);
        weights(
            (&mut self.weights, &mut self.counted),
            (&self.differential, &self.counts),
            (&self.before, &self.largest),
            (self.rtol, &self.atol),
        );
        let (wanted, left) = (self.next_step_s.min(self.max_step_s), stop - self.from);
        let step = self.fitting(wanted, left);
        let grown = self.take(step, stop)?;
        // A step cut short says nothing against a longer one.
        self.next_step_s = if step < wanted && grown >= step {
            grown.max(wanted)
        } else {
            grown
        };
        Ok(())
    }

    /// A step in s of about the length `wanted`, so that a few of them lead to a stop `left` s ahead: all of one length, and
    /// of the length of the last one where that serves, for each other length takes a factorization.
    fn fitting(&self, wanted: f64, left: f64) -> f64 {
        let count = left / wanted;
        if count > MOST_FITTED {
            return match self.factors.come_back() {
                true => on_ladder(wanted),
                false => wanted,
            };
        }
        let lengths = self.factors.lengths_s(self.system.coefficients());
        let serving = lengths.filter_map(|length| {
            let count = (left / length).round();
            let fits = (left - count * length).abs() <= 1e-9 * left;
            let serves = length <= wanted * (1.0 + 1e-9) && wanted <= SERVES * length;
            (fits && serves && count >= 1.0).then_some(count)
        });
        let fewest = serving.fold(f64::INFINITY, f64::min);
        if fewest.is_finite() {
            return left / fewest;
        }
        left / (count * (1.0 - 1e-9)).ceil().max(1.0)
    }

    /// Takes the last step once more, to end at `end` (in s) inside it or before; the next one is as long as it would
    /// have been. Whether there is such a step: else the last one is taken as it was.
    pub(crate) fn step_again(&mut self, end: f64) -> Result<bool, Error> {
        let whole = self.t;
        let shorter = self.take(end - self.from, end).is_ok();
        if !shorter {
            self.take(whole - self.from, whole)?;
        }
        self.statistics.steps -= 1;
        Ok(shorter)
    }

    /// Takes a step of this length in s, or as long as it can be. Returns the length of the next.
    fn take(&mut self, mut step: f64, stop: f64) -> Result<f64, Error> {
        let (to_stop, mut obstacle) = (step >= stop - self.from, None);
        for _ in 0..MAX_ATTEMPTS {
            if step <= 16.0 * f64::EPSILON * self.from.abs() {
                break;
            }
            let met = match self.attempt(step) {
                Ok((error, worst)) => {
                    if error <= 1.0 {
                        std::mem::swap(&mut self.y, &mut self.stage);
                        let whole = to_stop && obstacle.is_none();
                        self.t = if whole { stop } else { self.from + step };
                        self.statistics.steps += 1;
                        keep_largest(&mut self.largest, &self.y);
                        return Ok(self.step_size.after(step, error, obstacle.is_some()));
                    }
                    self.statistics.error_test_failures += 1;
                    step = StepSize::retry(step, error);
                    Obstacle::Error(worst)
                }
                Err(met) => {
                    self.statistics.nonlinear_failures += 1;
                    step *= RETREAT;
                    met
                }
            };
            obstacle = Some(met);
        }
        Err(self.failure(obstacle, step))
    }

    fn failure(&self, obstacle: Option<Obstacle>, step_s: f64) -> Error {
        let left = match obstacle {
            Some(Obstacle::Convergence(_, left)) => left,
            Some(_) | None => None,
        };
        let (kind, unknown, equation) = match obstacle {
            Some(Obstacle::Residual(equation)) => (FailureKind::Residual, None, equation),
            Some(Obstacle::Jacobian) => (FailureKind::Jacobian, None, None),
            Some(Obstacle::Singular(unknown)) => {
                (FailureKind::SingularJacobian, Some(unknown), None)
            }
            Some(Obstacle::Convergence(unknown, _)) => {
                (FailureKind::Convergence, Some(unknown), None)
            }
            Some(Obstacle::Error(unknown)) => (FailureKind::ErrorTest, Some(unknown), None),
            None => (FailureKind::ErrorTest, None, None),
        };
        Error::Failed(Box::new(Failure {
            kind,
            t: self.from,
            step_s,
            unknown,
            equation,
            residual: left,
            root: None,
            flag: "",
            message: String::new(),
        }))
    }

    /// The solution at a time (in s) within the last step: the end of a shorter step where the interpolant is not as exact
    /// as the end of the step. Whether all but the states, and all rates, are as exact as they.
    pub(crate) fn solution(&mut self, t: f64, y: &mut [f64], yp: &mut [f64]) -> bool {
        self.interpolate(t, y, yp);
        let good = self.smooth && !self.differential.contains(&false);
        good || self.corrected(t, y, yp) || self.step_to(t, y, yp)
    }

    /// The end of a step as long as to `t`; what was there if there is none. Whether it is exact in all but the states too.
    /// The factors of the run remain as they are.
    fn step_to(&mut self, t: f64, y: &mut [f64], yp: &mut [f64]) -> bool {
        let for_rows = self.for_rows.take();
        let for_rows = for_rows.map_or_else(|| self.factors.empty(), Ok);
        let Ok(mut for_rows) = for_rows else {
            return false;
        };
        let of_run = (self.contraction.take(), self.smooth, self.exact);
        for_rows.forget();
        std::mem::swap(&mut self.factors, &mut for_rows);
        std::mem::swap(&mut self.slopes, &mut self.others);
        self.slopes[0].copy_from_slice(&self.others[0]);
        let h = t - self.from;
        let reached = self.attempt(h).is_ok();
        if reached {
            y.copy_from_slice(&self.stage);
            yp.copy_from_slice(&self.slopes[LAST]);
        }
        let exact = reached && self.settled(t, h, y, yp);
        std::mem::swap(&mut self.slopes, &mut self.others);
        std::mem::swap(&mut self.factors, &mut for_rows);
        self.for_rows = Some(for_rows);
        (self.contraction, self.smooth, self.exact) = of_run;
        exact
    }

    /// The same values, corrected with the factors of the step. Whether that is the solution to the tolerance of the step.
    fn corrected(&mut self, t: f64, y: &mut [f64], yp: &mut [f64]) -> bool {
        let step = self.factors.step_s().filter(|h| self.is_length(*h));
        step.is_some_and(|h| self.settled(t, h, y, yp))
    }

    /// Corrects values and rates by Newton's method with the factors of a step of `h` s. Whether that leaves the states
    /// where they were to the tolerance of the step, and finds all else to it; else nothing is changed.
    fn settled(&mut self, t: f64, h: f64, y: &mut [f64], yp: &mut [f64]) -> bool {
        self.stage.copy_from_slice(y);
        self.base.copy_from_slice(yp);
        let affine = self.factors.are_of(self.system.coefficients());
        for _ in 0..MOST_CORRECTIONS {
            self.statistics.residual_evaluations += 1;
            let (system, correction) = (&mut self.system, &mut self.correction);
            let evaluated = system.residual(t, &self.stage, &self.base, correction);
            if evaluated.is_err() {
                return false;
            }
            self.factors.solve(correction);
            let square = correct(
                (&mut self.stage, &mut self.base),
                correction,
                (&self.weights, &self.counted),
                1.0 / (GAMMA * h),
            );
            // What is not a number is no solution.
            let leaves_states = (square / self.count).sqrt() <= NEARLY;
            if !leaves_states {
                return false;
            }
            if affine || self.finds_all() {
                y.copy_from_slice(&self.stage);
                yp.copy_from_slice(&self.base);
                return true;
            }
        }
        false
    }

    /// Whether the last correction was next to none of any unknown.
    fn finds_all(&self) -> bool {
        let square = sum_of_squares(&self.correction, &self.weights);
        (square / self.weights.len() as f64).sqrt() <= FOUND
    }

    /// Whether the last step is this long, in s.
    fn is_length(&self, h: f64) -> bool {
        (self.t - self.from - h).abs() <= 1e-6 * h
    }

    /// The same by the interpolant: a polynomial of degree 4, which meets both ends with their
    /// slopes. Good enough to see what happens inside a step.
    pub(crate) fn interpolate(&self, t: f64, y: &mut [f64], yp: &mut [f64]) {
        let h = self.t - self.from;
        let s = (t - self.from) / h;
        let rest = 1.0 - s;
        // Of the value and of the slope: the share of the rise, of both slopes, and of what is beyond the cubic.
        let rise = (s * s * (3.0 - 2.0 * s), 6.0 * s * rest / h);
        let first = (h * s * rest * rest, rest * (1.0 - 3.0 * s));
        let last = (-h * s * s * rest, s * (3.0 * s - 2.0));
        let bubble = (h * (s * rest).powi(2), 2.0 * s * rest * (1.0 - 2.0 * s));
        let mut shares = BUBBLE.map(|part| (part * bubble.0, part * bubble.1));
        for (share, more) in [(0, first), (LAST, last)] {
            shares[share].0 += more.0;
            shares[share].1 += more.1;
        }
        let ends = (&self.before, &self.y);
        inside(y, yp, ends, rise, (&self.slopes, &shares));
    }
}

/// The longest of the lengths in s that are to come back that is no longer than this one.
fn on_ladder(length_s: f64) -> f64 {
    let rung = (RUNGS * length_s.log2() + 1e-9).floor();
    (rung / RUNGS).exp2()
}

#[cfg(test)]
mod tests;
