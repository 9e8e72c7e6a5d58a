//! [`Sensitivities`]: the derivatives of a run by parameters, carried along with it (S1).
//!
//! ```text
//! between events    F_y s + F_y' s' + F_z s_z + F_p = 0, linear in s               sensitivity/propagate.rs
//! at an event       dt/dp = -(g_s)/(g along the flow); derivatives along the moving instant, through what the event
//!                   assigns, then back to a fixed time                             sensitivity/instant.rs
//! at the start      from start values and the linearised initial system            sensitivity/start.rs
//! ```
//! All of them use one rule, [`Sensitivities::of`]: the derivative of a function of the program through everything that
//! it reads. G. Hiller, S. Galán, W. F. Feehery, P. I. Barton: Parametric sensitivity functions for hybrid
//! discrete/continuous systems, Applied Numerical Mathematics 31 (1999) 17.

mod instant;
mod path;
mod propagate;
mod start;
mod tick;

pub(crate) use instant::Cause;

use crate::consistent::Consistent;
use crate::failure::{Failure, FailureKind};
use crate::moment::At;
use crate::results::{GradientEnd, GradientEndKind};
use crate::state::State;
use hyde_program::{Constant, Function, PartialEntry, Program, Wrt};
use path::Path;
use propagate::Propagator;

/// The derivatives of everything that moves, one vector a parameter.
#[derive(Clone, Debug)]
pub(crate) struct Slopes {
    /// Of the solver's vector.
    pub(crate) y: Vec<Vec<f64>>,
    /// Of the rates of states; zero for the others.
    pub(crate) yp: Vec<Vec<f64>>,
    /// Of the memory.
    pub(crate) z: Vec<Vec<f64>>,
}

/// The derivatives of a run by parameters.
pub(crate) struct Sensitivities {
    /// What the parameter vector does with each parameter.
    directions: Vec<Vec<f64>>,
    /// Sizes of the parameters.
    sizes: Vec<f64>,
    pub(crate) now: Slopes,
    /// Time of `now`.
    t: f64,
    /// By how much the instant that is worked on moves with each parameter, in s; zero outside of events.
    moves: Vec<f64>,
    /// The largest value of each root function since it was zero.
    heights: Vec<f64>,
    propagator: Propagator,
    path: Path,
    entries: Entries,
    /// From when on there is no gradient.
    pub(crate) end: Option<GradientEnd>,
}

/// The places of a function's derivatives by parameters and memory.
struct Entries(Vec<(Function, Vec<PartialEntry>)>);

impl Entries {
    fn of(&self, function: Function) -> &[PartialEntry] {
        let found = self.0.iter().find(|(known, _)| *known == function);
        found.map_or(&[], |(_, entries)| entries)
    }
}

impl Sensitivities {
    /// Derivatives by the chosen parameters, all zero yet.
    ///
    /// # Errors
    /// [`FailureKind::NoGradient`] for models with delays, and for clocks whose times depend on the parameters.
    pub(crate) fn new(state: &State<'_>, chosen: &[usize], t: f64) -> Result<Self, Box<Failure>> {
        let program = state.program;
        let directions = program.kernels.parameter_directions(chosen, &state.p);
        refuse(state, &directions, t)?;
        let m = chosen.len();
        let zeros = |len: usize| vec![vec![0.0; len]; m];
        let n = program.n_unknowns;
        let entries = Function::ALL.map(|f| (f, program.kernels.still_entries(f)));
        let size = |&place: &usize| match state.p[place].abs() {
            0.0 => 1.0,
            size => size,
        };
        Ok(Self {
            sizes: chosen.iter().map(size).collect(),
            directions,
            now: Slopes {
                y: zeros(n),
                yp: zeros(n),
                z: zeros(program.n_memory),
            },
            t,
            moves: vec![0.0; m],
            heights: vec![0.0; program.relations.len()],
            propagator: Propagator::new(program),
            path: Path::default(),
            entries: Entries(entries.into_iter().collect()),
            end: None,
        })
    }

    /// The derivatives of a function's values by each parameter at a point: through the solver's vector, its derivative,
    /// the memory, the parameters, and the time where the instant moves.
    pub(crate) fn of(
        &self,
        function: Function,
        state: &mut State<'_>,
        at: At<'_>,
    ) -> Vec<Vec<f64>> {
        let program = state.program;
        let rows = program.rows(function);
        let mut out = vec![vec![0.0; rows]; self.directions.len()];
        let mut add = |slopes: &[Vec<f64>], (row, column): (usize, usize), value: f64| {
            for (out, slopes) in out.iter_mut().zip(slopes) {
                if slopes[column] != 0.0 {
                    out[row] += value * slopes[column];
                }
            }
        };
        let partials = state.partials(function, at);
        for (entry, value) in program.partials(function).iter().zip(partials) {
            match entry.wrt {
                Wrt::Unknown(column) => add(&self.now.y, (entry.row, column), value),
                Wrt::Derivative(column) => add(&self.now.yp, (entry.row, column), value),
                // The time comes below, with the record columns; delays are refused.
                Wrt::Time | Wrt::Delayed(_) | Wrt::Parameter(_) | Wrt::Memory(_) => {}
            }
        }
        let entries = self.entries.of(function);
        let mut partials = vec![0.0; entries.len()];
        state.still_partials(function, at, &mut partials);
        for (entry, value) in entries.iter().zip(partials) {
            match entry.wrt {
                Wrt::Parameter(column) => add(&self.directions, (entry.row, column), value),
                Wrt::Memory(column) => add(&self.now.z, (entry.row, column), value),
                Wrt::Unknown(_) | Wrt::Derivative(_) | Wrt::Delayed(_) | Wrt::Time => {}
            }
        }
        if self.moves.iter().any(|moves| *moves != 0.0) {
            let rates = state.by_time(function, at);
            for (out, moves) in out.iter_mut().zip(&self.moves) {
                out.iter_mut()
                    .zip(&rates)
                    .for_each(|(out, rate)| *out += rate * moves);
            }
        }
        out
    }

    /// The derivatives of rates and algebraic variables that belong to those of the states.
    pub(crate) fn be_consistent(
        &mut self,
        state: &mut State<'_>,
        consistent: &mut Consistent,
        at: At<'_>,
    ) {
        let At { t, y, .. } = at;
        if self.end.is_some() || y.is_empty() {
            return;
        }
        for (slopes, rates) in self.now.y.iter_mut().zip(&mut self.now.yp) {
            rates.fill(0.0);
            for (slope, differential) in slopes.iter_mut().zip(&state.differential) {
                if !differential {
                    *slope = 0.0;
                }
            }
        }
        // What is left with zeros in their places; the equations are linear in them.
        let mut rights = self.of(Function::Residual, state, at);
        if !consistent.correct(state, at, &mut rights) {
            self.stop(t, GradientEndKind::Singular);
            return;
        }
        for (number, right) in rights.into_iter().enumerate() {
            for (index, value) in right.into_iter().enumerate() {
                if state.differential[index] {
                    self.now.yp[number][index] = -value;
                } else {
                    self.now.y[number][index] = -value;
                }
            }
        }
    }

    /// There is no gradient from here on.
    fn stop(&mut self, t: f64, kind: GradientEndKind) {
        self.end.get_or_insert(GradientEnd {
            t,
            kind,
            cause: String::new(),
            origin: None,
        });
    }

    /// There is no gradient from here on, for the sake of a relation.
    fn stop_at(&mut self, program: &Program, t: f64, kind: GradientEndKind, relation: usize) {
        let relation = &program.relations[relation];
        self.end.get_or_insert(GradientEnd {
            t,
            kind,
            cause: relation.text.clone(),
            origin: Some(relation.origin.clone()),
        });
    }
}

/// Refuses what no gradient goes through.
fn refuse(state: &State<'_>, directions: &[Vec<f64>], t: f64) -> Result<(), Box<Failure>> {
    let program = state.program;
    if let Some(found) = program.parameters.iter().find(|parameter| parameter.found) {
        let what = format!(
            "the parameter `{}`, which an initial equation determines",
            found.name
        );
        return Err(Failure::new(FailureKind::NoGradient(what), t).at_origin(&found.origin));
    }
    if let Some(delay) = program.delays.first() {
        let what = format!("a delay of {} s", delay.time_s);
        return Err(Failure::new(FailureKind::NoGradient(what), t).at_origin(&delay.origin));
    }
    for (number, clock) in program.clocks.iter().enumerate() {
        let times = [
            Constant::Period(number),
            Constant::Delay(number),
            Constant::Phase(number),
        ];
        let slopes = times.map(|which| program.kernels.instant_partials(which, &state.p));
        let moves = |&(place, slope): &(usize, f64)| {
            slope != 0.0 && directions.iter().any(|direction| direction[place] != 0.0)
        };
        if slopes.iter().flatten().any(moves) {
            let what = format!(
                "the clock `{}`, whose times depend on a parameter",
                clock.name
            );
            return Err(Failure::new(FailureKind::NoGradient(what), t).at_origin(&clock.origin));
        }
    }
    Ok(())
}
