//! [`Integrator`]: the state, with a solver if there is anything to solve.
//!
//! What the tolerances of a step are is decided here; how a step is taken, by the [`Solver`] inside.

use crate::consistent::Consistent;
use crate::failed_equation::{with_equation, with_values};
use crate::failure::{Failure, FailureKind};
use crate::moment::{At, Moment};
use crate::results::{LeftIda, WhyLeft};
use crate::setup::Setup;
use crate::solver::{Begun, FirstStep, Solver};
use crate::state::State;
use hyde_ida::Error;

/// The state of a run and the solver that advances it.
pub(crate) struct Integrator<'a> {
    solver: Solver<'a>,
    /// Where the run is.
    pub(crate) now: Moment,
    /// Room for values that may turn out not to be consistent.
    room: Moment,
    tolerances: (f64, f64),
    conserve: bool,
    /// Steps since the last start, and the part of the tolerances that a step is given.
    steps: u32,
    part: u32,
    /// The largest value of each unknown so far, and those that the tolerances were made with.
    largest: Vec<f64>,
    allowed: Vec<f64>,
    /// When and why the one-step method took over from IDA.
    left_ida: Option<LeftIda>,
}

/// The solver bounds the error of a step; over a long smooth stretch the errors of many steps add up, an oscillation
/// without losses shows it as drifting energy. Where the run is to conserve energy the tolerance of a step falls with the
/// steps since the last start, from this many on, down to a part of the tolerance asked for. At order 5 that is 2.8 times
/// the steps at most. It never falls below what rounding leaves: there steps become a hundred times shorter and no better.
const SMOOTH_AFTER: u32 = 12;
const LEAST_PART: u32 = 512;
const LEAST_RTOL: f64 = 2e-11;
const LEAST_ATOL: f64 = 1e-2 * LEAST_RTOL;
/// The same for algebraic variables, of the largest value they had: a force is a difference of large ones.
const LEAST_OF_DIFFERENCES: f64 = 1e-9;
/// Of the relative tolerance, how exact in rows all is that follows from states by the equations.
const PART_IN_ROWS: f64 = 1e-3;
/// So many steps after a start are short and of low order.
const SHORT_STEPS: u32 = 16;

impl<'a> Integrator<'a> {
    /// Starts a solver from consistent values.
    pub(crate) fn new(
        state: State<'a>,
        setup: &Setup<'_>,
        now: Moment,
        first_step_s: f64,
    ) -> Result<Self, Box<Failure>> {
        let n = now.y.len();
        let solver = Solver::new(state, setup, now.at(), first_step_s)?;
        Ok(Self {
            solver,
            now,
            room: Moment::default(),
            tolerances: (setup.rtol, setup.atol),
            conserve: setup.conserve,
            steps: 0,
            part: 1,
            largest: vec![0.0; n],
            allowed: vec![0.0; n],
            left_ida: None,
        })
    }

    /// The relative and the absolute tolerance of the run.
    pub(crate) fn tolerances(&self) -> (f64, f64) {
        self.tolerances
    }

    pub(crate) fn state(&self) -> &State<'a> {
        self.solver.state()
    }

    pub(crate) fn state_mut(&mut self) -> &mut State<'a> {
        self.solver.state_mut()
    }

    /// The state, and where the run is.
    pub(crate) fn state_now(&mut self) -> (&mut State<'a>, At<'_>) {
        (self.solver.state_mut(), self.now.at())
    }

    /// One step, never past `stop`. Returns where the step began.
    pub(crate) fn step(
        &mut self,
        stop: f64,
        consistent: &mut Consistent,
    ) -> Result<f64, Box<Failure>> {
        let before = self.now.t;
        if self.solver.creeps() {
            self.begin_anew(WhyLeft::Creeps, consistent)?;
        }
        self.steps = self.steps.saturating_add(1);
        let part = self.steps / SMOOTH_AFTER;
        if self.conserve
            && part.is_power_of_two()
            && (2..=LEAST_PART).contains(&part)
            && self.steps.is_multiple_of(SMOOTH_AFTER)
            && self.tolerances.0 >= LEAST_RTOL * f64::from(part)
        {
            self.set_tolerances(part)?;
        } else if self.has_grown() {
            self.set_tolerances(self.part)?;
        }
        if let Err(error) = self.solver.step(&mut self.now, stop) {
            let failure = self.failure(&error);
            let anew = is_stuck(&error) && self.begin_anew(WhyLeft::Stuck, consistent)?;
            if !anew || self.solver.step(&mut self.now, stop).is_err() {
                return Err(failure);
            }
        }
        self.apply_pins();
        self.note_largest();
        Ok(before)
    }

    /// Begins anew by the one-step method from values and rates that are consistent: those that the iterations of a step
    /// leave are so within its tolerance, which may be far from it where an exponential is steep. Whether it can.
    fn begin_anew(
        &mut self,
        why: WhyLeft,
        consistent: &mut Consistent,
    ) -> Result<bool, Box<Failure>> {
        let mut now = self.now.clone();
        consistent.make_exact(self.state_mut(), &mut now);
        if let Some(flow) = consistent.flow(self.state_mut(), now.at()) {
            now.set_slopes(&self.state().differential, &flow.dy);
        }
        let begun = self.solver.begin_anew(now.at());
        let begun = begun.map_err(|error| self.failure(&error))?;
        if begun == Begun::No {
            return Ok(false);
        }
        self.now = now;
        if begun == Begun::WithoutIda {
            let at_s = self.now.t;
            self.left_ida = Some(LeftIda { at_s, why });
        }
        Ok(true)
    }

    /// Gives the algebraic variables their slopes along the flow.
    pub(crate) fn set_slopes(&mut self, flow: &[f64]) {
        let differential = &self.solver.state().differential;
        self.now.set_slopes(differential, flow);
    }

    /// The largest values, to be given back.
    pub(crate) fn take_largest(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.largest)
    }

    /// The same values again that were the largest before.
    pub(crate) fn set_largest(&mut self, largest: Vec<f64>) {
        self.largest = largest;
    }

    /// Takes note of the largest values.
    pub(crate) fn note_largest(&mut self) {
        for (largest, value) in self.largest.iter_mut().zip(&self.now.y) {
            *largest = largest.max(value.abs());
        }
    }

    /// Takes the last step once more, to end at `end`; returns false where the method cannot.
    pub(crate) fn step_again(&mut self, end: f64) -> Result<bool, Box<Failure>> {
        match self.solver.step_again(&mut self.now, end) {
            Ok(true) => self.apply_pins(),
            Ok(false) => return Ok(false),
            Err(error) => return Err(self.failure(&error)),
        }
        Ok(true)
    }

    /// Room for the values at a time.
    pub(crate) fn room(&self, t: f64) -> Moment {
        Moment::zero(t, self.now.y.len())
    }

    /// Writes the solution at the time of `then`, within the last step; what is not a state follows from the equations where
    /// the method has it less exact than states.
    pub(crate) fn solution(&mut self, consistent: &mut Consistent, then: &mut Moment) {
        let inside = then.t.to_bits() != self.now.t.to_bits();
        let found = inside.then(|| self.solver.solution(then)).flatten();
        self.finish(found.is_some(), then);
        let short = self.steps < SHORT_STEPS && self.solver.has_a_past();
        let part = PART_IN_ROWS * self.tolerances.0;
        let state = self.state();
        let algebraic = self.solver.has_a_past() && state.differential.contains(&false);
        let rough = match found {
            Some(exact) => !exact || short || algebraic,
            None => !self.solver.end_is_exact() || algebraic,
        };
        let state = self.state_mut();
        match rough {
            true => consistent.make_near(state, then, part),
            false => consistent.refine(state, then),
        }
    }

    /// The same where the run is.
    pub(crate) fn settle(&mut self, consistent: &mut Consistent) {
        if !self.solver.end_is_exact() {
            let mut now = self.now.clone();
            consistent.make_exact(self.state_mut(), &mut now);
            self.now = now;
        }
    }

    /// The same, good enough to look for events.
    pub(crate) fn interpolate(&mut self, then: &mut Moment) {
        let inside = then.t.to_bits() != self.now.t.to_bits();
        let found = inside && self.solver.interpolate(then);
        self.finish(found, then);
    }

    /// Consistent values where the run is. Where there are none it stays what it was.
    pub(crate) fn be_consistent(
        &mut self,
        consistent: &mut Consistent,
    ) -> Result<(), Box<Failure>> {
        self.room.clone_from(&self.now);
        consistent.solve(self.solver.state_mut(), &mut self.room, false)?;
        std::mem::swap(&mut self.now, &mut self.room);
        Ok(())
    }

    /// Whether the interpolant is much less exact for rates, and for what is not a state, than for states: IDA's is as long as
    /// its steps are short and of low order, that of a one-step method always.
    pub(crate) fn shows_states_alone(&self) -> bool {
        self.steps < SHORT_STEPS || !self.solver.has_a_past()
    }

    /// Exact values where they are known; at the end of a step those that are there.
    fn finish(&mut self, found: bool, then: &mut Moment) {
        if !found {
            then.y.copy_from_slice(&self.now.y);
            then.yp.copy_from_slice(&self.now.yp);
        }
        let state = self.state_mut();
        state.apply_pins(then);
        state.put_on_surfaces(then);
    }

    /// Starts anew after an event.
    pub(crate) fn restart(&mut self, first: &FirstStep) -> Result<(), Box<Failure>> {
        self.apply_pins();
        if self.part > 1 || self.has_grown() {
            self.set_tolerances(1)?;
        }
        self.steps = 0;
        let started = self.solver.restart(self.now.at(), first);
        started.map_err(|error| self.failure(&error))
    }

    /// The largest value of each unknown so far; none where there is nothing to solve.
    pub(crate) fn largest(&self) -> &[f64] {
        &self.largest
    }

    /// When and why the one-step method took over from IDA.
    pub(crate) fn left_ida(&self) -> Option<LeftIda> {
        self.left_ida
    }

    pub(crate) fn statistics(&self) -> hyde_ida::Statistics {
        self.solver.statistics()
    }

    /// Whether an algebraic variable is twice as large as the tolerances know.
    fn has_grown(&self) -> bool {
        let pairs = self.largest.iter().zip(&self.allowed);
        let atol = self.tolerances.1 / self.tolerances.0;
        // To the end: without a way out the loop takes several at a time.
        pairs.fold(false, |grown, (largest, allowed)| {
            grown | (*largest > 2.0 * allowed.max(atol))
        })
    }

    /// The tolerances of a step. A force is the difference of large ones wherever it passes zero, so that an absolute
    /// tolerance made for states would ask for less than rounding: algebraic variables are measured by the largest value
    /// they had.
    fn set_tolerances(&mut self, part: u32) -> Result<(), Box<Failure>> {
        let (rtol, atol) = self.tolerances;
        self.part = part;
        let part = f64::from(part);
        let least = atol.min(LEAST_ATOL);
        self.allowed.copy_from_slice(&self.largest);
        let differential = &self.solver.state().differential;
        let each: Vec<f64> = differential
            .iter()
            .zip(&self.allowed)
            .map(|(state, largest)| {
                let (own, least) = if *state {
                    (atol, least)
                } else {
                    let own = atol.max(rtol * largest);
                    (own, own.min(LEAST_OF_DIFFERENCES * largest))
                };
                (own / part).max(least)
            })
            .collect();
        let set = self.solver.set_tolerances(rtol / part, &each);
        set.map_err(|error| self.failure(&error))
    }

    /// Whether relations are followed; those that are far from their zeros by now are no longer.
    pub(crate) fn follows(&mut self) -> bool {
        let state = self.solver.state_mut();
        let follows = !state.loose.is_empty();
        state.follow_no_longer(self.now.at());
        follows
    }

    /// Turns relations over if that has no effect where the run is. Whether it has none.
    pub(crate) fn turns_without_effect(&mut self, relations: &[usize]) -> bool {
        let state = self.solver.state_mut();
        state.turns_without_effect(relations, self.now.at())
    }

    /// Exact values where modes fix states, and on the surfaces that the run slides on.
    fn apply_pins(&mut self) {
        let state = self.solver.state_mut();
        state.apply_pins(&mut self.now);
        state.put_on_surfaces(&mut self.now);
    }

    /// A failure with what stands in the equation of a row at the present point.
    pub(crate) fn with_equation(&mut self, failure: Box<Failure>, row: usize) -> Box<Failure> {
        with_equation(failure, self.solver.state_mut(), self.now.at(), row, None)
    }

    /// A failure with the values that conditions read at the present point.
    pub(crate) fn with_values(&mut self, failure: Box<Failure>, of: &[String]) -> Box<Failure> {
        of.iter().fold(failure, |failure, condition| {
            with_values(failure, self.solver.state_mut(), self.now.at(), condition)
        })
    }

    /// What the solver says, with the equation and the unknown it stumbled over.
    fn failure(&mut self, error: &Error) -> Box<Failure> {
        let program = self.state().program;
        let Error::Failed(failed) = error else {
            return Failure::new(FailureKind::Solver(error.to_string()), self.now.t);
        };
        let kind = match failed.kind {
            hyde_ida::FailureKind::Residual | hyde_ida::FailureKind::Jacobian => {
                FailureKind::NotFinite
            }
            hyde_ida::FailureKind::ErrorTest => FailureKind::Solver(format!(
                "the error of a step remains too large even with a step of {:.1e} s",
                failed.step_s
            )),
            hyde_ida::FailureKind::Convergence => FailureKind::Solver(format!(
                "Newton's method does not converge even with a step of {:.1e} s",
                failed.step_s
            )),
            hyde_ida::FailureKind::SingularJacobian => {
                FailureKind::Solver("the Jacobian is singular".to_owned())
            }
            hyde_ida::FailureKind::TooMuchWork
            | hyde_ida::FailureKind::TooMuchAccuracy
            | hyde_ida::FailureKind::RootFunction
            | hyde_ida::FailureKind::InitialConditions
            | hyde_ida::FailureKind::Refused
            | hyde_ida::FailureKind::Other => {
                FailureKind::Solver(format!("{} ({})", failed.message, failed.flag))
            }
        };
        let mut failure = Failure::new(kind, failed.t);
        // Without an equation of its own the unknown leads to the one that it was matched to.
        if let Some(row) = failed.equation.or(failed.unknown) {
            failure = failure.at_row(program, row, &self.now.y);
            let at = At {
                t: failed.t,
                ..self.now.at()
            };
            failure = with_equation(failure, self.solver.state_mut(), at, row, failed.residual);
        }
        if let Some(unknown) = failed.unknown {
            failure = failure.at_unknown(program, unknown, &self.now.y);
        }
        failure
    }
}

/// Whether no step is short enough for the solver: not for its iteration, or not for its error test.
fn is_stuck(error: &Error) -> bool {
    use hyde_ida::FailureKind::{Convergence, ErrorTest};
    matches!(error, Error::Failed(failed) if matches!(failed.kind, Convergence | ErrorTest))
}
