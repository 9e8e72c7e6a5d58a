//! Clocks: when they tick, and when what they hold changes (C1, C3).
//!
//! Tick k of a clock is at start + phase + k*period, computed by one multiplication: no drift. A held value changes with the
//! tick, or after the clock's delay with the value of its tick.

use crate::failure::Failure;
use crate::moment::At;
use crate::sensitivity::{Sensitivities, Slopes};
use crate::setup::same_instant;
use crate::state::State;
use hyde_program::{Constant, Program};

/// The times of all clocks and the changes of held values that are still to come.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
pub(crate) struct Schedule {
    clocks: Vec<Times>,
    pending: Vec<Pending>,
    /// Relations between the time and parameters, with the instant at which each changes.
    relations: Vec<(usize, f64)>,
}

#[derive(Clone, Copy, serde::Serialize, serde::Deserialize)]
struct Times {
    period: f64,
    delay: f64,
    phase: f64,
    start: f64,
    next: u64,
}

/// A held value that changes later.
#[derive(Clone, serde::Serialize, serde::Deserialize)]
struct Pending {
    t: f64,
    target: usize,
    values: Vec<f64>,
    /// Their derivatives by each parameter, if those are asked for.
    slopes: Vec<Vec<f64>>,
    read: bool,
}

/// What the clocks did at an instant.
#[derive(Default)]
pub(crate) struct Ticked {
    /// Number of ticks.
    pub(crate) ticks: u64,
    /// Whether something that the equations read has changed.
    pub(crate) changed: bool,
    /// Every position of the memory that was written.
    pub(crate) written: Vec<usize>,
}

impl Schedule {
    /// The times, from the parameters. A clock must tick forwards: the number of the first that does not.
    pub(crate) fn new(state: &State<'_>, start: f64) -> Result<Self, usize> {
        let program = state.program;
        let constant = |which| {
            program
                .kernels
                .constant(which, &state.p)
                .unwrap_or(f64::NAN)
        };
        let mut clocks = Vec::new();
        for clock in 0..program.clocks.len() {
            let (period, delay, phase) = (
                constant(Constant::Period(clock)),
                constant(Constant::Delay(clock)),
                constant(Constant::Phase(clock)),
            );
            if !(period > 0.0 && period.is_finite() && delay >= 0.0 && phase.is_finite()) {
                return Err(clock);
            }
            let mut times = Times {
                period,
                delay,
                phase,
                start,
                next: 0,
            };
            while times.at() < start && !same_instant(times.at(), start) {
                times.next += 1;
            }
            clocks.push(times);
        }
        let relations = (0..program.relations.len())
            .filter(|&number| program.relations[number].scheduled)
            .filter_map(|number| {
                let at = program
                    .kernels
                    .constant(Constant::TimeEvent(number), &state.p)?;
                Some((number, at))
            })
            .collect();
        Ok(Self {
            clocks,
            pending: Vec::new(),
            relations,
        })
    }

    /// The period of the fastest clock; infinite if there is none.
    pub(crate) fn shortest_period(&self) -> f64 {
        let periods = self.clocks.iter().map(|times| times.period);
        periods.fold(f64::INFINITY, f64::min)
    }

    /// The next instant at which something is known to happen after `t`.
    pub(crate) fn next(&self, t: f64) -> f64 {
        let ticks = self.clocks.iter().map(Times::at);
        let holds = self.pending.iter().map(|pending| pending.t);
        let relations = self
            .relations
            .iter()
            .map(|(_, at)| *at)
            .filter(|&at| at > t && !same_instant(at, t));
        ticks
            .chain(holds)
            .chain(relations)
            .fold(f64::INFINITY, f64::min)
    }

    /// The scheduled relations whose instant this is.
    pub(crate) fn relations_at(&self, t: f64) -> Vec<usize> {
        self.relations
            .iter()
            .filter(|(_, at)| same_instant(*at, t))
            .map(|(relation, _)| *relation)
            .collect()
    }

    /// Whether a clock ticks or a held value changes now.
    pub(crate) fn due(&self, t: f64) -> bool {
        self.clocks.iter().any(|times| same_instant(times.at(), t))
            || self.pending.iter().any(|p| same_instant(p.t, t))
    }

    /// Runs the clocks that tick now, in data-flow order, and changes what is held; derivatives by parameters go along.
    pub(crate) fn run(
        &mut self,
        state: &mut State<'_>,
        at: At<'_>,
        delayed: &[f64],
        mut slopes: Option<(&Sensitivities, &mut Slopes)>,
    ) -> Result<Ticked, Box<Failure>> {
        let program = state.program;
        let mut ticked = Ticked::default();
        for &clock in &program.clock_order {
            if !same_instant(self.clocks[clock].at(), at.t) {
                continue;
            }
            if let Some((sensitivities, slopes)) = &mut slopes {
                sensitivities.tick(state, clock, at, delayed, slopes);
                ticked.written.extend(program.kernels.tick_targets(clock));
            }
            state.tick(clock, at, delayed);
            let times = (at.t, self.clocks[clock].period);
            state.foreign.tick(program, clock, times, &mut state.z)?;
            self.clocks[clock].next += 1;
            ticked.ticks += 1;
            let slopes = slopes.as_ref().map(|(_, slopes)| &**slopes);
            self.hold(program, state, clock, at.t, slopes);
        }
        for pending in std::mem::take(&mut self.pending) {
            if pending.t > at.t && !same_instant(pending.t, at.t) {
                self.pending.push(pending);
                continue;
            }
            let target = &mut state.z[pending.target..pending.target + pending.values.len()];
            let differs = target
                .iter()
                .zip(&pending.values)
                .any(|(old, new)| old.to_bits() != new.to_bits());
            target.copy_from_slice(&pending.values);
            ticked.changed |= differs && pending.read;
            let places = pending.target..pending.target + pending.values.len();
            if let Some((_, slopes)) = &mut slopes {
                for (slopes, held) in slopes.z.iter_mut().zip(&pending.slopes) {
                    slopes[places.clone()].copy_from_slice(held);
                }
                ticked.written.extend(places);
            }
        }
        Ok(ticked)
    }

    fn hold(
        &mut self,
        program: &Program,
        state: &State<'_>,
        clock: usize,
        t: f64,
        slopes: Option<&Slopes>,
    ) {
        for hold in program.holds.iter().filter(|hold| hold.clock == clock) {
            let source = hold.source..hold.source + hold.len;
            let slopes = slopes.iter().flat_map(|slopes| &slopes.z);
            self.pending.push(Pending {
                slopes: slopes.map(|of| of[source.clone()].to_vec()).collect(),
                t: t + self.clocks[clock].delay,
                target: hold.target,
                values: state.z[source].to_vec(),
                read: hold.read,
            });
        }
    }
}

impl Times {
    fn at(&self) -> f64 {
        // Tick numbers are far below 2^53.
        self.start + self.phase + self.next as f64 * self.period
    }
}
