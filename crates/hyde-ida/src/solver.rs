//! The solver: its parts, steps and stops.

use std::ffi::c_int;

use sundials_sys as sys;

use crate::callback::{Bridge, BridgeBox};
use crate::context::Context;
use crate::memory::Memory;
use crate::options::check_finite;
use crate::start::{Start, check_point};
use crate::steep::Steep;
use crate::vector::Vector;
use crate::{Error, Options, Pattern, SparseSolver, Statistics, System};

/// A solver of one system, standing at a time between steps. Time runs forward.
///
/// It can move to another thread, and many can run at once; each has a SUNDIALS context of its own. Reading uses
/// memory of the solver, so one thread at a time:
///
/// ```compile_fail,E0277
/// fn share<T: Sync>() {}
/// fn shared<S: hyde_ida::System + Sync>() {
///     share::<hyde_ida::Ida<S>>();
/// }
/// ```
pub struct Ida<S: System> {
    // The order of the fields is the order in which they are dropped: whatever refers to another goes before it.
    pub(crate) memory: Memory,
    pub(crate) y: Vector,
    pub(crate) yp: Vector,
    pub(crate) scratch: Vector,
    pub(crate) bridge: BridgeBox<S>,
    pub(crate) context: Context,
    pub(crate) t: f64,
    pub(crate) start: Start,
    pub(crate) differential: Vec<bool>,
    pub(crate) suppress_algebraic: bool,
    pub(crate) max_step_s: f64,
    pub(crate) max_steps_per_solve: Option<u32>,
    /// For each root function 1, -1 or 0, as IDA has it: the crossings to stop at, and those found last.
    pub(crate) directions: Vec<c_int>,
    pub(crate) crossings: Vec<c_int>,
    pub(crate) stands_at_root: bool,
    /// What was counted before the last restart.
    pub(crate) before: Statistics,
}

/// Why the solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// At the end of an internal step.
    Step,
    /// At the output time.
    Output,
    /// At the stop time. No step, and so no evaluation of the model, has passed it, unless it was set inside a step
    /// already taken.
    Stop,
    /// At a zero of root functions; [`Ida::roots_found`] says which.
    Root,
}

// SAFETY: all that the pointers lead to is owned by the solver and reached only through it. SUNDIALS keeps its state in
// the context and the memory of each solver, KLU in its factors; neither refers to the thread that made them.
unsafe impl<S: System + Send> Send for Ida<S> {}

impl<S: System> Ida<S> {
    /// A solver for `system` that stands at `t0` (in s) with `y0` and `yp0`, which should be consistent.
    ///
    /// # Errors
    /// Lengths that differ from that of the pattern, numbers that are not finite, options out of range, or too little
    /// memory.
    pub fn new(
        system: S,
        pattern: Pattern,
        options: Options,
        t0: f64,
        y0: &[f64],
        yp0: &[f64],
    ) -> Result<Self, Error> {
        let n = pattern.n();
        options.check(n)?;
        check_point(n, t0, y0, yp0)?;

        let context = Context::new()?;
        let linear = SparseSolver::new(pattern, options.linear_method)?;
        let mut bridge = BridgeBox::new(Bridge::new(
            system,
            linear,
            options.rtol,
            options.atol.clone(),
        ));
        let (y, yp) = (
            Vector::from_slice(y0, &context)?,
            Vector::from_slice(yp0, &context)?,
        );
        let scratch = Vector::new(n, &context)?;
        let memory = Memory::new(&context, &bridge, &options, t0, &y, &yp)?;
        let known = bridge.get_mut();
        known.convergence.of(memory.ida());
        known.steep = options.steep.then(Steep::default);
        let n_roots = known.n_roots;
        let mut solver = Self {
            memory,
            y,
            yp,
            scratch,
            bridge,
            context,
            t: t0,
            start: Start::new(t0, y0, yp0, options.first_step_s),
            differential: options.differential.clone(),
            suppress_algebraic: options.suppress_algebraic,
            max_step_s: options.max_step_s,
            max_steps_per_solve: options.max_steps_per_solve,
            directions: vec![0; n_roots],
            crossings: vec![0; n_roots],
            stands_at_root: false,
            before: Statistics::default(),
        };
        solver.set_max_step(options.max_step_s)?;
        solver.set_differential(&options.differential)?;
        solver.begin()?;
        Ok(solver)
    }

    /// Takes one internal step, never beyond `stop` (in s). Where the step before was cut short by a root or an output
    /// time, goes on to its end instead.
    ///
    /// # Errors
    /// [`Error::Behind`] if `stop` lies before the time reached, [`Error::Failed`] if IDA cannot go on; the solver then
    /// stands where the last good step ended.
    ///
    /// # Panics
    /// With the panic of a callback.
    pub fn step(&mut self, stop: f64) -> Result<Stopped, Error> {
        check_finite("stop", &[stop])?;
        self.stands_at_root = false;
        if self.stands_at(stop)? {
            return Ok(Stopped::Stop);
        }
        if stop < self.memory.time() {
            return self.interpolate_to(stop, Stopped::Stop);
        }
        self.set_stop(stop)?;
        self.advance(stop, sys::IDA_ONE_STEP, Stopped::Step)
    }

    /// Steps until `t_out` is passed, and interpolates there; never steps beyond `stop`, which may be infinite.
    ///
    /// # Errors
    /// As [`step`](Self::step).
    ///
    /// # Panics
    /// With the panic of a callback.
    pub fn solve(&mut self, t_out: f64, stop: f64) -> Result<Stopped, Error> {
        check_finite("t_out", &[t_out])?;
        self.stands_at_root = false;
        let (target, reached) = if stop <= t_out {
            (stop, Stopped::Stop)
        } else {
            (t_out, Stopped::Output)
        };
        if self.stands_at(target)? {
            return Ok(reached);
        }
        if target < self.memory.time() {
            return self.interpolate_to(target, reached);
        }
        self.set_stop(stop)?;
        self.advance(t_out, sys::IDA_NORMAL, Stopped::Output)
    }

    /// Whether the solver stands at this time, up to rounding.
    fn stands_at(&self, t: f64) -> Result<bool, Error> {
        // IDA refuses to begin with a distance below 2 units in the last place.
        let rounding = 4.0 * f64::EPSILON * (self.t.abs() + t.abs());
        if t < self.t - rounding {
            return Err(Error::Behind {
                t: self.t,
                asked: t,
            });
        }
        Ok(t <= self.t + rounding)
    }

    fn set_stop(&mut self, stop: f64) -> Result<(), Error> {
        let ida = self.memory.ida();
        // SAFETY: the memory is valid.
        let flag = unsafe {
            if stop.is_finite() {
                sys::IDASetStopTime(ida, stop)
            } else {
                sys::IDAClearStopTime(ida)
            }
        };
        self.accept(flag)
    }

    /// Goes to a time inside the last internal step, or to a root before it.
    fn interpolate_to(&mut self, t: f64, reached: Stopped) -> Result<Stopped, Error> {
        self.set_stop(f64::INFINITY)?;
        self.advance(t, sys::IDA_NORMAL, reached)
    }

    /// Lets IDA go on; `completed` is what its plain success means.
    fn advance(&mut self, t_out: f64, task: c_int, completed: Stopped) -> Result<Stopped, Error> {
        match self.integrate(t_out, task)? {
            sys::IDA_TSTOP_RETURN => Ok(Stopped::Stop),
            sys::IDA_ROOT_RETURN => {
                // SAFETY: IDA writes one number for each root function.
                let flag =
                    unsafe { sys::IDAGetRootInfo(self.memory.ida(), self.crossings.as_mut_ptr()) };
                self.accept(flag)?;
                self.stands_at_root = true;
                Ok(Stopped::Root)
            }
            _ => Ok(completed),
        }
    }
}
