//! Starting and restarting: initial conditions, root functions made ready, the first step.

use std::ffi::c_int;

use sundials_sys as sys;

use crate::options::{check_finite, check_first_step, check_length};
use crate::solver::Ida;
use crate::{Error, FailureKind, System, callback};

/// How often a first step that fails is tried again from the start, each time with a thousandth of its size.
const FIRST_STEP_RETRIES: u32 = 4;
const FIRST_STEP_REDUCTION: f64 = 1e-3;

/// How many steps IDA may take in one call.
const STEPS_AT_A_TIME: u32 = 100;

/// Where the solver was last (re)started, kept since IDA overwrites it even by a step that fails.
pub(crate) struct Start {
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    first_step_s: Option<f64>,
}

/// From what consistent initial conditions are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// The states: the algebraic variables and the derivatives of the states are found.
    States,
    /// The derivatives: all of `y` is found. With `y' = 0`, an equilibrium.
    Derivatives,
}

impl Start {
    pub(crate) fn new(t: f64, y: &[f64], yp: &[f64], first_step_s: Option<f64>) -> Self {
        Self {
            t,
            y: y.to_vec(),
            yp: yp.to_vec(),
            first_step_s,
        }
    }
}

impl<S: System> Ida<S> {
    /// Starts anew from `t` (in s), `y` and `yp`, with order 1; for a jump of the unknowns, their derivatives or the
    /// equations. `first_step_s` is the size of the step to try first; `None` leaves it to IDA.
    ///
    /// The symbolic analysis and the pivots of the Jacobian are kept.
    ///
    /// # Errors
    /// Lengths that differ, numbers that are not finite.
    pub fn reinit(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        first_step_s: Option<f64>,
    ) -> Result<(), Error> {
        check_point(self.y().len(), t, y, yp)?;
        check_first_step(first_step_s)?;
        self.start.t = t;
        self.start.y.copy_from_slice(y);
        self.start.yp.copy_from_slice(yp);
        self.start.first_step_s = first_step_s;
        self.rewind()?;
        self.before.restarts += 1;
        Ok(())
    }

    /// Makes the current `y` and `y'` consistent; `scale` is a later time (in s), the first of interest, by which IDA
    /// judges how fast the solution moves.
    ///
    /// IDA's own search: Newton's method with a line search on a first step of the integration (P. N. Brown,
    /// A. C. Hindmarsh, L. R. Petzold, SIAM J. Sci. Comput. 19 (1998) 1495). If steps have been taken, this is a
    /// restart.
    ///
    /// # Errors
    /// [`Error::Failed`] if none were found; the solver then stands where it stood.
    ///
    /// # Panics
    /// With the panic of a callback.
    pub fn consistent_initial_conditions(&mut self, given: Given, scale: f64) -> Result<(), Error> {
        check_finite("scale", &[scale])?;
        if self.memory.steps() > 0 {
            let (y, yp) = (self.y().to_vec(), self.yp().to_vec());
            self.reinit(self.t, &y, &yp, self.start.first_step_s)?;
        }
        let what = match given {
            Given::States => sys::IDA_YA_YDP_INIT,
            Given::Derivatives => sys::IDA_Y_INIT,
        };
        self.listen();
        // SAFETY: the memory is valid; the callbacks work on the bridge, to which nothing else refers now.
        let flag = unsafe { sys::IDACalcIC(self.memory.ida(), what, scale) };
        if flag < 0 {
            let failure = self.failure(flag, true);
            self.rewind()?;
            self.bridge.resume_panic();
            return Err(Error::Failed(Box::new(failure)));
        }
        // SAFETY: both vectors are ours.
        let flag =
            unsafe { sys::IDAGetConsistentIC(self.memory.ida(), self.y.raw(), self.yp.raw()) };
        self.accept(flag)?;
        self.start.y.copy_from_slice(self.y.as_slice());
        self.start.yp.copy_from_slice(self.yp.as_slice());
        Ok(())
    }

    /// Runs IDA, with further attempts at the first step, and gives its return code.
    pub(crate) fn integrate(&mut self, t_out: f64, task: c_int) -> Result<c_int, Error> {
        let mut retries = 0;
        loop {
            let flag = self.run(t_out, task);
            if flag >= 0 {
                return Ok(flag);
            }
            let failure = self.failure(flag, false);
            let first_step = FIRST_STEP_REDUCTION * self.memory.read(sys::IDAGetActualInitStep);
            let is_first = self.memory.steps() == 0;
            self.go_back()?;
            self.bridge.resume_panic();
            let too_small = first_step <= self.smallest_step_s();
            if !is_first
                || !may_yield_to_a_smaller_step(failure.kind)
                || too_small
                || retries == FIRST_STEP_RETRIES
            {
                return Err(Error::Failed(Box::new(failure)));
            }
            retries += 1;
            self.before.first_step_retries += 1;
            self.set_first_step(Some(first_step))?;
        }
    }

    /// Calls IDA for as many steps as it may take, a few at a time to keep the smallest step up to date.
    fn run(&mut self, t_out: f64, task: c_int) -> c_int {
        let mut steps_left = self.max_steps_per_solve.unwrap_or(u32::MAX);
        loop {
            self.listen();
            let steps = steps_left.min(STEPS_AT_A_TIME);
            let ida = self.memory.ida();
            let (y, yp, t) = (self.y.raw(), self.yp.raw(), &raw mut self.t);
            // SAFETY: memory and vectors are valid; the callbacks work on the bridge, to which nothing else refers now.
            // The two settings cannot fail: neither number is negative.
            let flag = unsafe {
                sys::IDASetMinStep(ida, self.smallest_step_s());
                sys::IDASetMaxNumSteps(ida, i64::from(steps));
                sys::IDASolve(ida, t_out, t, y, yp, task)
            };
            if self.max_steps_per_solve.is_some() {
                steps_left -= steps;
            }
            if flag != sys::IDA_TOO_MUCH_WORK || steps_left == 0 {
                return flag;
            }
        }
    }

    /// The size, in s, below which a step would be lost in the rounding of the time. Without such a limit IDA would
    /// creep up to a point it cannot pass in ever smaller steps, without end.
    fn smallest_step_s(&self) -> f64 {
        (16.0 * f64::EPSILON * self.memory.time().abs()).min(self.max_step_s)
    }

    /// Tells IDA of root functions and of the first step, after it was told of the initial conditions.
    pub(crate) fn begin(&mut self) -> Result<(), Error> {
        self.set_first_step(self.start.first_step_s)?;
        let n_roots = self.directions.len() as c_int;
        if n_roots == 0 {
            return Ok(());
        }
        let ida = self.memory.ida();
        // A root function that was 0 at an earlier start is off until it leaves 0, which IDA forgets to undo in a
        // restart: a crossing in the first step would be missed. Announcing the functions anew turns all of them on.
        // SAFETY: the callback is made for the bridge that is IDA's user data.
        let flag = unsafe {
            sys::IDARootInit(ida, 0, None);
            sys::IDARootInit(ida, n_roots, Some(callback::roots::<S>))
        };
        self.accept(flag)?;
        // A function that stays 0 is no reason for a warning on standard output: a mode may hold it there.
        // SAFETY: the memory is valid.
        let flag = unsafe { sys::IDASetNoInactiveRootWarn(ida) };
        self.accept(flag)?;
        self.give_directions()
    }

    /// Puts the solver back to the last accepted point after a failure: the end of the last step, or the start.
    fn go_back(&mut self) -> Result<(), Error> {
        if self.memory.steps() == 0 {
            return self.rewind();
        }
        let (ida, t) = (self.memory.ida(), self.memory.time());
        // SAFETY: memory and vectors are valid, and `t` is the end of the last step.
        let flag = unsafe {
            match sys::IDAGetDky(ida, t, 0, self.y.raw()) {
                sys::IDA_SUCCESS => sys::IDAGetDky(ida, t, 1, self.yp.raw()),
                flag => flag,
            }
        };
        self.t = t;
        self.accept(flag)
    }

    /// Puts the solver to where it was last started.
    fn rewind(&mut self) -> Result<(), Error> {
        self.before = self.statistics();
        self.t = self.start.t;
        self.stands_at_root = false;
        self.y.as_mut_slice().copy_from_slice(&self.start.y);
        self.yp.as_mut_slice().copy_from_slice(&self.start.yp);
        // SAFETY: the memory is valid; IDA copies the vectors.
        let flag =
            unsafe { sys::IDAReInit(self.memory.ida(), self.t, self.y.raw(), self.yp.raw()) };
        self.accept(flag)?;
        self.begin()
    }

    fn set_first_step(&mut self, first_step_s: Option<f64>) -> Result<(), Error> {
        // IDA takes 0 for its own choice.
        let step = first_step_s.unwrap_or(0.0);
        // SAFETY: the memory is valid.
        let flag = unsafe { sys::IDASetInitStep(self.memory.ida(), step) };
        self.accept(flag)
    }

    /// Forgets what was said before, so that a failure tells only of itself.
    fn listen(&mut self) {
        self.context.take_messages();
        self.bridge.get_mut().fault = None;
    }
}

/// Checks lengths and numbers of a point to start from.
pub(crate) fn check_point(n: usize, t: f64, y: &[f64], yp: &[f64]) -> Result<(), Error> {
    check_length("y", y.len(), n)?;
    check_length("yp", yp.len(), n)?;
    check_finite("t", &[t])?;
    check_finite("y", y)?;
    check_finite("yp", yp)
}

fn may_yield_to_a_smaller_step(kind: FailureKind) -> bool {
    match kind {
        FailureKind::ErrorTest
        | FailureKind::Convergence
        | FailureKind::SingularJacobian
        | FailureKind::Residual
        | FailureKind::Jacobian => true,
        FailureKind::TooMuchWork
        | FailureKind::TooMuchAccuracy
        | FailureKind::RootFunction
        | FailureKind::InitialConditions
        | FailureKind::Refused
        | FailureKind::Other => false,
    }
}
