//! [`Instance`]: one instance of an FMU, as an importer sets, steps and asks it. What goes wrong is a [`Refusal`] and leaves the
//! instance as it was.

mod derivatives;
mod exchange;
mod saved;
mod steps;
mod values;

pub use self::saved::Saved;
pub use self::steps::{Arrival, Progress};

use self::steps::UnderWay;
use crate::model::Model;
use crate::running::{Asked, Running};
use hyde_experiment::RunError;
use hyde_sim::{Failure, Session};
use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// Instants that an importer with fixed steps may have passed in one.
const MOST_PASSED: usize = 100_000;

/// What an instance is used for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interface {
    /// It integrates itself.
    CoSimulation {
        /// Steps end in front of events, which the importer has worked on.
        event_mode: bool,
        /// A step may end before the time asked for.
        early_return: bool,
    },
    /// The importer integrates.
    ModelExchange,
}

/// Why a call has no effect.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The call is not allowed now, or for this variable.
    Misuse(String),
    /// The value is not allowed.
    Value(String),
    /// The model has no solution.
    Failure(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Misuse(text) | Self::Value(text) | Self::Failure(text) => f.write_str(text),
        }
    }
}

/// What an event has changed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Update {
    /// States have other values.
    pub states_changed: bool,
    /// The next instant in s that is known beforehand.
    pub next_s: Option<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
enum Phase {
    Instantiated,
    Initialization,
    Stepping,
    Event,
    Continuous,
    Terminated,
}

/// One instance of an FMU.
pub struct Instance {
    model: Arc<Model>,
    used: Interface,
    phase: Phase,
    asked: Asked,
    /// Values from the importer by their place in the parameter vector.
    set: BTreeMap<usize, f64>,
    /// Some of them are not in the run yet.
    pending: bool,
    running: Option<Running>,
    outputs: Option<Vec<f64>>,
    /// The step that the importer has begun and that is not at its end.
    under_way: Option<UnderWay>,
    /// Where an importer that integrates has come to; whether the run knows.
    point: (f64, Vec<f64>),
    placed: bool,
    /// Nothing has been asked of the run since it started.
    at_start: bool,
    /// The last value of each guard.
    guards: Vec<f64>,
}

type Result<T> = std::result::Result<T, Refusal>;

impl Instance {
    /// A new instance.
    ///
    /// # Errors
    /// The importer cannot integrate the model itself.
    pub fn new(model: &Arc<Model>, used: Interface) -> Result<Self> {
        if let (Interface::ModelExchange, Some(why)) = (used, &model.interface.no_model_exchange) {
            return Err(Refusal::Misuse(format!("no model exchange: {why}")));
        }
        Ok(Self {
            model: Arc::clone(model),
            used,
            phase: Phase::Instantiated,
            asked: Asked::default(),
            set: BTreeMap::new(),
            pending: false,
            running: None,
            outputs: None,
            under_way: None,
            point: (0.0, Vec::new()),
            placed: true,
            at_start: false,
            guards: vec![1.0; model.interface.guards.len()],
        })
    }

    /// Its model.
    #[must_use]
    pub fn model(&self) -> &Arc<Model> {
        &self.model
    }

    /// Start, stop and tolerance of the importer.
    ///
    /// # Errors
    /// Not before the initialisation, or times that are no run.
    pub fn set_up(&mut self, start: f64, stop: Option<f64>, tolerance: Option<f64>) -> Result<()> {
        self.only(&[Phase::Instantiated], "the experiment is set up")?;
        if !start.is_finite() || stop.is_some_and(|stop| stop <= start) {
            return Err(Refusal::Value(
                "the run would end before it starts".to_owned(),
            ));
        }
        let positive = |value: &f64| value.is_finite() && *value > 0.0;
        self.asked = Asked {
            start_s: Some(start),
            stop_s: stop,
            rtol: tolerance.filter(positive),
        };
        Ok(())
    }

    /// Enters the initialisation.
    ///
    /// # Errors
    /// Not directly after the instance was made.
    pub fn enter_initialization(&mut self) -> Result<()> {
        self.only(&[Phase::Instantiated], "initialisation begins")?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    /// Finds the start.
    ///
    /// # Errors
    /// There is none.
    pub fn exit_initialization(&mut self) -> Result<()> {
        self.only(&[Phase::Initialization], "initialisation ends")?;
        self.started()?;
        self.phase = match self.used {
            Interface::CoSimulation { event_mode, .. } if !event_mode => Phase::Stepping,
            Interface::CoSimulation { .. } | Interface::ModelExchange => Phase::Event,
        };
        Ok(())
    }

    /// The time in s.
    #[must_use]
    pub fn t(&mut self) -> f64 {
        match (&mut self.running, self.used) {
            (Some(_), Interface::ModelExchange) => self.point.0,
            (Some(running), Interface::CoSimulation { .. }) => running.with(|session| session.t()),
            (None, _) => self.asked.start_s.unwrap_or(0.0),
        }
    }

    /// Enters event mode.
    ///
    /// # Errors
    /// Not between steps.
    pub fn enter_event_mode(&mut self) -> Result<()> {
        self.only(&[Phase::Stepping, Phase::Continuous], "event mode begins")?;
        self.phase = Phase::Event;
        Ok(())
    }

    /// Works on the events of the instant.
    ///
    /// # Errors
    /// They have no end, or there are no consistent values behind them.
    pub fn update_discrete_states(&mut self) -> Result<Update> {
        self.only(&[Phase::Event], "discrete states are updated")?;
        self.outputs = None;
        if matches!(self.used, Interface::CoSimulation { .. }) {
            self.working(|session| session.happen())?;
            self.apply()?;
            return Ok(Update::default());
        }
        let before = self.point.1.clone();
        // What happens at the start has happened when the initialisation ends.
        let at_start = std::mem::take(&mut self.at_start) && !self.pending && self.placed;
        let t = self.point.0;
        self.place()?;
        let due = |session: &mut Session<'_>| session.next_instant() <= t + 1e-12 + 1e-13 * t.abs();
        let mut more = !at_start;
        for _ in 0..MOST_PASSED {
            if !more {
                break;
            }
            self.working(|session| session.happen_here())?;
            more = self.run()?.with(due);
        }
        self.take_point();
        let mut changed = before.iter().zip(&self.point.1);
        let states_changed = changed.any(|(a, b)| a.to_bits() != b.to_bits());
        let next = self.run()?.with(|session| session.next_instant());
        Ok(Update {
            states_changed,
            next_s: next.is_finite().then_some(next),
        })
    }

    /// Enters step mode.
    ///
    /// # Errors
    /// Not from event mode.
    pub fn enter_step_mode(&mut self) -> Result<()> {
        self.only(&[Phase::Event], "step mode begins")?;
        self.phase = Phase::Stepping;
        Ok(())
    }

    /// Ends the run.
    pub fn terminate(&mut self) {
        self.phase = Phase::Terminated;
    }

    /// The instance as it was made.
    pub fn reset(&mut self) {
        self.phase = Phase::Instantiated;
        self.asked = Asked::default();
        self.set.clear();
        (self.pending, self.placed) = (false, true);
        (self.running, self.outputs, self.under_way) = (None, None, None);
        self.point = (0.0, Vec::new());
        self.guards.iter_mut().for_each(|guard| *guard = 1.0);
    }

    /// The events since they were last taken, one line each.
    pub fn take_events(&mut self) -> Vec<String> {
        let model = Arc::clone(&self.model);
        let Some(running) = &mut self.running else {
            return Vec::new();
        };
        let events = running.with(|session| session.take_events());
        events.iter().map(|event| model.tell(event)).collect()
    }

    fn only(&self, phases: &[Phase], what: &str) -> Result<()> {
        self.between_steps(what)?;
        match phases.contains(&self.phase) {
            true => Ok(()),
            false => Err(Refusal::Misuse(format!(
                "{what}, but the instance is in the state {:?}",
                self.phase
            ))),
        }
    }

    /// The run, started if it is time.
    fn run(&mut self) -> Result<&mut Running> {
        let missing = || Refusal::Misuse("the run has not begun".to_owned());
        self.running.as_mut().ok_or_else(missing)
    }

    fn started(&mut self) -> Result<()> {
        if self.running.is_none() {
            let parameters = self.allowed_parameters()?;
            let running = Running::start(&self.model, self.asked, parameters);
            self.running = Some(running.map_err(|error| self.failed(&error))?);
            (self.pending, self.placed, self.outputs) = (false, true, None);
            self.take_point();
            self.at_start = true;
        }
        Ok(())
    }

    /// The run at the values that the importer has set last.
    fn current(&mut self) -> Result<()> {
        match self.phase {
            Phase::Instantiated => Err(Refusal::Misuse(
                "it has no value before the initialisation".to_owned(),
            )),
            Phase::Initialization => self.started(),
            Phase::Terminated => Ok(()),
            Phase::Stepping | Phase::Event | Phase::Continuous => {
                if self.used == Interface::ModelExchange {
                    self.place()
                } else {
                    self.apply()
                }
            }
        }
    }

    /// Takes what is set into a run that integrates itself.
    fn apply(&mut self) -> Result<()> {
        if self.pending {
            let parameters = self.allowed_parameters()?;
            self.working(|session| session.set_parameters(parameters))?;
            (self.pending, self.outputs) = (false, None);
        }
        Ok(())
    }

    fn working<T>(
        &mut self,
        work: impl FnOnce(&mut Session<'_>) -> std::result::Result<T, Box<Failure>>,
    ) -> Result<T> {
        let done = self.run()?.with(work);
        done.map_err(|failure| self.failed(&RunError::Failed(failure)))
    }

    fn failed(&self, error: &RunError) -> Refusal {
        Refusal::Failure(self.model.explain(error))
    }
}
