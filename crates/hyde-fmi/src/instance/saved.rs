//! [`Saved`]: the state of an instance, to return to, or to hand to another instance of the same FMU.

use super::{Instance, Phase, Refusal, Result};
use crate::running::Asked;
use hyde_experiment::RunError;
use hyde_sim::Snapshot;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The first bytes of a saved state.
const MAGIC: &[u8] = b"HYDESTATE1";

/// The state of an instance.
#[derive(Clone, Serialize, Deserialize)]
pub struct Saved {
    phase: Phase,
    asked: Asked,
    set: BTreeMap<usize, f64>,
    pending: bool,
    point: (f64, Vec<f64>),
    placed: bool,
    at_start: bool,
    guards: Vec<f64>,
    run: Option<Snapshot>,
}

impl Saved {
    /// The state as bytes.
    ///
    /// # Errors
    /// It cannot be written: why.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let body = postcard::to_allocvec(self);
        let body = body.map_err(|error| Refusal::Misuse(error.to_string()))?;
        Ok([MAGIC, &body].concat())
    }

    /// The state that bytes hold.
    ///
    /// # Errors
    /// They hold none.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self> {
        let body = bytes.strip_prefix(MAGIC);
        let saved = body.and_then(|body| postcard::from_bytes(body).ok());
        saved.ok_or_else(|| Refusal::Value("these bytes hold no state of an instance".to_owned()))
    }
}

impl Instance {
    /// The state of the instance.
    ///
    /// # Errors
    /// There are no consistent values where it is, or a step is under way.
    pub fn save(&mut self) -> Result<Saved> {
        self.between_steps("the state is saved")?;
        let run = match self.running {
            Some(_) => Some(self.working(|session| session.snapshot())?),
            None => None,
        };
        Ok(Saved {
            phase: self.phase,
            asked: self.asked,
            set: self.set.clone(),
            pending: self.pending,
            point: self.point.clone(),
            placed: self.placed,
            at_start: self.at_start,
            guards: self.guards.clone(),
            run,
        })
    }

    /// Returns to a state.
    ///
    /// # Errors
    /// It is one of another model, the solver cannot begin there, or a step is under way.
    pub fn restore(&mut self, saved: &Saved) -> Result<()> {
        self.between_steps("a state is restored")?;
        let other = || Refusal::Value("this is the state of another model".to_owned());
        if saved.guards.len() != self.guards.len() {
            return Err(other());
        }
        match &saved.run {
            None => self.running = None,
            Some(snapshot) => {
                if self.running.is_none() || self.asked != saved.asked {
                    (self.asked, self.running) = (saved.asked, None);
                    self.set.clone_from(&saved.set);
                    self.started()?;
                }
                let snapshot = snapshot.clone();
                let done = self.run()?.with(|session| session.restore(snapshot));
                match done.map_err(|failure| self.failed(&RunError::Failed(failure)))? {
                    true => {}
                    false => return Err(other()),
                }
            }
        }
        (self.phase, self.asked) = (saved.phase, saved.asked);
        self.set.clone_from(&saved.set);
        (self.pending, self.placed) = (saved.pending, saved.placed);
        self.at_start = saved.at_start;
        self.point.clone_from(&saved.point);
        self.guards.clone_from(&saved.guards);
        self.outputs = None;
        Ok(())
    }
}
