//! When Newton's method has converged: IDA's test, but for how long it believes what it once saw.
//!
//! IDA estimates the error of the solution from the last correction and the rate at which the corrections fell, and takes
//! that rate for the next steps as well, until a second iteration is needed or the step size changes (`idaNlsConvTest`; A. C.
//! Hindmarsh et al., User Documentation for IDA, "Nonlinear solve"). On a long smooth stretch of equal steps the Jacobian
//! stays that of its begin, and the rate a belief: an algebraic variable, which the error test leaves out, can drift off and
//! grow from step to step without ever being iterated twice. Here the estimate grows with the steps since it was seen, so
//! that it is seen again before it can be wrong by much.
//!
//! The norm of the corrections falls as that of most unknowns. One that the Jacobian does not know, as the voltage of a diode
//! that has just ceased to conduct, may fall by a hundredth from one correction to the next and is lost in the norm of the
//! first: where equations are steep each unknown has a rate of its own, and its error is estimated by it.
//!
//! IDA gives up where the second correction is not smaller than the first. A force that bends with an acceleration,
//! `F = F1*tanh(der(v)/a1)`, is met by a Jacobian of its place in three: the first mends the acceleration.

use std::ffi::{c_int, c_void};
use std::ptr;
use sundials_sys as sys;

/// The estimate after a new Jacobian, and after another step size: none yet.
const NEW_JACOBIAN: f64 = 20.0;
const NEW_STEP: f64 = 100.0;
/// Corrections that fall slower than this do not converge.
const LARGEST_RATE: f64 = 0.9;
/// With the Jacobian of this step the second correction may be so many times the first: the norm knows nothing of derivatives,
/// and where these were predicted badly the first correction is small by chance.
const SECOND: f64 = 4.0;
/// With an old Jacobian slower than this: IDA begins again with a new one.
const SLOW_RATE: f64 = 0.3;
/// A first correction so far below the tolerance needs no second.
const NOTHING: f64 = 1e-8;
/// An unknown whose correction did not fall is as far from its value as so many corrections.
const LARGEST_PART: f64 = 20.0;
/// What an estimate grows by with each step, and what it is at least.
const AGE: f64 = 1.5;
/// A new Jacobian says little of how it will serve later; an old one that serves may do so longer.
const LEAST: f64 = 1e-2;
const LEAST_OF_OLD: f64 = 1e-4;

/// What is known of the convergence.
pub(crate) struct Convergence {
    ida: *mut c_void,
    /// What the error is estimated at, as a part of the last correction.
    part: f64,
    /// What it is taken for at least.
    least: f64,
    /// The norm of the first correction of this step.
    first: f64,
    /// The coefficient of the derivatives in the Jacobian of this step, which is that of its size.
    cj: f64,
    /// Whether the Jacobian is a new one since the last first correction.
    renewed: bool,
    /// Whether it is that of this step.
    current: bool,
    /// The last correction.
    before: Vec<f64>,
}

impl Convergence {
    pub(crate) fn new() -> Self {
        Self {
            ida: ptr::null_mut(),
            part: NEW_JACOBIAN,
            least: LEAST,
            first: 0.0,
            cj: 0.0,
            renewed: true,
            current: true,
            before: Vec::new(),
        }
    }

    /// The solver that the steps are of.
    pub(crate) fn of(&mut self, ida: *mut c_void) {
        self.ida = ida;
    }

    /// The Jacobian is a new one.
    pub(crate) fn renew(&mut self) {
        self.renewed = true;
    }

    /// The solver that the steps are of.
    pub(crate) fn ida(&self) -> *mut c_void {
        self.ida
    }

    /// Whether the Jacobian is that of an earlier step.
    pub(crate) fn is_old(&self) -> bool {
        !self.current
    }

    /// Whether a correction of this norm, the `iteration`th from 0 on, is the last; one of IDA's codes.
    pub(crate) fn test(&mut self, iteration: c_int, norm: f64, cj: f64, tolerance: f64) -> c_int {
        if iteration == 0 {
            let same = cj.to_bits() == self.cj.to_bits();
            self.current = std::mem::take(&mut self.renewed);
            self.part = match (self.current, same) {
                (true, _) => NEW_JACOBIAN,
                (false, false) => NEW_STEP,
                (false, true) => (AGE * self.part.max(self.least)).min(NEW_STEP),
            };
            self.cj = cj;
            self.first = norm;
            if norm <= NOTHING * tolerance {
                return 0;
            }
        } else {
            let rate = (norm / self.first).powf(1.0 / f64::from(iteration));
            let largest = match self.current {
                true => LARGEST_RATE,
                false => SLOW_RATE,
            };
            if rate > largest || rate.is_nan() {
                let second = self.current && iteration == 1 && rate <= SECOND;
                return match second {
                    true => sys::SUN_NLS_CONTINUE,
                    false => sys::SUN_NLS_CONV_RECVR,
                };
            }
            self.part = rate / (1.0 - rate);
            self.least = match self.current {
                true => LEAST,
                false => LEAST_OF_OLD,
            };
        }
        match self.part * norm <= tolerance {
            true => 0,
            false => sys::SUN_NLS_CONTINUE,
        }
    }

    /// The same, if the corrections of each unknown fall as their norm does.
    pub(crate) fn test_each(
        &mut self,
        iteration: c_int,
        (correction, norm): (&[f64], f64),
        weights: &[f64],
        cj: f64,
        tolerance: f64,
    ) -> c_int {
        let code = self.test(iteration, norm, cj, tolerance);
        if code == 0 && (iteration == 0 || self.slowest(correction, weights) <= tolerance) {
            return 0;
        }
        if code == 0 || code == sys::SUN_NLS_CONTINUE {
            self.before.clear();
            self.before.extend_from_slice(correction);
            return sys::SUN_NLS_CONTINUE;
        }
        code
    }

    /// The norm of the errors that unknowns are left with by the rates of their own corrections.
    fn slowest(&self, correction: &[f64], weights: &[f64]) -> f64 {
        let pairs = self.before.iter().zip(correction).zip(weights);
        let squares =
            pairs.map(|((before, last), weight)| (to_come(*before, *last) * weight).powi(2));
        let count = correction.len().max(1) as f64;
        (squares.sum::<f64>() / count).sqrt()
    }
}

/// The sum of the corrections of an unknown that are still to come if they fall as its last two did, `last*r/(1 - r)` with
/// r = last/before.
#[must_use]
pub fn to_come(before: f64, last: f64) -> f64 {
    let (before, last) = (before.abs(), last.abs());
    let fell = (before - last).max(0.0);
    (last * last / fell).min(LARGEST_PART * last)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_that_was_seen_long_ago_is_looked_at_again() {
        let mut own = Convergence::new();
        // A new Jacobian: the first correction is not believed, the second shows that they fall by a million.
        assert_eq!(own.test(0, 1.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(1, 1e-6, 5.0, 0.33), 0);
        // So one is enough in the steps after it; but not for ever.
        let mut believed = || {
            (0..100)
                .take_while(|_| own.test(0, 1.0, 5.0, 0.33) == 0)
                .count()
        };
        assert_eq!(believed(), 8);
        // What an old Jacobian shows holds longer, until it does not serve any more.
        assert_eq!(own.test(1, 1e-6, 5.0, 0.33), 0);
        let mut believed = || {
            (0..100)
                .take_while(|_| own.test(0, 1.0, 5.0, 0.33) == 0)
                .count()
        };
        assert_eq!(believed(), 19);
        assert_eq!(own.test(1, 0.5, 5.0, 0.33), sys::SUN_NLS_CONV_RECVR);
    }

    #[test]
    fn an_unknown_that_falls_slowly_is_not_lost_in_the_norm() {
        let mut own = Convergence::new();
        let mut look = |iteration, correction: [f64; 2]| {
            let norm = (0.5 * (correction[0].powi(2) + correction[1].powi(2))).sqrt();
            own.test_each(iteration, (&correction, norm), &[1.0; 2], 5.0, 0.33)
        };
        assert_eq!(look(0, [1000.0, 16.0]), sys::SUN_NLS_CONTINUE);
        assert_eq!(look(1, [1e-3, 15.9]), sys::SUN_NLS_CONTINUE);
        // If it falls, it is as near as the rest.
        assert_eq!(look(0, [1000.0, 16.0]), sys::SUN_NLS_CONTINUE);
        assert_eq!(look(1, [1e-3, 0.1]), 0);
    }

    #[test]
    fn a_second_correction_may_be_the_largest_with_the_jacobian_of_here() {
        let mut own = Convergence::new();
        assert_eq!(own.test(0, 332.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(1, 415.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(2, 0.05, 5.0, 0.33), 0);
        // Not with an old one, not the third, and not without bounds.
        assert_eq!(own.test(0, 332.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(1, 415.0, 5.0, 0.33), sys::SUN_NLS_CONV_RECVR);
        own.renew();
        assert_eq!(own.test(0, 332.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(1, 415.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(2, 400.0, 5.0, 0.33), sys::SUN_NLS_CONV_RECVR);
        own.renew();
        assert_eq!(own.test(0, 332.0, 5.0, 0.33), sys::SUN_NLS_CONTINUE);
        assert_eq!(own.test(1, 4150.0, 5.0, 0.33), sys::SUN_NLS_CONV_RECVR);
    }
}
