//! [`Snapshot`]: where a run is, to return to it, or to begin there in another process. The solver begins anew from there.

use super::Simulation;
use super::step::Work;
use crate::clocks::Schedule;
use crate::delays::Delays;
use crate::failure::{Failure, FailureKind};
use crate::moment::Moment;
use crate::sensitivity::Cause;
use crate::slide::Slide;
use serde::{Deserialize, Serialize};

/// Where a run is.
#[derive(Clone, Serialize, Deserialize)]
pub struct Snapshot {
    now: Moment,
    p: Vec<f64>,
    z: Vec<f64>,
    since_s: f64,
    delays: Delays,
    pinned: Vec<(usize, f64)>,
    located: Vec<(usize, f64)>,
    doubtful: Vec<(usize, f64)>,
    loose: Vec<(usize, f64)>,
    slides: Vec<Slide>,
    differential: Vec<bool>,
    schedule: Schedule,
    conditions: Vec<bool>,
    largest: Vec<f64>,
    /// The relations whose crossing waits at the instant, if something does.
    waits: Option<Vec<usize>>,
}

impl Simulation<'_> {
    /// Where the caller is. A model with delays goes on from there anew: what it reads later is recorded up to there.
    pub(crate) fn snapshot(&mut self) -> Result<Snapshot, Box<Failure>> {
        if let Some(part) = self.program.foreign.first() {
            let reason = format!("the state of the FMU `{}` cannot be kept", part.file);
            return Err(
                Failure::new(FailureKind::Solver(reason), self.integrator.now.t)
                    .at_origin(&part.origin),
            );
        }
        if !self.program.delays.is_empty() {
            self.cut()?;
        }
        let mut now = self.place().clone();
        if self.is_ahead() {
            self.consistent
                .solve(self.integrator.state_mut(), &mut now, false)?;
        }
        let waits = self.waits_for_caller().then(|| self.crossed.clone());
        let state = self.integrator.state();
        Ok(Snapshot {
            now,
            p: state.p.clone(),
            z: state.z.clone(),
            since_s: state.inputs.since_s(),
            delays: state.delays.clone(),
            pinned: state.pinned.clone(),
            located: state.located.clone(),
            doubtful: state.doubtful.clone(),
            loose: state.loose.clone(),
            slides: state.slides.clone(),
            differential: state.differential.clone(),
            schedule: self.schedule.clone(),
            conditions: self.conditions.clone(),
            largest: self.integrator.largest().to_vec(),
            waits,
        })
    }

    /// Returns to where a run of this program was. Whether the snapshot is one of it; if not, nothing changes.
    pub(crate) fn restore(&mut self, snapshot: Snapshot) -> Result<bool, Box<Failure>> {
        let (n, state) = (self.program.n_unknowns, self.integrator.state());
        let same = snapshot.now.y.len() == n
            && snapshot.now.yp.len() == n
            && snapshot.largest.len() == n
            && snapshot.p.len() == state.p.len()
            && snapshot.z.len() == state.z.len()
            && snapshot.differential.len() == n
            && snapshot.conditions.len() == self.conditions.len();
        if !same {
            return Ok(false);
        }
        self.forget_pieces();
        let integrator = &mut self.integrator;
        integrator.now = snapshot.now;
        integrator.set_largest(snapshot.largest);
        let state = integrator.state_mut();
        (state.p, state.z) = (snapshot.p, snapshot.z);
        state.inputs.stay_since(snapshot.since_s);
        state.delays = snapshot.delays;
        (state.pinned, state.located) = (snapshot.pinned, snapshot.located);
        (state.doubtful, state.loose) = (snapshot.doubtful, snapshot.loose);
        (state.slides, state.differential) = (snapshot.slides, snapshot.differential);
        (self.schedule, self.conditions) = (snapshot.schedule, snapshot.conditions);
        (self.hurry, self.in_vain) = Default::default();
        self.crossed.clear();
        self.trail.clear();
        let t = self.integrator.now.t;
        if let Some(crossed) = snapshot.waits {
            let scheduled = self.schedule.relations_at(t);
            let cause = match (crossed.first(), scheduled.is_empty()) {
                (Some(&relation), _) => Cause::Crossing { relation, from: t },
                (None, false) => Cause::Scheduled(scheduled.clone()),
                (None, true) => Cause::Time,
            };
            self.crossed = crossed;
            self.wait(Work {
                scheduled,
                restart: true,
                cause,
            });
        }
        self.restart()?;
        self.stand();
        Ok(true)
    }
}
