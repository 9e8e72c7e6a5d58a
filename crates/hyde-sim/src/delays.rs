//! [`Delays`]: the quantities that the model reads a time ago. They are kept along the run by [`past`](crate::past).
//!
//! No step is longer than the shortest delay, so what a step reads has been accepted before: a known function of the time
//! (the method of steps; Bellen and Zennaro, Numerical Methods for Delay Differential Equations, 2003, ch. 4). What is held
//! between events bounds no step: it is known until the next one, and what an event makes of it arrives later. Where the
//! quantity or its slope jumps, the same arrives later at a known instant, and the run ends a step there. At a jump it
//! starts anew. What a delayed value does to others is seen as theirs, so chains and loops of delays need no rule.

use crate::history::{History, Step};
use crate::setup::same_instant;
use hyde_program::Program;

/// The histories of all delayed quantities.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Delays {
    lines: Vec<Line>,
}

#[derive(Clone, serde::Serialize, serde::Deserialize)]
struct Line {
    time_s: f64,
    /// The equations read it: where it jumps they need new consistent values.
    read: bool,
    /// It changes at events alone.
    held: bool,
    history: History,
}

/// Values and slopes of the delayed quantities at an instant, from one side.
pub(crate) struct Limits {
    pub(crate) values: Vec<f64>,
    pub(crate) slopes: Vec<f64>,
}

/// What arrives at an instant.
#[derive(Clone, Copy, Default)]
pub(crate) struct Arrival {
    /// A value jumps.
    pub(crate) jump: bool,
    /// One that the equations read.
    pub(crate) read: bool,
}

impl Delays {
    /// All quantities zero until `t`.
    pub(crate) fn new(program: &Program, t: f64) -> Self {
        let line = |delay: &hyde_program::Delay| Line {
            time_s: delay.time_s,
            read: delay.read,
            held: delay.held,
            history: History::constant(t, 0.0),
        };
        Self {
            lines: program.delays.iter().map(line).collect(),
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Each quantity had one value until `t`.
    pub(crate) fn set_past(&mut self, t: f64, values: &[f64]) {
        for (line, &value) in self.lines.iter_mut().zip(values) {
            line.history = History::constant(t, value);
        }
    }

    /// The delayed values at a time.
    pub(crate) fn read(&self, t: f64, out: &mut [f64]) {
        for (line, value) in self.lines.iter().zip(out) {
            *value = line.history.value(t - line.time_s);
        }
    }

    /// The longest step.
    pub(crate) fn max_step_s(&self) -> f64 {
        let lines = self.lines.iter().filter(|line| !line.held);
        let times = lines.map(|line| line.time_s);
        times.fold(f64::INFINITY, f64::min)
    }

    /// The next instant at which a jump or a kink arrives.
    pub(crate) fn next(&self) -> f64 {
        let arrivals = self.lines.iter().filter_map(Line::arrival);
        arrivals.fold(f64::INFINITY, f64::min)
    }

    /// Whether one arrives now.
    pub(crate) fn due(&self, t: f64) -> bool {
        let mut arrivals = self.lines.iter().filter_map(Line::arrival);
        arrivals.any(|arrival| arrival <= t || same_instant(arrival, t))
    }

    /// From now on what is read lies behind what arrives now.
    pub(crate) fn arrive(&mut self, t: f64) -> Arrival {
        let mut arrival = Arrival::default();
        for line in &mut self.lines {
            while line
                .arrival()
                .is_some_and(|arrival| arrival <= t || same_instant(arrival, t))
            {
                let jumps = line.history.next_piece();
                arrival.jump |= jumps;
                arrival.read |= jumps && line.read;
            }
        }
        arrival
    }

    /// Keeps in mind what jumps or bends at an instant, by its limits on both sides.
    pub(crate) fn mark(&mut self, t: f64, left: &Limits, right: &Limits) {
        for (number, line) in self.lines.iter_mut().enumerate() {
            line.history.mark(
                t,
                (left.values[number], left.slopes[number]),
                (right.values[number], right.slopes[number]),
            );
        }
    }

    /// Adds a step, or a part of it, with its values at the places of a history.
    pub(crate) fn keep(&mut self, from: f64, to: f64, values: &[Vec<f64>; 7]) {
        for (number, line) in self.lines.iter_mut().enumerate() {
            let values = std::array::from_fn(|place| values[place][number]);
            line.history.push(Step { from, to, values });
        }
    }

    /// Forgets what is not read at `t` or later.
    pub(crate) fn forget(&mut self, t: f64) {
        for line in &mut self.lines {
            line.history.forget(t - line.time_s);
        }
    }
}

impl Line {
    fn arrival(&self) -> Option<f64> {
        self.history.end().map(|end| end + self.time_s)
    }
}
