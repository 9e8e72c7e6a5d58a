//! Runs until nothing changes, or all that changes does so evenly and nothing asks for it: an axis that moves at one speed.

use super::Simulation;
use crate::failure::{Failure, FailureKind};
use crate::moment::Moment;
use hyde_program::Constant;

/// So often the time to look back on is doubled.
const DOUBLINGS: u32 = 6;
/// A change below this part of the largest value is none.
const SETTLED: f64 = 1e-6;
/// What goes on evenly is to do so for this many times as long.
const ONWARD: f64 = 1e3;
/// By how much a rate may change on the way, as a part of itself.
const EVEN: f64 = 1e-3;

/// Where a run is at a time.
struct Look {
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    z: Vec<f64>,
}

impl Simulation<'_> {
    /// Goes on until the run is steady.
    pub(crate) fn advance_to_steady(&mut self) -> Result<(), Box<Failure>> {
        let start = self.setup.start_s;
        let mut span = self.whole_ticks(0.5 * (self.setup.stop_s - start));
        self.advance_to(start + span)?;
        let mut before = self.look();
        for doubling in 0..=DOUBLINGS {
            self.advance_to(before.t + span)?;
            let now = self.look();
            let Some(restless) = self.restless(&before, &now) else {
                return Ok(());
            };
            if doubling == DOUBLINGS {
                let name = self.program.unknown_name(restless);
                let kind = FailureKind::NotSteady(name, now.yp[restless]);
                return Err(Failure::new(kind, now.t));
            }
            span = now.t - start;
            before = now;
        }
        Ok(())
    }

    /// A time of whole periods of the slowest clock: between ticks values may go to and fro.
    fn whole_ticks(&self, span: f64) -> f64 {
        let kernels = &self.program.kernels;
        let periods = (0..self.program.clocks.len())
            .filter_map(|clock| kernels.constant(Constant::Period(clock), &self.setup.parameters));
        let longest = periods.fold(0.0, f64::max);
        if longest > 0.0 {
            longest * (span / longest).ceil()
        } else {
            span
        }
    }

    fn look(&self) -> Look {
        let Moment { t, y, yp } = self.integrator.now.clone();
        Look {
            t,
            y,
            yp,
            z: self.integrator.state().z.clone(),
        }
    }

    /// A state that changed otherwise than evenly between two looks, or goes on in a way that something asks for; else none.
    fn restless(&mut self, before: &Look, now: &Look) -> Option<usize> {
        let span = now.t - before.t;
        let differential = self.integrator.state().differential.clone();
        let largest = self.integrator.largest().to_vec();
        let states: Vec<usize> = (0..now.y.len()).filter(|&i| differential[i]).collect();
        let small = |i: usize| SETTLED * largest[i].max(now.y[i].abs()) + 10.0 * self.setup.atol;
        let uneven = |&&i: &&usize| {
            let change = now.y[i] - before.y[i];
            let evenly = (change - now.yp[i] * span).abs() <= small(i);
            let same_rate = (now.yp[i] - before.yp[i]).abs() * span <= 10.0 * small(i);
            !(evenly && same_rate)
        };
        if let Some(state) = states.iter().find(uneven) {
            return Some(*state);
        }
        let growing: Vec<usize> = states
            .iter()
            .copied()
            .filter(|&i| now.yp[i].abs() * span > 10.0 * small(i))
            .collect();
        let first = *growing.first()?;
        if !self.integrator.state().delays.is_empty() {
            return Some(first);
        }
        self.goes_on(before, now, (&states, &growing))
            .map_or(Some(first), |changed| changed)
    }

    /// Whether the rates stay as they are where even changes lead in a long time: the first state whose rate does not, or no
    /// values there at all.
    fn goes_on(
        &mut self,
        before: &Look,
        now: &Look,
        (states, growing): (&[usize], &[usize]),
    ) -> Option<Option<usize>> {
        let along = |before: &[f64], now: &[f64]| -> Vec<f64> {
            let pairs = before.iter().zip(now);
            pairs
                .map(|(before, now)| now + ONWARD * (now - before))
                .collect()
        };
        let t = now.t + ONWARD * (now.t - before.t);
        let (mut y, yp) = (along(&before.y, &now.y), now.yp.clone());
        // What has settled changes by the errors of the solver alone, which lead nowhere.
        for &i in states.iter().filter(|i| !growing.contains(i)) {
            y[i] = now.y[i];
        }
        let mut there = Moment { t, y, yp };
        let state = self.integrator.state_mut();
        state.z = along(&before.z, &now.z);
        for (z, now) in state
            .z
            .iter_mut()
            .zip(&now.z)
            .take(self.program.relations.len())
        {
            *z = *now;
        }
        for automaton in &self.program.automata {
            state.z[automaton.place] = now.z[automaton.place];
        }
        let solved = self.consistent.solve(state, &mut there, false);
        self.integrator.state_mut().z.clone_from(&now.z);
        solved.ok()?;
        let least = |i: usize| SETTLED * now.y[i].abs().max(1e-3) / (now.t - before.t);
        let yp = there.yp;
        let changed = |&&i: &&usize| (yp[i] - now.yp[i]).abs() > EVEN * now.yp[i].abs() + least(i);
        Some(states.iter().find(changed).copied())
    }
}
