//! [`Exchanged`]: an instance for model exchange, integrated here between the ticks of its component.
//!
//! The method is that of Dormand and Prince of order 5 with steps that it chooses itself. Zeros of event indicators are located
//! on its interpolant; time events end a step. New inputs are an event: they jump at ticks.

use crate::description::FmuVariable;
use crate::dormand_prince::{Step, interpolated, tried};
use crate::library::{Called, Slave};

/// The functions of model exchange, which both versions of the standard have.
pub(crate) trait Exchange: Slave {
    /// Number of states and of event indicators.
    fn counts(&mut self) -> Result<(usize, usize), String>;
    /// Moves to a time.
    fn set_time(&mut self, t: f64) -> Called;
    /// Reads the states.
    fn states(&mut self, values: &mut [f64]) -> Called;
    /// Sets the states.
    fn set_states(&mut self, values: &[f64]) -> Called;
    /// Reads the derivatives of the states.
    fn derivatives(&mut self, values: &mut [f64]) -> Called;
    /// Reads the event indicators.
    fn indicators(&mut self, values: &mut [f64]) -> Called;
    /// Reads the sizes that the states usually have.
    fn nominals(&mut self, values: &mut [f64]) -> Called;
    /// Enters event mode.
    fn enter_event_mode(&mut self) -> Called;
    /// One round of the event iteration.
    fn update(&mut self) -> Result<Updated, String>;
    /// Leaves event mode.
    fn enter_continuous_mode(&mut self) -> Called;
    /// Ends a step; whether the instance asks for an event there.
    fn completed_step(&mut self) -> Result<bool, String>;
}

/// What a round of the event iteration says.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Updated {
    /// Another round is needed.
    pub(crate) again: bool,
    /// The instance ends the simulation.
    pub(crate) terminate: bool,
    /// The next time event.
    pub(crate) next: Option<f64>,
}

/// Relative tolerance if the description proposes none, and at most.
const TOLERANCE: f64 = 1e-6;
/// Rounds of an event iteration, events and steps within a communication step at most.
const MOST_ROUNDS: usize = 100;
const MOST_EVENTS: usize = 10_000;
const MOST_STEPS: usize = 200_000;
/// How exactly an event is located, in the part of a step.
const LOCATED: f64 = 1e-12;

/// An instance with where it is.
pub(crate) struct Exchanged<I> {
    instance: I,
    tolerance: f64,
    t: f64,
    states: Vec<f64>,
    nominals: Vec<f64>,
    indicators: Vec<f64>,
    next: Option<f64>,
    /// The step that the method would choose.
    proposed: f64,
    mode: Mode,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mode {
    Initialising,
    Events,
    Continuous,
}

impl<I: Exchange> Exchanged<I> {
    /// Takes an instance; the tolerance is that of its description.
    pub(crate) fn new(instance: I, tolerance: Option<f64>) -> Self {
        Self {
            instance,
            tolerance: tolerance.map_or(TOLERANCE, |own| own.clamp(1e-12, TOLERANCE)),
            t: 0.0,
            states: Vec::new(),
            nominals: Vec::new(),
            indicators: Vec::new(),
            next: None,
            proposed: f64::INFINITY,
            mode: Mode::Initialising,
        }
    }

    /// Works on the event of now and goes on.
    fn handle_event(&mut self) -> Called {
        if self.mode == Mode::Continuous {
            self.instance.enter_event_mode()?;
        }
        self.mode = Mode::Events;
        let mut rounds = 0;
        loop {
            let updated = self.instance.update()?;
            if updated.terminate {
                let at = hyde_units::significant(self.t, 7);
                return Err(format!("it asked to end the simulation at {at} s"));
            }
            if !updated.again {
                self.next = updated.next.filter(|next| next.is_finite());
                break;
            }
            rounds += 1;
            if rounds > MOST_ROUNDS {
                let at = hyde_units::significant(self.t, 7);
                return Err(format!("its event at {at} s has no end"));
            }
        }
        self.instance.enter_continuous_mode()?;
        self.mode = Mode::Continuous;
        self.instance.states(&mut self.states)?;
        self.instance.nominals(&mut self.nominals)?;
        self.instance.indicators(&mut self.indicators)
    }

    fn derivatives(&mut self, t: f64, states: &[f64]) -> Result<Vec<f64>, String> {
        self.place(t, states)?;
        let mut found = vec![0.0; states.len()];
        self.instance.derivatives(&mut found)?;
        Ok(found)
    }

    fn place(&mut self, t: f64, states: &[f64]) -> Called {
        self.instance.set_time(t)?;
        match states.is_empty() {
            true => Ok(()),
            false => self.instance.set_states(states),
        }
    }

    fn indicators_at(&mut self, t: f64, states: &[f64]) -> Result<Vec<f64>, String> {
        self.place(t, states)?;
        let mut found = vec![0.0; self.indicators.len()];
        self.instance.indicators(&mut found)?;
        Ok(found)
    }

    /// Whether an indicator has another sign than at the beginning of the step.
    fn crossed(&self, indicators: &[f64]) -> bool {
        let pairs = self.indicators.iter().zip(indicators);
        pairs.into_iter().any(|(a, b)| (*a > 0.0) != (*b > 0.0))
    }

    /// A step of the method that its error estimate accepts, to `target` at most.
    fn accepted(&mut self, target: f64, tries: &mut usize) -> Result<Step, String> {
        let (t, states) = (self.t, self.states.clone());
        let first = self.derivatives(t, &states)?;
        let mut width = match self.proposed.is_finite() {
            true => self.proposed,
            false => self.first_width(&first, target - t),
        };
        loop {
            // A rest that is hardly longer than the step is not worth one of its own.
            if t + 1.1 * width >= target {
                width = target - t;
            }
            *tries += 1;
            let at = || hyde_units::significant(t, 7);
            if *tries > MOST_STEPS {
                return Err(format!(
                    "its integration for model exchange takes more than {MOST_STEPS} steps within one communication \
                     step at {} s: it is stiff; export it for co-simulation",
                    at()
                ));
            }
            if t + width <= t {
                return Err(format!(
                    "its derivatives have no finite values at {} s",
                    at()
                ));
            }
            let weights = self.weights();
            let step = tried(t, &states, &first, width, |t, states| {
                self.derivatives(t, states)
            })?;
            let error = step.error(&weights);
            if error <= 1.0 {
                self.proposed = width * (0.9 * error.max(1e-8).powf(-0.2)).clamp(0.2, 5.0);
                return Ok(step);
            }
            let factor = match error.is_finite() {
                true => (0.9 * error.powf(-0.2)).clamp(0.1, 0.9),
                false => 0.1,
            };
            width *= factor;
        }
    }

    fn weights(&self) -> Vec<f64> {
        let pairs = self.states.iter().zip(&self.nominals);
        let weight = |(state, nominal): (&f64, &f64)| {
            let nominal = if *nominal > 0.0 { *nominal } else { 1.0 };
            self.tolerance * (state.abs() + 1e-2 * nominal)
        };
        pairs.map(weight).collect()
    }

    /// A first step in which a state changes by a hundredth of its size.
    fn first_width(&self, derivatives: &[f64], most: f64) -> f64 {
        let pairs = self.states.iter().zip(&self.nominals).zip(derivatives);
        let width = |((state, nominal), rate): ((&f64, &f64), &f64)| {
            0.01 * (state.abs() + nominal.abs()) / rate.abs()
        };
        let least = pairs.map(width).fold(most, f64::min);
        if least > 0.0 { least } else { most * 1e-6 }
    }

    /// Goes to a time, or to the first event before it.
    fn advance(&mut self, target: f64, tries: &mut usize) -> Called {
        let step = self.accepted(target, tries)?;
        let end = if step.width >= target - self.t {
            target
        } else {
            self.t + step.width
        };
        let mut indicators = self.indicators_at(end, &step.to)?;
        let (mut at, mut states, mut event) = (end, step.to.clone(), false);
        if self.crossed(&indicators) {
            event = true;
            let (mut before, mut behind) = (0.0, 1.0);
            while behind - before > LOCATED {
                let middle = 0.5 * (before + behind);
                let t = self.t + middle * step.width;
                let there = interpolated(&step, middle);
                let own = self.indicators_at(t, &there)?;
                if self.crossed(&own) {
                    (behind, at, states, indicators) = (middle, t, there, own);
                } else {
                    before = middle;
                }
            }
            self.place(at, &states)?;
            // What is behind the event has nothing to do with the step before it.
            self.proposed = f64::INFINITY;
        }
        (self.t, self.states, self.indicators) = (at, states, indicators);
        let asked = self.instance.completed_step()?;
        let scheduled = self.next.is_some_and(|next| next <= self.t);
        match event || asked || scheduled {
            true => self.handle_event(),
            false => Ok(()),
        }
    }
}

impl<I: Exchange> Slave for Exchanged<I> {
    fn set(&mut self, variable: &FmuVariable, values: &[f64]) -> Called {
        if self.mode == Mode::Continuous {
            self.instance.enter_event_mode()?;
            self.mode = Mode::Events;
        }
        self.instance.set(variable, values)
    }

    fn get(&mut self, variable: &FmuVariable, values: &mut [f64]) -> Called {
        self.instance.get(variable, values)
    }

    fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Called {
        self.t = start;
        self.instance.enter_initialization(start, stop)
    }

    fn exit_initialization(&mut self) -> Called {
        self.instance.exit_initialization()?;
        let (states, indicators) = self.instance.counts()?;
        self.states = vec![0.0; states];
        self.nominals = vec![1.0; states];
        self.indicators = vec![0.0; indicators];
        self.mode = Mode::Events;
        self.handle_event()
    }

    fn step(&mut self, t: f64, step: f64) -> Called {
        let (end, mut tries) = (t + step, 0);
        if self.mode == Mode::Events {
            self.proposed = f64::INFINITY;
            self.handle_event()?;
        }
        for _ in 0..MOST_EVENTS + MOST_STEPS {
            if end - self.t <= 1e-12 * step {
                self.t = end;
                return self.place_end();
            }
            let next = self.next.filter(|next| *next > self.t);
            self.advance(next.map_or(end, |next| next.min(end)), &mut tries)?;
        }
        let at = hyde_units::significant(self.t, 7);
        Err(format!(
            "its events within one communication step at {at} s have no end"
        ))
    }
}

impl<I: Exchange> Exchanged<I> {
    /// The end of a communication step, to the last bit.
    fn place_end(&mut self) -> Called {
        let states = self.states.clone();
        self.place(self.t, &states)
    }
}
