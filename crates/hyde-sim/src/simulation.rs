//! The run itself: start, steps, events, rows.

mod derivatives;
mod followers;
mod instant;
mod point;
mod reduce;
mod rows;
mod run;
mod session;
mod snapshot;
mod steady;
mod step;

pub use self::session::{Advance, Advanced};
pub use self::snapshot::Snapshot;

use self::followers::Followers;
use self::run::Run;
use self::session::Pieces;
use self::step::Finished;
use crate::clocks::Schedule;
use crate::consistent::Consistent;
use crate::failure::{Failure, FailureKind};
use crate::first_step::first_step;
use crate::guards::{self, Crossing, Trail};
use crate::hurry::Hurry;
use crate::initial;
use crate::integrator::Integrator;
use crate::moment::Moment;
use crate::past;
use crate::release::told;
use crate::results::Results;
use crate::selection;
use crate::sensitivity::{Cause, Sensitivities};
use crate::setup::{Setup, same_instant};
use crate::solver::method;
use crate::start_modes::{initial_pins, leave_impossible_modes};
use crate::state::State;
use hyde_program::Program;

/// Relations that are not settled after so many solutions of the initial equations contradict them.
const MAX_ROUNDS_AT_START: usize = 20;

/// How far behind its event a step that is taken once more ends, as a part of it.
const JUST_BEHIND: f64 = 0.01;

/// A run under way.
pub(crate) struct Simulation<'a> {
    setup: &'a Setup<'a>,
    program: &'a Program,
    integrator: Integrator<'a>,
    consistent: Consistent,
    trail: Trail,
    schedule: Schedule,
    conditions: Vec<bool>,
    results: Results,
    followers: Followers<'a>,
    /// The relations that brought the run where it is.
    crossed: Vec<usize>,
    /// Relations that were crossed and stayed as they are, and how often in a row.
    in_vain: (Vec<usize>, u32),
    hurry: Hurry,
    /// Room for the left limit of an instant.
    room: Moment,
    /// Events change relations alone, no modes: they are those of an operating point.
    modes_are_given: bool,
    /// Where it is, if its caller takes it in pieces.
    pieces: Pieces,
}

impl<'a> Simulation<'a> {
    /// Finds the start: initial values, first modes, first ticks.
    pub(crate) fn new(program: &'a Program, setup: &'a Setup<'a>) -> Result<Self, Box<Failure>> {
        let t = setup.start_s;
        let mut state = State::new(program, setup)?;
        let mut consistent = Consistent::new(&state);
        let mut now = initial::start(&mut state, t);
        leave_impossible_modes(&mut state, now.at())?;
        state.pinned = initial_pins(&mut state, now.at());
        let round = initial::Round::First;
        initial::solve(&mut state, &mut consistent, &mut now, round)?;
        // Instants may depend on a parameter that an initial equation finds.
        let schedule = Schedule::new(&state, t).map_err(|clock| {
            let message = format!(
                "the clock `{}` has no positive period",
                program.clocks[clock].name
            );
            Failure::new(FailureKind::Solver(message), t).at_origin(&program.clocks[clock].origin)
        })?;
        if let (Some(_), Some(part)) = (setup.sensitivities, program.foreign.first()) {
            let what = format!("the FMU `{}`, which has no derivatives", part.file);
            return Err(Failure::new(FailureKind::NoGradient(what), t).at_origin(&part.origin));
        }
        let mut sensitivities = match setup.sensitivities {
            Some(chosen) => Some(Sensitivities::new(&state, chosen, t)?),
            None => None,
        };
        if let Some(sensitivities) = &mut sensitivities {
            sensitivities.start(&mut state, &mut consistent, now.at(), round);
        }
        let followers = Followers::new(program, setup, &state, sensitivities);
        let results = followers.rows.results(program);
        let integrator = Integrator::new(state, setup, now, 1e-6)?;
        Ok(Self {
            setup,
            program,
            integrator,
            consistent,
            trail: Trail::default(),
            schedule,
            conditions: vec![false; program.reactions.len()],
            results,
            followers,
            crossed: Vec::new(),
            in_vain: (Vec::new(), 0),
            hurry: Hurry::default(),
            room: Moment::default(),
            modes_are_given: false,
            pieces: Pieces::default(),
        })
    }

    /// Runs to the stop.
    pub(crate) fn run(mut self) -> Result<Results, Box<Failure>> {
        match self.advance_to_stop() {
            Ok(()) => {
                let (followers, mut run) = self.followers();
                followers.point(&mut run);
                self.close();
                Ok(self.results)
            }
            Err(mut failure) => {
                self.close();
                failure.results = self.results;
                Err(failure)
            }
        }
    }

    fn advance_to_stop(&mut self) -> Result<(), Box<Failure>> {
        self.settle_start()?;
        self.advance_to(self.setup.stop_s)
    }

    /// On to a time, events and ticks there included.
    pub(crate) fn advance_to(&mut self, stop: f64) -> Result<(), Box<Failure>> {
        self.restart()?;
        while self.integrator.now.t < stop && !same_instant(self.integrator.now.t, stop) {
            let target = self.next_target(stop);
            // The solver is past a located crossing: it starts anew from there whatever happens.
            let crossed = self.advance(target.t)?;
            if let Some(work) = self.work_at(&target, crossed) {
                self.instant(&work.scheduled, work.restart, &work.cause)?;
            }
        }
        Ok(())
    }

    /// The start itself: events before the first step, first ticks, first rows.
    pub(crate) fn settle_start(&mut self) -> Result<(), Box<Failure>> {
        let t = self.integrator.now.t;
        self.settle()?;
        let state = self.integrator.state();
        self.results.yielded = told(state, &self.integrator.now.y);
        self.results.parameters.clone_from(&state.p);
        let left = past::limits(&mut self.integrator, None);
        let (followers, mut run) = self.followers();
        followers.started(&mut run);
        if self.schedule.due(t) {
            let start = self.limit();
            self.tick(&start)?;
            self.iterate(&[], false)?;
            let (followers, mut run) = self.followers();
            followers.started(&mut run);
        }
        self.followers.rows.begin_behind(t);
        past::mark(&mut self.integrator, &mut self.consistent, left);
        Ok(())
    }

    /// Events at the start. Relations are known only behind the first solution, so initial equations that read them are
    /// solved again; a change of mode keeps the values of the states (I2).
    fn settle(&mut self) -> Result<(), Box<Failure>> {
        let t = self.integrator.now.t;
        let scheduled = self.schedule.relations_at(t);
        let automata = &self.program.automata;
        let modes = |z: &[f64]| {
            automata
                .iter()
                .map(|a| z[a.place].to_bits())
                .collect::<Vec<_>>()
        };
        let initial_modes = modes(&self.integrator.state().z);
        for _ in 0..MAX_ROUNDS_AT_START {
            let changed = self.iterate(&scheduled, true)?;
            let same_modes = modes(&self.integrator.state().z) == initial_modes;
            let states_kept = !same_modes || self.program.n_initial_equations() == 0;
            if !changed || states_kept && self.program.delays.is_empty() {
                return Ok(());
            }
            let round = if states_kept {
                initial::Round::StatesKept
            } else {
                initial::Round::Again
            };
            let mut now = self.integrator.now.clone();
            let state = self.integrator.state_mut();
            initial::solve(state, &mut self.consistent, &mut now, round)?;
            if let Some(sensitivities) = &mut self.followers.sensitivities {
                sensitivities.start(state, &mut self.consistent, now.at(), round);
            }
            self.integrator.now = now;
        }
        let kind = FailureKind::Inconsistent {
            singular: Vec::new(),
            at_start: true,
        };
        Err(Failure::new(kind, t))
    }

    /// Steps until `target` or the first crossing; rows on the way are taken. Returns what there is to work on before the
    /// target; the values there are consistent.
    fn advance(&mut self, target: f64) -> Result<Option<Cause>, Box<Failure>> {
        let mut watched = guards::active(self.integrator.state());
        loop {
            let step = self.take_step(&watched, target)?;
            match self.finish_step(step, target)? {
                Finished::Event(cause) => return Ok(Some(cause)),
                Finished::There => return Ok(None),
                Finished::OnTheWay { follows: true } => {
                    watched = guards::active(self.integrator.state());
                }
                Finished::OnTheWay { follows: false } => {}
            }
        }
    }

    /// The first crossing in the last step, which began at `from`. A one-step method takes a step that ends in an event once
    /// more, so that it ends just behind it: there its interpolant is as exact as its ends.
    fn first_crossing(
        &mut self,
        watched: &[usize],
        from: f64,
    ) -> Result<Option<Crossing>, Box<Failure>> {
        // Where the search begins: behind crossings without effect.
        let mut after = from;
        loop {
            let (integrator, consistent) = (&mut self.integrator, &mut self.consistent);
            let trail = &mut self.trail;
            let found = guards::first_change(integrator, consistent, trail, watched, after);
            let Some(crossing) = &found else {
                return Ok(None);
            };
            if !same_instant(crossing.t, after)
                && integrator.turns_without_effect(&crossing.relations)
            {
                after = crossing.t;
                continue;
            }
            let (before, behind) = (crossing.t - from, integrator.now.t - crossing.t);
            let just_behind = behind < 2.0 * JUST_BEHIND * (before + behind);
            // So near to where it began, the time itself is no more exact.
            let at_its_start = same_instant(crossing.t, from);
            if just_behind
                || at_its_start
                || !integrator.step_again(crossing.t + JUST_BEHIND * before)?
            {
                return Ok(found);
            }
        }
    }

    /// Chooses states anew where the constraints ask for it; the values are consistent then.
    fn chooses_states_anew(&mut self) -> Result<bool, Box<Failure>> {
        if self.program.selections.is_empty() {
            return Ok(false);
        }
        let now = self.integrator.now.clone();
        if !selection::choose_again(self.integrator.state_mut(), now.at()) {
            return Ok(false);
        }
        self.integrator.be_consistent(&mut self.consistent)?;
        self.settled();
        Ok(true)
    }

    /// Starts the solver anew, with a first step that the curvature of the solution allows.
    fn restart(&mut self) -> Result<(), Box<Failure>> {
        self.trail.clear();
        let step = first_step(&mut self.integrator, &mut self.consistent, self.setup);
        self.integrator.restart(&step)
    }

    /// Steps that lead nowhere end the run with the unknown whose rate jumps most from one step to the next, if there is a
    /// next one.
    fn no_way(&mut self, kind: FailureKind, target: f64) -> Box<Failure> {
        let before = self.integrator.now.yp.clone();
        let next = self.integrator.step(target, &mut self.consistent);
        let now = &self.integrator.now.yp;
        let jumps = now
            .iter()
            .zip(&before)
            .map(|(now, before)| (now - before).abs());
        let most = jumps.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        let failure = Failure::new(kind, self.integrator.now.t);
        match most.filter(|_| next.is_ok()) {
            Some((row, _)) => {
                let failure = failure.at_row(self.program, row, &self.integrator.now.y);
                self.integrator.with_equation(failure, row)
            }
            None => failure,
        }
    }

    /// Events that come ever faster end the run with what they are (Zeno). `first` is the first event of this instant.
    fn not_too_many(&mut self, first: usize) -> Result<(), Box<Failure>> {
        let (t, events) = (self.integrator.now.t, &self.results.events);
        let Some(kind) = self.hurry.no_end(t, &events[first..], self.setup) else {
            return Ok(());
        };
        let recent = events.iter().rev().take(4);
        let failure = recent.fold(Failure::new(kind, t), |failure, event| {
            if failure.origins.contains(&event.origin) {
                failure
            } else {
                failure.at_origin(&event.origin)
            }
        });
        let causes: Vec<String> = events
            .iter()
            .rev()
            .take(4)
            .map(|own| own.cause.clone())
            .collect();
        Err(self.integrator.with_values(failure, &causes))
    }

    /// The followers, and the run as they see it.
    fn followers(&mut self) -> (&mut Followers<'a>, Run<'_, 'a>) {
        let run = Run {
            integrator: &mut self.integrator,
            consistent: &mut self.consistent,
            schedule: &self.schedule,
            results: &mut self.results,
        };
        (&mut self.followers, run)
    }

    fn close(&mut self) {
        let solver = self.integrator.statistics();
        let statistics = &mut self.results.statistics;
        statistics.method = method(self.program, self.setup.method);
        statistics.left_ida = self.integrator.left_ida();
        statistics.steps = solver.steps;
        statistics.residual_evaluations = solver.residual_evaluations;
        statistics.jacobian_evaluations = solver.jacobian_evaluations;
        statistics.nonlinear_iterations = solver.nonlinear_iterations;
        statistics.error_test_failures = solver.error_test_failures;
        statistics.nonlinear_failures = solver.nonlinear_failures;
        statistics.restarts = solver.restarts;
        self.followers.ended(&mut self.results);
        self.results.last = (
            self.integrator.now.y.clone(),
            self.integrator.state().z.clone(),
        );
    }
}
