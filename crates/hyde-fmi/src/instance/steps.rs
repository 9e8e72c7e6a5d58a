//! Steps of co-simulation: one call as a whole, or from one step of the solver to the next, where an importer looks on.

use super::{Instance, Interface, Phase, Refusal, Result};
use hyde_sim::{Advance, Advanced};

/// How far an importer may be from the instance's time, relative to it.
const SAME_TIME: f64 = 1e-9;

/// Where a step has led.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Time in s.
    pub t: f64,
    /// An event waits there.
    pub event: bool,
    /// It is before the time asked for.
    pub early: bool,
}

/// How far a step is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The solver has ended one of its own steps at this time in s.
    OnTheWay(f64),
    /// The step has ended.
    Arrived(Arrival),
}

/// A step that is not at its end.
#[derive(Clone, Copy, Debug)]
pub(super) struct UnderWay {
    /// The time in s that was asked for, and the one at which the step ends.
    asked: f64,
    to: f64,
    how: Advance,
}

impl Instance {
    /// A step of the instance's own integration.
    ///
    /// # Errors
    /// It is not where the importer says, it goes beyond the stop time that was set, or the model has no solution.
    pub fn do_step(&mut self, from: f64, step: f64) -> Result<Arrival> {
        self.begin_step(from, step, false)?;
        loop {
            if let Progress::Arrived(arrival) = self.go_on()? {
                return Ok(arrival);
            }
        }
    }

    /// Begins a step, which [`Instance::go_on`] does; where it is `watched`, from one step of the solver to the next.
    ///
    /// # Errors
    /// As for [`Instance::do_step`].
    pub fn begin_step(&mut self, from: f64, step: f64, watched: bool) -> Result<()> {
        self.only(&[Phase::Stepping], "a step is done")?;
        let Interface::CoSimulation { event_mode, .. } = self.used else {
            return Err(Refusal::Misuse("the importer integrates".to_owned()));
        };
        let t = self.t();
        if !(step > 0.0 && step.is_finite()) {
            return Err(Refusal::Value("the step must be positive".to_owned()));
        }
        if (from - t).abs() > SAME_TIME * (step + t.abs()) {
            let text = format!("the instance is at {t} s, not at {from} s");
            return Err(Refusal::Misuse(text));
        }
        if let Some(stop) = self.asked.stop_s
            && from + step - stop > SAME_TIME * (step + stop.abs())
        {
            let to = from + step;
            let text = format!("a step to {to} s is beyond {stop} s, the stop time that was set");
            return Err(Refusal::Misuse(text));
        }
        let how = Advance {
            // What was set at the beginning of this step is likely to be set anew at its end.
            may_pass: !self.pending,
            stop_at_events: event_mode && self.may_return_early(),
            stop_at_steps: watched,
        };
        if self.run()?.with(|session| session.waits()) {
            self.working(|session| session.happen())?;
        }
        self.apply()?;
        let to = from + step;
        self.under_way = Some(UnderWay { asked: to, to, how });
        Ok(())
    }

    /// Goes on with the step that has begun.
    ///
    /// # Errors
    /// There is none, or the model has no solution, which ends it.
    pub fn go_on(&mut self) -> Result<Progress> {
        let none = || Refusal::Misuse("no step is under way".to_owned());
        let step = self.under_way.take().ok_or_else(none)?;
        self.outputs = None;
        let advanced = self.working(|session| session.advance(step.to, step.how))?;
        let t = self.t();
        Ok(match advanced {
            Advanced::OnTheWay => {
                self.under_way = Some(step);
                Progress::OnTheWay(t)
            }
            Advanced::Waits => Progress::Arrived(Arrival {
                t,
                event: true,
                early: t < step.asked,
            }),
            Advanced::There => Progress::Arrived(Arrival {
                t: step.to,
                event: false,
                early: step.to < step.asked,
            }),
        })
    }

    /// Whether a step may end before the time asked for.
    #[must_use]
    pub fn may_return_early(&self) -> bool {
        matches!(
            self.used,
            Interface::CoSimulation {
                early_return: true,
                ..
            }
        )
    }

    /// Ends the step that is under way at an earlier time in s, but not before the time that it has come to.
    pub fn end_step_at(&mut self, t: f64) {
        let reached = self.t();
        if let Some(step) = &mut self.under_way {
            step.to = step.to.min(t.max(reached));
        }
    }

    /// That no step is under way: an importer that looks on within a step may only read.
    pub(super) fn between_steps(&self, what: &str) -> Result<()> {
        match self.under_way {
            None => Ok(()),
            Some(_) => Err(Refusal::Misuse(format!(
                "{what}, but a step is under way, in which values can only be read"
            ))),
        }
    }
}
