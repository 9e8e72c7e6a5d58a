//! A run in pieces: to a time that its caller asks for, which the solver may have passed, and on from values that the caller
//! sets or integrates itself.

use super::Simulation;
use super::step::{Finished, Step, Target, Work};
use crate::active::is_active;
use crate::failure::Failure;
use crate::guards;
use crate::moment::Moment;
use crate::past;
use crate::results::Event;
use crate::sensitivity::Cause;
use crate::setup::same_instant;
use crate::slide::margins;
use crate::zero::contradicts;
use hyde_program::Function;
use hyde_signal::Series;

/// Where a run in pieces is.
#[derive(Default)]
pub(super) struct Pieces {
    /// Values at the caller's time.
    place: Moment,
    /// The step that the caller's time is in.
    ahead: Option<(Step, Target)>,
    /// What waits at the caller's time.
    waits: Option<Work>,
}

/// How far a session goes beyond what is asked for, and where it stops before.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Advance {
    /// The solver may take steps that end behind the time asked for: nothing is going to be set there.
    pub may_pass: bool,
    /// Stop in front of an event: the caller asks for it by [`crate::Session::happen`].
    pub stop_at_events: bool,
    /// Stop at the end of each step of the solver before the time asked for.
    pub stop_at_steps: bool,
}

/// How a piece ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advanced {
    /// At the time asked for, all that happens there included.
    There,
    /// In front of an event.
    Waits,
    /// At the end of a step of the solver, in front of an event if there is one.
    OnTheWay,
}

impl Simulation<'_> {
    /// The start, and the solver ready for its first step.
    pub(crate) fn begin(&mut self) -> Result<(), Box<Failure>> {
        self.settle_start()?;
        self.restart()?;
        self.stand();
        Ok(())
    }

    /// The events at the start without the first ticks: the solver's vector and the memory behind them.
    pub(crate) fn first_events(&mut self) -> Result<(Vec<f64>, Vec<f64>), Box<Failure>> {
        self.settle()?;
        let (state, now) = self.integrator.state_now();
        Ok((now.y.to_vec(), state.z.clone()))
    }

    /// Goes on to a time. The steps are those of a whole run where they may pass it.
    pub(crate) fn advance_by_caller(
        &mut self,
        to: f64,
        how: Advance,
    ) -> Result<Advanced, Box<Failure>> {
        loop {
            let mut stepped = false;
            if let Some((step, target)) = self.pieces.ahead.take() {
                if to < step.end && !same_instant(to, step.end) {
                    self.pieces.ahead = Some((step, target));
                    self.look_back(to);
                    return Ok(Advanced::There);
                }
                let crossed = match self.finish_step(step, target.t)? {
                    Finished::Event(cause) => Some(cause),
                    Finished::There | Finished::OnTheWay { .. } => None,
                };
                self.pieces.waits = self.work_at(&target, crossed);
                self.stand();
                stepped = true;
            }
            if let Some(work) = &self.pieces.waits
                && how.stop_at_events
                && work.cause != Cause::Time
            {
                return Ok(Advanced::Waits);
            }
            let t = self.integrator.now.t;
            let there = t >= to || same_instant(t, to);
            if stepped && how.stop_at_steps && !there {
                return Ok(Advanced::OnTheWay);
            }
            self.happen()?;
            if there {
                return Ok(Advanced::There);
            }
            let stop = match how.may_pass {
                true => self.setup.stop_s.max(to),
                false => to,
            };
            let target = self.next_target(stop);
            let watched = guards::active(self.integrator.state());
            let step = self.take_step(&watched, target.t)?;
            self.pieces.ahead = Some((step, target));
        }
    }

    /// Whether something waits at the caller's time.
    pub(crate) fn waits_for_caller(&self) -> bool {
        self.pieces.waits.is_some()
    }

    /// Works on what waits.
    pub(crate) fn happen(&mut self) -> Result<(), Box<Failure>> {
        if let Some(work) = self.pieces.waits.take() {
            self.instant(&work.scheduled, work.restart, &work.cause)?;
            self.stand();
        }
        Ok(())
    }

    /// Values at the caller's time.
    pub(crate) fn place(&self) -> &Moment {
        &self.pieces.place
    }

    /// The outputs there.
    pub(crate) fn outputs_of_caller(&mut self) -> &[f64] {
        let rows = &mut self.followers.rows;
        rows.evaluate(self.integrator.state_mut(), self.pieces.place.at())
    }

    /// The parameter vector.
    pub(crate) fn parameters(&self) -> &[f64] {
        &self.integrator.state().p
    }

    /// Sets the parameter vector at the caller's time, as an instant of its own.
    pub(crate) fn enter_parameters(&mut self, parameters: Vec<f64>) -> Result<(), Box<Failure>> {
        self.stop_here()?;
        let left = past::limits(&mut self.integrator, Some(&mut self.consistent));
        self.integrator.state_mut().p = parameters;
        self.be_consistent()?;
        self.iterate(&[], false)?;
        past::mark(&mut self.integrator, &mut self.consistent, left);
        self.restart()?;
        self.stand();
        Ok(())
    }

    /// Ends the step that the caller's time is in there.
    fn stop_here(&mut self) -> Result<(), Box<Failure>> {
        let t = self.pieces.place.t;
        if let Some((step, target)) = self.pieces.ahead.take() {
            self.finish_step(step.until(t), target.t)?;
            self.stand_at(t)?;
        }
        Ok(())
    }

    /// The same, and the solver goes on from there.
    pub(super) fn cut(&mut self) -> Result<(), Box<Failure>> {
        if self.is_ahead() {
            self.stop_here()?;
            self.restart()?;
            self.stand();
        }
        Ok(())
    }

    /// Whether the solver has passed the caller's time.
    pub(super) fn is_ahead(&self) -> bool {
        self.pieces.ahead.is_some()
    }

    /// Nothing was computed beyond the caller's time, and nothing waits.
    pub(super) fn forget_pieces(&mut self) {
        self.pieces = Pieces::default();
    }

    /// Something waits at the caller's time.
    pub(super) fn wait(&mut self, work: Work) {
        self.pieces.waits = Some(work);
    }

    /// The same within a step of the caller's.
    pub(crate) fn replace_parameters(&mut self, parameters: Vec<f64>) {
        self.integrator.state_mut().p = parameters;
    }

    /// The events that happened since they were last taken.
    pub(crate) fn take_events(&mut self) -> Vec<Event> {
        std::mem::take(&mut self.results.events)
    }

    /// The caller takes values as they are: rows are not kept.
    pub(crate) fn forget_rows(&mut self) {
        self.results.time.clear();
        self.results.columns.iter_mut().for_each(Series::clear);
    }

    /// The next instant that is known beforehand.
    pub(crate) fn next_instant(&self) -> f64 {
        self.next_target(f64::INFINITY).t
    }

    /// Takes states at a time from the caller; the other unknowns follow, from where they were last.
    pub(crate) fn place_at(
        &mut self,
        t: f64,
        positions: &[usize],
        states: &[f64],
    ) -> Result<(), Box<Failure>> {
        let mut place = self.pieces.place.clone();
        place.t = t;
        for (&position, &value) in positions.iter().zip(states) {
            place.y[position] = value;
        }
        let state = self.integrator.state_mut();
        self.consistent.solve(state, &mut place, false)?;
        self.pieces.place = place;
        Ok(())
    }

    /// The root functions there; none of a relation that does not matter, or has no finite value.
    pub(crate) fn roots_of_caller(&mut self) -> Vec<Option<f64>> {
        let program = self.program;
        let place = &self.pieces.place;
        let state = self.integrator.state_mut();
        let roots = state.values(Function::Roots, place.at());
        let state = self.integrator.state();
        let known = roots.into_iter().enumerate();
        known
            .map(|(number, root)| {
                let matters = !program.relations[number].scheduled && is_active(state, number);
                (matters && root.is_finite()).then_some(root)
            })
            .collect()
    }

    /// Takes the caller's place as that of the run. Whether a relation has changed its truth on the way, or a switch that
    /// slides cannot go on.
    pub(crate) fn accept(&mut self) -> bool {
        self.integrator.now = self.pieces.place.clone();
        self.integrator.note_largest();
        !self.passed().is_empty() || self.slides_end()
    }

    /// Whether the force that holds a switch at its surface would have to exceed that of one of its sides.
    fn slides_end(&mut self) -> bool {
        let (state, now) = self.integrator.state_now();
        if state.slides.is_empty() {
            return false;
        }
        let weights = state.weights(now);
        let mut margins = weights.into_iter().flat_map(margins);
        margins.any(|margin| margin < 0.0)
    }

    /// Events at the caller's place.
    pub(crate) fn happen_here(&mut self) -> Result<(), Box<Failure>> {
        let target = self.next_target(f64::INFINITY);
        self.accept();
        self.crossed = self.passed();
        let t = self.integrator.now.t;
        let cause = self
            .crossed
            .first()
            .map(|&relation| Cause::Crossing { relation, from: t });
        if t >= target.t || same_instant(t, target.t) {
            // The caller may be somewhat behind: what happens does so at its own time.
            self.integrator.now.t = target.t;
        }
        if let Some(work) = self.work_at(&target, cause) {
            self.instant(&work.scheduled, true, &work.cause)?;
        } else {
            self.instant(&[], true, &Cause::Time)?;
        }
        self.stand();
        self.pieces.place.t = t;
        Ok(())
    }

    /// The relations whose root function has another sign than their truth.
    fn passed(&mut self) -> Vec<usize> {
        let roots = self.roots_of_caller();
        let z = &self.integrator.state().z;
        let passed = |(number, root): (usize, &Option<f64>)| {
            let root = (*root)?;
            contradicts(root, z[number] != 0.0).then_some(number)
        };
        roots.iter().enumerate().filter_map(passed).collect()
    }

    /// The caller is where the run is.
    pub(super) fn stand(&mut self) {
        self.pieces.place = self.integrator.now.clone();
    }

    /// The caller is at a time within the last step.
    fn look_back(&mut self, t: f64) {
        let place = &mut self.pieces.place;
        place.t = t;
        self.integrator.solution(&mut self.consistent, place);
    }
}
