//! [`Solver`]: what advances the state, chosen by the run's setup.

use crate::creeping::Creeping;
use crate::failure::{Failure, FailureKind};
use crate::moment::{At, Moment};
use crate::runge_kutta::{Factors, RungeKutta};
use crate::setup::Setup;
use crate::state::State;
use hyde_ida::{Error, Ida, LinearMethod, Options, Pattern, Statistics};
use hyde_program::{Method, Program, Relation, RelationUse, Target};

/// A solver that owns the state.
pub(crate) enum Solver<'a> {
    /// No continuous unknowns: time passes in strides, in s, for guards may still move with it.
    Nothing {
        state: Box<State<'a>>,
        stride_s: f64,
    },
    Ida(Box<Multistep<'a>>),
    RungeKutta(Box<RungeKutta<State<'a>>>),
}

/// How a solver has begun anew.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Begun {
    No,
    /// By the one-step method, as before.
    Again,
    /// By the one-step method instead of IDA.
    WithoutIda,
}

/// What bounds the first step, in s.
pub(crate) struct FirstStep {
    /// A step of order 1 is as exact as the tolerance asks, and a small part of what is left of the run.
    pub(crate) by_curvature_s: f64,
    /// Longer ones may step over what has just begun.
    pub(crate) longest_s: f64,
}

/// IDA, and what the change to the one-step method takes.
pub(crate) struct Multistep<'a> {
    ida: Ida<State<'a>>,
    /// Factor of the tolerances that it gets.
    share: f64,
    /// The tolerances before that factor.
    rtol: f64,
    atol: Vec<f64>,
    creeping: Creeping,
    pattern: Pattern,
    /// Whether the errors of algebraic variables count.
    watched: bool,
    max_step_s: f64,
}

/// Of the tolerance, what a step of IDA is given: so the instants of events are as exact as the tolerance, as they are in a
/// program written by hand, whose unknowns are states alone (backlash: 1.3e-5 s at rtol 1e-6 without it, 6e-6 s with it).
const SHARE_OF_A_STEP: f64 = 0.5;

/// Strides that a run without unknowns takes at least.
const LEAST_STRIDES: f64 = 1000.0;

/// The most unknowns of a smooth program for which a one-step method is quicker than IDA, whose steps cost more than the
/// equations there.
const SMALL: usize = 16;

/// The method for a program: where something may happen at any moment, a one-step method, which starts anew at no cost;
/// where all is smooth, IDA, unless the equations are affine and one iteration solves a stage (a shaft of 100 cells takes
/// 0.7 times the time of IDA), or steep as the law of a diode, whose pulses the stages see. IDA too where something is
/// struck, a `when` sets a state: a bounce may be lower than the tolerance, and the steps that IDA begins with are as short.
/// States that are chosen anew need slopes of them all, which a Runge-Kutta method has not.
pub(crate) fn method(program: &Program, asked: Method) -> Method {
    let one_step = match asked {
        Method::Ida => false,
        Method::Esdirk => true,
        Method::Auto => {
            let mut targets = program.assignments.iter().map(|own| own.target);
            let strikes = searched(program).any(|relation| relation.used == RelationUse::When)
                && targets.any(|target| matches!(target, Target::State(_)));
            let changes = searched(program).next().is_some();
            let short = program.affine_in.is_some() || program.n_unknowns <= SMALL;
            !program.clocks.is_empty() || !strikes && (changes || short || program.exponential)
        }
    };
    match one_step && program.selections.is_empty() {
        true => Method::Esdirk,
        false => Method::Ida,
    }
}

/// The least number of steps in a period of a source: of IDA, which looks at the ends of its steps alone, and of the
/// one-step method, which evaluates six points of each. A run that resolves the source takes more anyway.
const STEPS_OF_IDA: f64 = 20.0;
const STEPS_OF_ESDIRK: f64 = 4.0;
/// More steps in a run than these are not asked for by a source alone.
const STEPS_OF_A_RUN: f64 = 1e6;

/// The longest step that does not pass over a part of a period of a sine of the time. A largest step that the user asks for
/// stands instead.
fn longest_in_a_period(program: &Program, setup: &Setup<'_>, method: Method) -> f64 {
    if setup.max_step_s.is_finite() {
        return f64::INFINITY;
    }
    let shortest = (setup.stop_s - setup.start_s) / STEPS_OF_A_RUN;
    let steps = match method {
        Method::Esdirk => STEPS_OF_ESDIRK,
        Method::Ida | Method::Auto => STEPS_OF_IDA,
    };
    let period_s = program.shortest_period_s(&setup.parameters);
    (period_s / steps).max(shortest)
}

/// The relations that may change at a moment that is not known before.
fn searched(program: &Program) -> impl Iterator<Item = &Relation> {
    let relations = program.relations.iter();
    relations.filter(|relation| !relation.scheduled)
}

impl<'a> Solver<'a> {
    /// A solver that stands at consistent values at `t`.
    pub(crate) fn new(
        state: State<'a>,
        setup: &Setup<'_>,
        at: At<'_>,
        first_step_s: f64,
    ) -> Result<Self, Box<Failure>> {
        let program = state.program;
        let stride = state.delays.max_step_s();
        if program.n_unknowns == 0 {
            let of_run = (setup.stop_s - setup.start_s) / LEAST_STRIDES;
            let stride_s = setup.max_step_s.min(setup.row_spacing()).min(stride);
            let stride_s = stride_s.min(of_run);
            let state = Box::new(state);
            return Ok(Self::Nothing { state, stride_s });
        }
        // A force that holds a state still must bound the steps, or its guards are stepped over. Without guards it need
        // not, and a transistor amplifier at rtol 1e-8 takes 47 times the steps with it. Without states nothing else would.
        let guarded = program.relations.iter().any(|relation| !relation.scheduled);
        let moves = state.differential.contains(&true);
        let states_alone = moves && (!guarded || !program.selections.is_empty());
        let failed = |error: Error| Failure::new(FailureKind::Solver(error.to_string()), at.t);
        let jacobian = program.jacobian();
        let pattern = Pattern::new(
            program.n_unknowns,
            jacobian.column_starts.clone(),
            jacobian.rows.clone(),
        );
        let pattern = pattern.map_err(|error| failed(Error::from(error)))?;
        let method = method(program, setup.method);
        let turns_s = longest_in_a_period(program, setup, method);
        let max_step_s = setup.max_step_s.min(state.inputs.max_step_s());
        let max_step_s = max_step_s.min(stride).min(turns_s);
        let atol = vec![setup.atol; program.n_unknowns];
        if method == Method::Esdirk {
            let ticks = !program.clocks.is_empty();
            let factors = Factors::new(pattern, ticks).map_err(failed)?;
            let states = state.differential.clone();
            let mut solver = RungeKutta::new(state, factors, states, !states_alone, max_step_s, at);
            solver.set_tolerances(setup.rtol, &atol);
            return Ok(Self::RungeKutta(Box::new(solver)));
        }
        let share = SHARE_OF_A_STEP
            * match states_alone {
                true => share_of_states(&state),
                false => 1.0,
            };
        let scaled = atol.iter().map(|atol| share * atol).collect();
        let mut options = Options::new(share * setup.rtol, scaled, state.differential.clone());
        options.max_step_s = max_step_s;
        options.suppress_algebraic = states_alone;
        options.first_step_s = Some(first_step_s);
        options.linear_method = LinearMethod::Auto;
        options.steep = program.exponential;
        let ida = Ida::new(state, pattern.clone(), options, at.t, at.y, at.yp).map_err(failed)?;
        Ok(Self::Ida(Box::new(Multistep {
            ida,
            share,
            rtol: setup.rtol,
            atol,
            creeping: Creeping::default(),
            pattern,
            watched: !states_alone,
            max_step_s,
        })))
    }

    pub(crate) fn state(&self) -> &State<'a> {
        match self {
            Self::Nothing { state, .. } => state,
            Self::Ida(multistep) => multistep.ida.system(),
            Self::RungeKutta(solver) => solver.system(),
        }
    }

    pub(crate) fn state_mut(&mut self) -> &mut State<'a> {
        match self {
            Self::Nothing { state, .. } => state,
            Self::Ida(multistep) => multistep.ida.system_mut(),
            Self::RungeKutta(solver) => solver.system_mut(),
        }
    }

    /// Whether its polynomials go through values of earlier steps.
    pub(crate) fn has_a_past(&self) -> bool {
        matches!(self, Self::Ida(_))
    }

    /// Whether IDA creeps, and has taken a step whose length the next could have; asked once before each step.
    pub(crate) fn creeps(&mut self) -> bool {
        match self {
            Self::Ida(multistep) => {
                let begins = multistep.ida.last_step_s() <= 0.0;
                !begins && multistep.creeping.seen(&multistep.ida)
            }
            Self::Nothing { .. } | Self::RungeKutta(_) => false,
        }
    }

    /// Begins anew at `at`, where it stands, by the one-step method if it can.
    pub(crate) fn begin_anew(&mut self, at: At<'_>) -> Result<Begun, Error> {
        let multistep = match self {
            Self::Nothing { .. } => return Ok(Begun::No),
            Self::RungeKutta(solver) => {
                solver.restart(at, f64::INFINITY, f64::INFINITY);
                return Ok(Begun::Again);
            }
            Self::Ida(multistep) => multistep,
        };
        if !multistep.ida.system().program.selections.is_empty() {
            return Ok(Begun::No);
        }
        let factors = Factors::new(multistep.pattern.clone(), false)?;
        replace_with::replace_with_or_abort(self, |solver| match solver {
            Self::Ida(multistep) => Self::RungeKutta(Box::new(multistep.one_step(factors, at))),
            other @ (Self::Nothing { .. } | Self::RungeKutta(_)) => other,
        });
        Ok(Begun::WithoutIda)
    }

    /// One step, never past `stop`; `now` moves to its end.
    pub(crate) fn step(&mut self, now: &mut Moment, stop: f64) -> Result<(), Error> {
        match self {
            Self::Nothing { stride_s, .. } => now.t = stop.min(now.t + *stride_s),
            Self::Ida(multistep) => {
                multistep.ida.step(stop)?;
            }
            Self::RungeKutta(solver) => solver.step(stop)?,
        }
        self.end(now);
        Ok(())
    }

    /// Takes the last step once more, to end at `end`, where `now` moves. Whether the method can; else `now` stays.
    pub(crate) fn step_again(&mut self, now: &mut Moment, end: f64) -> Result<bool, Error> {
        let Self::RungeKutta(solver) = self else {
            return Ok(false);
        };
        let shorter = solver.step_again(end)?;
        if shorter {
            self.end(now);
        }
        Ok(shorter)
    }

    fn end(&self, now: &mut Moment) {
        match self {
            Self::Nothing { .. } => {}
            Self::Ida(multistep) => {
                let ida = &multistep.ida;
                let (t, y, yp) = (ida.t(), ida.y(), ida.yp());
                now.copy_from(At { t, y, yp });
            }
            Self::RungeKutta(solver) => now.copy_from(solver.end()),
        }
    }

    /// Whether all but the states is as exact as they at the end of the last step.
    pub(crate) fn end_is_exact(&self) -> bool {
        match self {
            Self::Nothing { .. } | Self::Ida(_) => true,
            Self::RungeKutta(solver) => solver.end_is_exact(),
        }
    }

    /// Writes the solution at the time of `then`, inside the last step, and returns whether all but the states is as exact as
    /// they are by the method itself; none if there is no solution.
    pub(crate) fn solution(&mut self, then: &mut Moment) -> Option<bool> {
        match self {
            Self::Nothing { .. } => None,
            Self::Ida(_) => self.interpolate(then).then_some(true),
            Self::RungeKutta(solver) => Some(solver.solution(then.t, &mut then.y, &mut then.yp)),
        }
    }

    /// The same, good enough to see what happens inside a step.
    pub(crate) fn interpolate(&self, then: &mut Moment) -> bool {
        match self {
            Self::Nothing { .. } => false,
            Self::Ida(multistep) => {
                let ida = &multistep.ida;
                let values = ida.interpolate(then.t, 0, &mut then.y);
                let rates = |()| ida.interpolate(then.t, 1, &mut then.yp);
                values.and_then(rates).is_ok()
            }
            Self::RungeKutta(solver) => {
                solver.interpolate(then.t, &mut then.y, &mut then.yp);
                true
            }
        }
    }

    /// Starts anew after an event.
    pub(crate) fn restart(&mut self, at: At<'_>, first: &FirstStep) -> Result<(), Error> {
        match self {
            Self::Nothing { .. } => Ok(()),
            Self::Ida(multistep) => {
                let ida = &mut multistep.ida;
                // States chosen anew are the ones whose errors count from here.
                let differential = ida.system().differential.clone();
                ida.set_differential(&differential)?;
                let step_s = first.by_curvature_s.min(first.longest_s);
                ida.reinit(at.t, at.y, at.yp, Some(step_s))
            }
            Self::RungeKutta(solver) => {
                solver.restart(at, first.by_curvature_s, first.longest_s);
                Ok(())
            }
        }
    }

    /// The relative tolerance of a step, and the absolute one of each unknown.
    pub(crate) fn set_tolerances(&mut self, rtol: f64, atol: &[f64]) -> Result<(), Error> {
        match self {
            Self::Nothing { .. } => Ok(()),
            Self::Ida(multistep) => {
                multistep.rtol = rtol;
                multistep.atol.copy_from_slice(atol);
                let share = multistep.share;
                let atol: Vec<f64> = atol.iter().map(|atol| share * atol).collect();
                multistep.ida.set_tolerances(share * rtol, &atol)
            }
            Self::RungeKutta(solver) => {
                solver.set_tolerances(rtol, atol);
                Ok(())
            }
        }
    }

    pub(crate) fn statistics(&self) -> Statistics {
        match self {
            Self::Nothing { .. } => Statistics::default(),
            Self::Ida(multistep) => multistep.ida.statistics(),
            Self::RungeKutta(solver) => solver.statistics(),
        }
    }
}

impl<'a> Multistep<'a> {
    /// The one-step method, at the point where IDA stands, with its counts.
    fn one_step(self, factors: Factors, at: At<'_>) -> RungeKutta<State<'a>> {
        let (counts, step_s) = (self.ida.statistics(), self.ida.last_step_s());
        let state = self.ida.into_system();
        let states = state.differential.clone();
        let longest_s = self.max_step_s;
        let mut solver = RungeKutta::new(state, factors, states, self.watched, longest_s, at);
        solver.set_tolerances(self.rtol, &self.atol);
        solver.restart(at, step_s, f64::INFINITY);
        solver.count_on(counts);
        solver
    }
}

/// Where the errors of states alone count, IDA leaves the others out of the norm but divides by the number of all
/// unknowns. The factor undoes that: the norm is the mean over the states.
fn share_of_states(state: &State<'_>) -> f64 {
    let states = state.differential.iter().filter(|&&is| is).count();
    (states as f64 / state.differential.len() as f64).sqrt()
}
