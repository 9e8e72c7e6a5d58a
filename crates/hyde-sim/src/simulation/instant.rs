//! What happens at an instant: left limit, events, ticks, events, right limit.

use super::Simulation;
use crate::clocks::Ticked;
use crate::events::Instant;
use crate::failure::Failure;
use crate::moment::Moment;
use crate::past;
use crate::sensitivity::{Cause, Sensitivities, Slopes};
use hyde_program::RelationUse;

/// Relations that are crossed so often in a row and stay as they are will do so without end.
const IN_VAIN: u32 = 4;

/// A guard that stays at its zero for this part of the run is at rest.
const PART_OF_RUN: f64 = 1e-3;

/// Values at an instant, from one side of it.
pub(super) struct Limit {
    values: Moment,
    z: Vec<f64>,
    delayed: Vec<f64>,
    slopes: Option<Slopes>,
}

impl Simulation<'_> {
    /// Everything that happens at an instant: left limit, events, ticks, events, right limit (C1).
    pub(super) fn instant(
        &mut self,
        scheduled: &[usize],
        restart: bool,
        cause: &Cause,
    ) -> Result<(), Box<Failure>> {
        self.trail.clear();
        let crossed = self.crossed.clone();
        let limit = self.limit();
        let (followers, mut run) = self.followers();
        let left = followers.left(&mut run, cause);
        let events = self.results.events.len();
        let arrived = past::arrive(&mut self.integrator, &mut self.consistent)?;
        let t = self.integrator.now.t;
        let entered = self.integrator.state_mut().inputs.enter(t);
        if entered {
            self.be_consistent()?;
        }
        let mut changed = arrived.read | entered;
        changed |= self.iterate(scheduled, false)?;
        if changed || restart || *cause != Cause::Time {
            self.settled();
        }
        let mut ticked = false;
        if self.schedule.due(self.integrator.now.t) {
            ticked = true;
            changed |= self.tick(&limit)?;
            if self.iterate(&[], false)? {
                changed = true;
                self.settled();
            }
        }
        let happened = self.results.events.len() > events;
        self.follow_what_is_crossed_in_vain(&crossed, changed || happened);
        if happened {
            self.results.statistics.events += 1;
            self.not_too_many(events)?;
        }
        let moved = limit
            .z
            .iter()
            .zip(&self.integrator.state().z)
            .any(|(a, b)| a.to_bits() != b.to_bits());
        let stepped = arrived.jump || entered || ticked && moved;
        let (followers, mut run) = self.followers();
        followers.right(&mut run, left, (happened, stepped));
        self.room = limit.values;
        if changed || restart {
            self.restart()?;
        }
        Ok(())
    }

    /// Follows the relations of equations that are crossed and stay as they are, again and again: where a motion ends at a zero
    /// with an upright slope, as of two tanks that equalise, rounding goes to and fro across it.
    fn follow_what_is_crossed_in_vain(&mut self, crossed: &[usize], changed: bool) {
        if changed || crossed.is_empty() || self.in_vain.0 != crossed {
            self.in_vain = (crossed.to_vec(), 0);
        }
        self.in_vain.1 += 1;
        let relations = &self.program.relations;
        let of_equation = |relation: &usize| {
            let known = relations.get(*relation);
            known.is_some_and(|known| known.used == RelationUse::Equation)
        };
        if self.in_vain.1 < IN_VAIN || !crossed.iter().all(of_equation) {
            return;
        }
        let (state, now) = self.integrator.state_now();
        state.follow(crossed, now);
    }

    pub(super) fn iterate(
        &mut self,
        scheduled: &[usize],
        at_start: bool,
    ) -> Result<bool, Box<Failure>> {
        let mut now = std::mem::take(&mut self.integrator.now);
        let largest = self.integrator.take_largest();
        let outcome = Instant {
            state: self.integrator.state_mut(),
            largest: &largest,
            consistent: &mut self.consistent,
            now: &mut now,
            conditions: &mut self.conditions,
            log: &mut self.results.events,
            contradictions: &mut self.results.contradictions,
            sensitivities: self.followers.sensitivities.as_mut(),
            crossed: std::mem::take(&mut self.crossed),
            struck: Vec::new(),
            modes_are_given: self.modes_are_given,
            long_s: PART_OF_RUN * (self.setup.stop_s - self.setup.start_s),
        }
        .iterate(scheduled, at_start);
        self.integrator.now = now;
        self.integrator.set_largest(largest);
        outcome
    }

    /// Consistent values with what the equations read now: guards are to see what a step of an input does to them.
    pub(super) fn be_consistent(&mut self) -> Result<(), Box<Failure>> {
        self.integrator.be_consistent(&mut self.consistent)
    }

    /// The values now.
    pub(super) fn limit(&mut self) -> Limit {
        let t = self.integrator.now.t;
        let delayed = self.integrator.state_mut().delayed_at(t).to_vec();
        let sensitivities = self.followers.sensitivities.as_ref();
        let mut values = std::mem::take(&mut self.room);
        values.clone_from(&self.integrator.now);
        Limit {
            values,
            z: self.integrator.state().z.clone(),
            delayed,
            slopes: sensitivities.map(Sensitivities::snapshot),
        }
    }

    /// Runs the clocks that tick on the left limit, whatever events happened at the instant since (C1); consistent
    /// values follow if something that the equations read has changed.
    pub(super) fn tick(&mut self, left: &Limit) -> Result<bool, Box<Failure>> {
        let state = self.integrator.state_mut();
        let mut memory = std::mem::replace(&mut state.z, left.z.clone());
        let mut slopes = left.slopes.clone();
        let along = self.followers.sensitivities.as_ref().zip(slopes.as_mut());
        let Ticked {
            ticks,
            changed,
            written,
        } = self
            .schedule
            .run(state, left.values.at(), &left.delayed, along)?;
        for ((now, after), before) in memory.iter_mut().zip(&state.z).zip(&left.z) {
            if after.to_bits() != before.to_bits() {
                *now = *after;
            }
        }
        state.z = memory;
        self.results.statistics.ticks += ticks;
        if changed {
            self.be_consistent()?;
        }
        if let (Some(sensitivities), Some(slopes)) = (&mut self.followers.sensitivities, &slopes) {
            sensitivities.take_written(slopes, &written);
            let (state, now) = self.integrator.state_now();
            sensitivities.be_consistent(state, &mut self.consistent, now);
        }
        Ok(changed)
    }

    /// Values behind events are those of the right side so far.
    pub(super) fn settled(&mut self) {
        let (followers, mut run) = self.followers();
        followers.settled(&mut run);
    }
}
