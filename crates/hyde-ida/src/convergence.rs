//! When Newton's method has converged: IDA's test, but for how long it believes what it once saw.
//!
//! IDA estimates the error of the solution from the last correction and the rate at which the corrections fell, and takes
//! that rate for the next steps as well, until a second iteration is needed or the step size changes (`idaNlsConvTest`; A. C.
//! Hindmarsh et al., User Documentation for IDA, "Nonlinear solve"). On a long smooth stretch of equal steps the Jacobian
//! stays that of its begin, and the rate a belief: an algebraic variable, which the error test leaves out, can drift off and
//! grow from step to step without ever being iterated twice. Here the estimate grows with the steps since it was seen, so
//! that it is seen again before it can be wrong by much.
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

    /// Whether a correction of this norm, the `iteration`th from 0 on, is the last; one of IDA's codes.
    fn test(&mut self, iteration: c_int, norm: f64, cj: f64, tolerance: f64) -> c_int {
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
}

/// `SUNNonlinSolConvTestFn`.
pub(crate) unsafe extern "C" fn test(
    newton: sys::SUNNonlinearSolver,
    _correction: sys::N_Vector,
    last: sys::N_Vector,
    tolerance: f64,
    weights: sys::N_Vector,
    own: *mut c_void,
) -> c_int {
    // SAFETY: `own` is the `Convergence` in the bridge of this solver, which nothing refers to while IDA runs but the
    // callbacks, of which IDA calls one at a time; the solver, its memory and the vectors are valid.
    unsafe {
        let own = &mut *own.cast::<Convergence>();
        let norm = sys::N_VWrmsNorm(last, weights);
        let (mut iteration, mut cj) = (0, 0.0);
        sys::SUNNonlinSolGetCurIter(newton, &raw mut iteration);
        sys::IDAGetCurrentCj(own.ida, &raw mut cj);
        own.test(iteration, norm, cj, tolerance)
    }
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
