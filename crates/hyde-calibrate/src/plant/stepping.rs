//! A step of the fixed-step form: where the model is affine one product, else two stages, and a look at the rates within it:
//! a torque that turns with the angle may turn several times in a step, and be the same at both its ends.
//!
//! The linear part of the flow is that of the point where a combination of modes was first met, or of a point where steps
//! with that one had become short ([`Plant::advance`]). Bristles of friction decay the faster the faster they slide, by more
//! than any such number: states that an effect brings along get their own slope at every step where the linear part has
//! another, and are carried by it alone (Hochbruck and Ostermann 2010, section 2.4, with a diagonal for the Jacobian).

use super::configuration::{Configuration, Places};
use super::driven::Plant;
use super::lengths::{LEVELS, shortest_steps, size_of};
use super::model::{Model, Solving};
use crate::linear::{phi1, set_product};
use hyde_program::{Function, Program, Workspace};

/// A change of a state by which its slope is found.
const PROBE: f64 = 1e-5;
/// A state decays fast in a step by this many time constants.
const FAST: f64 = 0.05;
/// Rates are looked at within steps of so many shortest ones or more, this part of them on: no half or third, for what turns
/// several times in a step would be alike there too.
const LOOKED_INTO: usize = 8;
const WITHIN: f64 = 0.375;
/// What is seen there corrects the step up to so many tolerances; above, it must be shorter.
const BENT: f64 = 10.0;
/// Below so many, steps as long are not looked into for so many rows.
const EVEN: f64 = 0.1;
const EVEN_ROWS: usize = 8;
/// A correction of so many tolerances is not made.
const SMALL: f64 = 0.1;

/// Vectors that steps work in.
pub(crate) struct Room {
    y: Vec<f64>,
    yp: Vec<f64>,
    solving: Solving,
    rate: Vec<f64>,
    /// What the linear part makes of a step: see [`super::configuration::Configuration::flows`].
    flow: Vec<f64>,
    correction: Vec<f64>,
    bend: Vec<f64>,
    probe_y: Vec<f64>,
    probe_yp: Vec<f64>,
    /// What drives the axis within the step.
    pub(crate) u_within: Vec<f64>,
    /// Numbers of states that decay fast where the plant is, and how fast.
    decays: Vec<(usize, f64)>,
    pub(crate) roots: Vec<f64>,
}

impl Room {
    pub(crate) fn new(program: &Program, places: &Places) -> Self {
        let n_states = places.states.len();
        let vector = || vec![0.0; program.n_unknowns];
        let of_states = || vec![0.0; n_states];
        Self {
            y: vector(),
            yp: vector(),
            solving: Solving::new(program.n_unknowns),
            rate: of_states(),
            flow: vec![0.0; 2 * n_states + places.algebraics.len()],
            correction: of_states(),
            bend: of_states(),
            probe_y: vector(),
            probe_yp: vector(),
            u_within: vec![0.0; 2 * program.columns.len() + program.delays.len()],
            decays: Vec::new(),
            roots: vec![0.0; program.relations.len()],
        }
    }
}

/// What became of a step.
pub(crate) enum Outcome {
    Taken,
    /// Taken, and a guard is true at its end.
    Event,
    /// It must be shorter: a guard becomes true.
    TooLong,
    /// It must be shorter, or of another linear part: its error, in tolerances.
    Bent(f64),
}

/// A plant taken apart: what steps read, and what they change.
struct Parts<'s, 'a> {
    model: Model<'s>,
    configuration: &'s Configuration<'a>,
    tolerances: &'s [f64],
    watched: &'s [usize],
    y: &'s mut Vec<f64>,
    yp: &'s mut Vec<f64>,
    workspace: &'s mut Workspace,
    room: &'s mut Room,
    even: &'s mut Option<(usize, usize)>,
}

impl<'a> Plant<'a> {
    fn parts(&mut self) -> Parts<'_, 'a> {
        Parts {
            model: Model {
                program: self.program,
                places: &self.places,
                p: &self.p,
                z: &self.z,
                u: &self.u,
                pinned: &self.pinned,
            },
            configuration: &self.configurations[self.current].1,
            tolerances: &self.tolerances,
            watched: &self.watched,
            y: &mut self.y,
            yp: &mut self.yp,
            workspace: &mut self.workspace,
            room: &mut self.room,
            even: &mut self.even,
        }
    }

    /// Rates and algebraic variables where the states are.
    pub(crate) fn make_consistent(&mut self) {
        let t = self.time();
        let Parts {
            model,
            configuration,
            y,
            yp,
            workspace,
            room,
            ..
        } = self.parts();
        model.rates(configuration, t, y, yp, workspace, &mut room.solving);
    }

    /// States that the observer does not know, as bristles, may decay faster than a step: their own slopes where they do.
    fn find_decays(&mut self, level: usize) {
        self.room.decays.clear();
        if self.configuration().affine || !self.tolerances.iter().any(|t| t.is_infinite()) {
            return;
        }
        self.read_inputs_at_start();
        let t = self.time();
        let step_s = self.recording.step_s * size_of(level) as f64 / shortest_steps() as f64;
        let Parts {
            model,
            configuration,
            tolerances,
            y,
            yp,
            workspace,
            room,
            ..
        } = self.parts();
        for (state, &place) in model.places.states.iter().enumerate() {
            if tolerances[state].is_finite() {
                continue;
            }
            let (probe_y, probe_yp) = (&mut room.probe_y, &mut room.probe_yp);
            probe_y.copy_from_slice(y);
            probe_yp.copy_from_slice(yp);
            let change = PROBE * (1.0 + y[place].abs());
            probe_y[place] += change;
            room.solving.delta.fill(0.0);
            add_multiple(
                configuration.by_state(state),
                change,
                &mut room.solving.delta,
            );
            model.follow(&room.solving.delta, probe_y, probe_yp);
            model.answer(
                configuration,
                t,
                probe_y,
                probe_yp,
                workspace,
                &mut room.solving,
            );
            let slope = (probe_yp[place] - yp[place]) / change;
            // What the linear part carries already, as the damping of a resonance, stays coupled to the other states.
            let other = (slope - configuration.by_state(state)[state]).abs() * step_s > FAST;
            if other && slope * step_s < -FAST {
                room.decays.push((state, slope));
            }
        }
    }

    /// One step of a row's time over 2^level.
    pub(crate) fn step(&mut self, level: usize) -> Outcome {
        let size = size_of(level);
        let end = self.recording.start_s
            + self.recording.step_s
                * (self.row as f64 + (self.index + size) as f64 / shortest_steps() as f64);
        let t = self.time();
        self.find_decays(level);
        let looks_within =
            size >= LOOKED_INTO && !self.configuration().affine && !self.is_even(level);
        if looks_within {
            self.read_inputs_within(self.index + (WITHIN * size as f64) as usize, WITHIN);
        }
        self.read_inputs_at_end(self.index + size);
        let step_s = self.recording.step_s * size as f64 / shortest_steps() as f64;
        let row = self.row;
        let Parts {
            model,
            configuration,
            tolerances,
            watched,
            y,
            yp,
            workspace,
            room,
            even,
        } = self.parts();
        let places = model.places;
        let (n, bending) = (places.states.len(), &configuration.bending);
        gather(yp, &places.states, &mut room.rate);
        room.y.copy_from_slice(y);
        room.yp.copy_from_slice(yp);
        set_product(&configuration.flows[level], &room.rate, &mut room.flow);
        for &(state, slope) in &room.decays {
            let (first, _) = integrals(slope * step_s);
            let change = step_s * first * room.rate[state];
            let other = change - std::mem::replace(&mut room.flow[state], change);
            add_multiple(configuration.by_state(state), other, &mut room.flow[n..]);
        }
        model.carry(&room.flow, &mut room.y, &mut room.yp);
        if !configuration.affine {
            // What the rates change by beyond the linear part grows over the step.
            let (y, yp) = ((&*y, &mut room.y), (&*yp, &mut room.yp));
            model.answer(configuration, end, y.1, yp.1, workspace, &mut room.solving);
            set_product(
                &bending.second[level],
                &room.solving.sum,
                &mut room.correction,
            );
            for &(state, slope) in &room.decays {
                let (_, second) = integrals(slope * step_s);
                let rest = yp.1[places.states[state]] - room.rate[state] - slope * room.flow[state];
                room.correction[state] = step_s * second * rest;
            }
            if looks_within {
                between(y.0, y.1, &mut room.probe_y);
                between(yp.0, yp.1, &mut room.probe_yp);
                let within = Model {
                    u: &room.u_within,
                    ..model
                };
                let (probe_y, probe_yp) = (&mut room.probe_y, &mut room.probe_yp);
                let time = t + WITHIN * (end - t);
                within.answer(
                    configuration,
                    time,
                    probe_y,
                    probe_yp,
                    workspace,
                    &mut room.solving,
                );
                // Of what bends evenly, ends are off by (f'' h^2)/12, and a point at a part p of it by p (1 - p) (f'' h^2)/2.
                set_product(&bending.first[level], &room.solving.sum, &mut room.bend);
                for bend in &mut room.bend {
                    *bend /= 6.0 * WITHIN * (1.0 - WITHIN);
                }
                for &(state, _) in &room.decays {
                    room.bend[state] = 0.0;
                }
                let most = largest(&room.bend, tolerances);
                if most > BENT {
                    return Outcome::TooLong;
                }
                if most < EVEN {
                    *even = Some((row + EVEN_ROWS, level));
                }
                for (sum, change) in room.correction.iter_mut().zip(&room.bend) {
                    *sum += change;
                }
            }
            if largest(&room.correction, tolerances) > SMALL {
                let follows = &mut room.solving.delta;
                set_product(&configuration.by_states, &room.correction, follows);
                for (&place, change) in places.states.iter().zip(&room.correction) {
                    y.1[place] += change;
                }
                model.follow(follows, y.1, yp.1);
                model.answer(configuration, end, y.1, yp.1, workspace, &mut room.solving);
                // What a third stage would change again is the error that is left.
                set_product(
                    &bending.second[level],
                    &room.solving.sum,
                    &mut room.correction,
                );
                let error = largest(&room.correction, tolerances);
                if error > 1.0 && level + 1 < LEVELS {
                    return Outcome::Bent(error);
                }
            }
        }
        let mut event = false;
        if !watched.is_empty() {
            let at = model.point(end, &room.y, &room.yp);
            let kernels = &model.program.kernels;
            kernels.evaluate(Function::Roots, at, workspace, &mut room.roots);
            event = watched.iter().any(|&number| {
                model.program.relations[number].truth(room.roots[number])
                    != (model.z[number] != 0.0)
            });
        }
        if event && level + 1 < LEVELS {
            return Outcome::TooLong;
        }
        std::mem::swap(y, &mut room.y);
        std::mem::swap(yp, &mut room.yp);
        if event {
            Outcome::Event
        } else {
            Outcome::Taken
        }
    }
}

/// Adds a multiple.
fn add_multiple(values: &[f64], by: f64, sum: &mut [f64]) {
    for (sum, value) in sum.iter_mut().zip(values) {
        *sum += by * value;
    }
}

/// Values at a part of the way from those at the begin of a step to those at its end.
fn between(begin: &[f64], end: &[f64], out: &mut [f64]) {
    for ((out, begin), end) in out.iter_mut().zip(begin).zip(end) {
        *out = begin + WITHIN * (end - begin);
    }
}

/// The largest of some changes of the states, in tolerances.
fn largest(changes: &[f64], tolerances: &[f64]) -> f64 {
    let pairs = changes.iter().zip(tolerances);
    let in_tolerances = pairs.map(|(change, tolerance)| match change.is_nan() {
        true => f64::INFINITY,
        false => change.abs() / tolerance,
    });
    in_tolerances.fold(0.0, f64::max)
}

/// phi1 and phi2 of a z well below 0.
fn integrals(z: f64) -> (f64, f64) {
    let first = phi1(z);
    (first, (first - 1.0) / z)
}

/// The values at places.
pub(crate) fn gather(from: &[f64], places: &[usize], to: &mut [f64]) {
    for (value, &place) in to.iter_mut().zip(places) {
        *value = from[place];
    }
}
