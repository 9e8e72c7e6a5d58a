//! One step of a run: the target it must not pass, the step to the first crossing, and what is to be worked on at its end.

use super::Simulation;
use crate::failure::{Failure, FailureKind};
use crate::guards::Crossing;
use crate::sensitivity::Cause;
use crate::setup::same_instant;
use std::sync::atomic::Ordering;

/// The next instant that is known beforehand, which no step passes.
pub(super) struct Target {
    pub(super) t: f64,
    /// The next jump of a record column.
    jump: f64,
}

/// A step that the solver has taken, up to the first crossing in it.
pub(super) struct Step {
    pub(super) from: f64,
    pub(super) end: f64,
    crossing: Option<Crossing>,
}

impl Step {
    /// The same step up to a time in it, before any crossing.
    pub(super) fn until(self, end: f64) -> Self {
        Self {
            end,
            crossing: None,
            ..self
        }
    }
}

/// Where a step has led.
pub(super) enum Finished {
    /// To something to work on.
    Event(Cause),
    /// To the target.
    There,
    /// Nowhere yet; whether relations are followed.
    OnTheWay { follows: bool },
}

/// What there is to work on at an instant.
pub(super) struct Work {
    pub(super) scheduled: Vec<usize>,
    pub(super) restart: bool,
    pub(super) cause: Cause,
}

impl Simulation<'_> {
    /// The next target, the stop at the latest.
    pub(super) fn next_target(&self, stop: f64) -> Target {
        let t = self.integrator.now.t;
        let jump = self.integrator.state().inputs.next_jump(t);
        let arrival = self.integrator.state().delays.next();
        Target {
            t: self.schedule.next(t).min(jump).min(arrival).min(stop),
            jump,
        }
    }

    /// What there is to work on where the run has come to.
    pub(super) fn work_at(&self, target: &Target, crossed: Option<Cause>) -> Option<Work> {
        let behind = crossed.is_some();
        let t = self.integrator.now.t;
        let at_target = t >= target.t || same_instant(t, target.t);
        let scheduled = if at_target {
            self.schedule.relations_at(t)
        } else {
            Vec::new()
        };
        let arrives = self.integrator.state().delays.due(t);
        let due = at_target && (self.schedule.due(t) || same_instant(t, target.jump) || arrives);
        if !behind && scheduled.is_empty() && !due {
            return None;
        }
        let cause = match crossed {
            Some(cause) => cause,
            None if scheduled.is_empty() => Cause::Time,
            None => Cause::Scheduled(scheduled.clone()),
        };
        Some(Work {
            scheduled,
            restart: behind || same_instant(t, target.jump),
            cause,
        })
    }

    /// Takes one step, never past `target`, and looks for the first crossing of a watched relation in it.
    pub(super) fn take_step(
        &mut self,
        watched: &[usize],
        target: f64,
    ) -> Result<Step, Box<Failure>> {
        if self.setup.interrupted.load(Ordering::Relaxed) {
            return Err(Failure::new(
                FailureKind::Interrupted,
                self.integrator.now.t,
            ));
        }
        let reached = &self.setup.reached;
        reached.set(self.integrator.now.t, self.setup.stop_s);
        let from = self.integrator.step(target, &mut self.consistent)?;
        if let Some(kind) = self.hurry.no_way(self.integrator.now.t, self.setup) {
            return Err(self.no_way(kind, target));
        }
        let crossing = self.first_crossing(watched, from)?;
        let end = crossing
            .as_ref()
            .map_or(self.integrator.now.t, |crossing| crossing.t);
        Ok(Step {
            from,
            end,
            crossing,
        })
    }

    /// Goes on to the end of a step: rows on the way are taken, and the values at a crossing are consistent.
    pub(super) fn finish_step(
        &mut self,
        step: Step,
        target: f64,
    ) -> Result<Finished, Box<Failure>> {
        let Step {
            from,
            end,
            crossing,
        } = step;
        let (followers, mut run) = self.followers();
        followers.stepped(&mut run, (from, end));
        if let Some(crossing) = crossing {
            self.stand_at(crossing.t)?;
            let (followers, mut run) = self.followers();
            followers.at_crossing(&mut run);
            let relation = crossing.relations[0];
            self.crossed = crossing.relations;
            return Ok(Finished::Event(Cause::Crossing { relation, from }));
        }
        let follows = self.integrator.follows();
        let there = self.integrator.now.t >= target || same_instant(self.integrator.now.t, target);
        let works = there || !self.program.selections.is_empty();
        if there {
            self.integrator.settle(&mut self.consistent);
        }
        let (followers, mut run) = self.followers();
        followers.at_end(&mut run, works);
        if self.chooses_states_anew()? {
            return Ok(Finished::Event(Cause::Time));
        }
        Ok(if there {
            Finished::There
        } else {
            Finished::OnTheWay { follows }
        })
    }

    /// Puts the run to a time within the last step. The interpolant of forces and derivatives is not exact; what follows
    /// decides on exact ones.
    pub(super) fn stand_at(&mut self, t: f64) -> Result<(), Box<Failure>> {
        let mut then = self.integrator.room(t);
        self.integrator.interpolate(&mut then);
        self.consistent
            .solve(self.integrator.state_mut(), &mut then, false)?;
        self.integrator.now = then;
        Ok(())
    }
}
