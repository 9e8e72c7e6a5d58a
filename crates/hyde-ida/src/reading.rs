//! What there is to read from a solver between steps.

use std::ffi::c_int;

use sundials_sys as sys;

use crate::options::check_length;
use crate::{Error, Ida, Statistics, System};

/// The way a root function goes through zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crossing {
    /// From negative to positive.
    Rising,
    /// From positive to negative.
    Falling,
}

impl<S: System> Ida<S> {
    /// The time the solver stands at, in s.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.t
    }

    /// The unknowns at [`t`](Self::t).
    #[must_use]
    pub fn y(&self) -> &[f64] {
        self.y.as_slice()
    }

    /// The derivatives of the unknowns at [`t`](Self::t), those of algebraic variables included.
    #[must_use]
    pub fn yp(&self) -> &[f64] {
        self.yp.as_slice()
    }

    /// The beginning and the end of the last internal step, in s, between which [`interpolate`](Self::interpolate)
    /// holds; before the first step both are where the solver starts.
    #[must_use]
    pub fn last_interval(&self) -> (f64, f64) {
        let end = self.memory.time();
        (end - self.last_step_s(), end)
    }

    /// The size of the last internal step, in s; 0 before the first.
    #[must_use]
    pub fn last_step_s(&self) -> f64 {
        // After a search for initial conditions IDA would give the step size of that.
        if self.memory.steps() == 0 {
            0.0
        } else {
            self.memory.read(sys::IDAGetLastStep)
        }
    }

    /// The size IDA wants for the next internal step, in s.
    #[must_use]
    pub fn next_step_s(&self) -> f64 {
        self.memory.read(sys::IDAGetCurrentStep)
    }

    /// The order of the last internal step; 0 before the first.
    #[must_use]
    pub fn last_order(&self) -> usize {
        self.memory.read(sys::IDAGetLastOrder).unsigned_abs() as usize
    }

    /// Writes to `out` the given derivative (0 for the unknowns themselves) of the polynomial of the last step, at a
    /// time in [`last_interval`](Self::last_interval).
    ///
    /// # Errors
    /// [`Error::OutsideLastStep`], and [`Error::NoSuchDerivative`] above the order of the step.
    pub fn interpolate(&self, t: f64, derivative: usize, out: &mut [f64]) -> Result<(), Error> {
        check_length("out", out.len(), self.y().len())?;
        let (from, to) = self.last_interval();
        let rounding = 100.0 * f64::EPSILON * (to.abs() + (to - from));
        if !(from - rounding..=to + rounding).contains(&t) {
            return Err(Error::OutsideLastStep { t, from, to });
        }
        let largest = self.last_order();
        if derivative > largest {
            return Err(Error::NoSuchDerivative {
                derivative,
                largest,
            });
        }
        // SAFETY: the vector is one of this solver's, and nothing else uses it now: the solver is not `Sync`.
        let flag = unsafe {
            sys::IDAGetDky(
                self.memory.ida(),
                t,
                derivative as c_int,
                self.scratch.raw(),
            )
        };
        self.accept(flag)?;
        out.copy_from_slice(self.scratch.as_slice());
        Ok(())
    }

    /// The root functions found to be zero, with the way they cross; empty unless the last stop was
    /// [`Stopped::Root`](crate::Stopped::Root).
    pub fn roots_found(&self) -> impl Iterator<Item = (usize, Crossing)> + '_ {
        let found = if self.stands_at_root {
            self.crossings.as_slice()
        } else {
            &[]
        };
        found
            .iter()
            .enumerate()
            .filter_map(|(root, crossing)| match crossing.signum() {
                1 => Some((root, Crossing::Rising)),
                -1 => Some((root, Crossing::Falling)),
                _ => None,
            })
    }

    /// The system.
    #[must_use]
    pub fn system(&self) -> &S {
        &self.bridge.get().system
    }

    /// The system, to change what it holds. A change that makes `y` or `y'` jump wants a [`reinit`](Self::reinit).
    #[must_use]
    pub fn system_mut(&mut self) -> &mut S {
        &mut self.bridge.get_mut().system
    }

    /// The system, without the solver.
    #[must_use]
    pub fn into_system(self) -> S {
        let Self { memory, bridge, .. } = self;
        // IDA knows the bridge: it goes first.
        drop(memory);
        bridge.into_system()
    }

    /// What was counted since the solver was made.
    #[must_use]
    pub fn statistics(&self) -> Statistics {
        let (mut counts, memory) = (self.before, &self.memory);
        counts.steps += memory.steps();
        counts.nonlinear_iterations += memory.read(sys::IDAGetNumNonlinSolvIters).unsigned_abs();
        counts.nonlinear_failures += memory
            .read(sys::IDAGetNumNonlinSolvConvFails)
            .unsigned_abs();
        counts.step_solve_failures += memory.read(sys::IDAGetNumStepSolveFails).unsigned_abs();
        counts.error_test_failures += memory.read(sys::IDAGetNumErrTestFails).unsigned_abs();
        let bridge = self.bridge.get();
        counts.residual_evaluations = bridge.residual_evaluations;
        counts.jacobian_evaluations = bridge.jacobian_evaluations;
        counts.root_evaluations = bridge.root_evaluations;
        bridge.linear.counts.write_to(&mut counts);
        counts
    }
}

impl<S: System> std::fmt::Debug for Ida<S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let mut fields = f.debug_struct("Ida");
        fields
            .field("t", &self.t)
            .field("y", &self.y())
            .field("yp", &self.yp());
        fields.finish_non_exhaustive()
    }
}
