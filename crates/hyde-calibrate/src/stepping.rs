//! A step of the fixed-step form: where the model is affine one product, else two stages, and a look at the rates within it:
//! a torque that turns with the angle may turn several times in a step, and be the same at both its ends.
//!
//! The linear part of the flow is that of the point where a combination of modes was first met, or of a point where steps
//! with that one had become short ([`Plant::advance`]). Bristles of friction decay the faster the faster they slide, by more
//! than any such number: states that an effect brings along get their own slope at every step where the linear part has
//! another, and are carried by it alone (Hochbruck and Ostermann 2010, section 2.4, with a diagonal for the Jacobian).

use crate::configuration::{Configuration, Places};
use crate::dense::{add_product, set_product};
use crate::plant::{LEVELS, Plant, shortest_steps, size_of, truth};
use hyde_program::{Function, Point, Program, Workspace};

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

/// Vectors that steps work in.
pub(crate) struct Room {
    y: Vec<f64>,
    yp: Vec<f64>,
    solving: Solving,
    x: Vec<f64>,
    rate: Vec<f64>,
    new_x: Vec<f64>,
    new_rate: Vec<f64>,
    rest: Vec<f64>,
    correction: Vec<f64>,
    stacked: Vec<f64>,
    probe_y: Vec<f64>,
    probe_yp: Vec<f64>,
    /// What drives the axis within the step.
    pub(crate) u_within: Vec<f64>,
    /// Numbers of states that decay fast where the plant is, and how fast.
    decays: Vec<(usize, f64)>,
    pub(crate) roots: Vec<f64>,
}

/// Vectors that rates are solved in.
struct Solving {
    residual: Vec<f64>,
    delta: Vec<f64>,
}

impl Room {
    pub(crate) fn new(program: &Program, places: &Places) -> Self {
        let n_states = places.states.len();
        let vector = || vec![0.0; program.n_unknowns];
        let of_states = || vec![0.0; n_states];
        Self {
            y: vector(),
            yp: vector(),
            solving: Solving {
                residual: vector(),
                delta: vector(),
            },
            x: of_states(),
            rate: of_states(),
            new_x: of_states(),
            new_rate: of_states(),
            rest: of_states(),
            correction: of_states(),
            stacked: vec![0.0; 2 * n_states + places.algebraics.len()],
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

impl Plant<'_> {
    /// Rates and algebraic variables where the states are.
    pub(crate) fn make_consistent(&mut self) {
        let t = self.time();
        let Self {
            program,
            places,
            p,
            configurations,
            current,
            y,
            yp,
            z,
            u,
            workspace,
            pinned,
            room,
            ..
        } = self;
        let model = Model {
            program,
            places,
            p,
            z,
            u,
            pinned,
        };
        let configuration = &configurations[*current].1;
        model.rates(configuration, t, y, yp, workspace, &mut room.solving);
    }

    /// One step of a row's time over 2^level.
    pub(crate) fn step(&mut self, level: usize) -> Outcome {
        let size = size_of(level);
        let end = self.recording.start_s
            + self.recording.step_s
                * (self.row as f64 + (self.index + size) as f64 / shortest_steps() as f64);
        let t = self.time();
        let looks_within =
            size >= LOOKED_INTO && !self.configuration().affine && !self.is_even(level);
        if looks_within {
            self.read_inputs_within(self.index + (WITHIN * size as f64) as usize, WITHIN);
        }
        self.read_inputs_at_end(self.index + size);
        let Self {
            program,
            recording,
            places,
            p,
            tolerances,
            configurations,
            current,
            y,
            yp,
            z,
            u,
            workspace,
            watched,
            pinned,
            room,
            row,
            even,
            ..
        } = self;
        let configuration = &configurations[*current].1;
        let step = &configuration.steps[level];
        let step_s = recording.step_s * size as f64 / shortest_steps() as f64;
        gather(yp, &places.states, &mut room.rate);
        room.y.copy_from_slice(y);
        room.yp.copy_from_slice(yp);
        let model = Model {
            program,
            places,
            p,
            z,
            u,
            pinned,
        };
        if configuration.affine {
            set_product(
                &configuration.affine_steps[level],
                &room.rate,
                &mut room.stacked,
            );
            let (change, rest) = room.stacked.split_at(room.x.len());
            let (rate, algebraic) = rest.split_at(room.x.len());
            for ((&position, change), rate) in places.states.iter().zip(change).zip(rate) {
                room.y[position] += change;
                room.yp[position] = *rate;
            }
            for (&position, change) in places.algebraics.iter().zip(algebraic) {
                room.y[position] += change;
            }
            model.apply_pins(&mut room.y, &mut room.yp);
        } else {
            gather(y, &places.states, &mut room.x);
            room.new_x.copy_from_slice(&room.x);
            add_product(&step.first, &room.rate, &mut room.new_x);
            model.find_decays(
                configuration,
                (t, step_s),
                (y, yp),
                tolerances,
                workspace,
                room,
            );
            for &(state, slope) in &room.decays {
                let (first, _) = integrals(slope * step_s);
                room.new_x[state] = room.x[state] + step_s * first * room.rate[state];
            }
            scatter(&room.new_x, &places.states, &mut room.y);
            model.apply_pins(&mut room.y, &mut room.yp);
            model.rates(
                configuration,
                end,
                &mut room.y,
                &mut room.yp,
                workspace,
                &mut room.solving,
            );
            gather(&room.yp, &places.states, &mut room.new_rate);
            // What the rates changed by beyond the linear part.
            for index in 0..room.rest.len() {
                room.rest[index] = room.x[index] - room.new_x[index];
            }
            room.correction.copy_from_slice(&room.new_rate);
            add_product(&configuration.a, &room.rest, &mut room.correction);
            for (rest, (new, old)) in room
                .rest
                .iter_mut()
                .zip(room.correction.iter().zip(&room.rate))
            {
                *rest = new - old;
            }
            set_product(&step.second, &room.rest, &mut room.correction);
            for &(state, slope) in &room.decays {
                let (_, second) = integrals(slope * step_s);
                let rest = room.new_rate[state]
                    - room.rate[state]
                    - slope * (room.new_x[state] - room.x[state]);
                room.correction[state] = step_s * second * rest;
            }
            if looks_within {
                let within = t + WITHIN * (end - t);
                model.bend(configuration, within, (y, yp), workspace, room);
                set_product(&step.first, &room.rest, &mut room.x);
                room.decays
                    .iter()
                    .for_each(|&(state, _)| room.x[state] = 0.0);
                let changes = room.x.iter().zip(tolerances.iter());
                let changes = changes.map(|(value, tolerance)| value.abs() / tolerance);
                let most = changes.fold(0.0, f64::max);
                if most > BENT {
                    return Outcome::TooLong;
                }
                if most < EVEN {
                    *even = Some((*row + EVEN_ROWS, level));
                }
                for (sum, change) in room.correction.iter_mut().zip(&room.x) {
                    *sum += change;
                }
            }
            let small = |(value, tolerance): (&f64, &f64)| value.abs() <= 0.1 * tolerance;
            if !room.correction.iter().zip(tolerances.iter()).all(small) {
                for (x, change) in room.new_x.iter_mut().zip(&room.correction) {
                    *x += change;
                }
                scatter(&room.new_x, &places.states, &mut room.y);
                model.apply_pins(&mut room.y, &mut room.yp);
                model.rates(
                    configuration,
                    end,
                    &mut room.y,
                    &mut room.yp,
                    workspace,
                    &mut room.solving,
                );
                // What the second stage would change again is the error that is left.
                gather(&room.yp, &places.states, &mut room.rate);
                for index in 0..room.rest.len() {
                    room.rest[index] = room.rate[index] - room.new_rate[index];
                    room.x[index] = -room.correction[index];
                }
                add_product(&configuration.a, &room.x, &mut room.rest);
                set_product(&step.second, &room.rest, &mut room.correction);
                let errors = room.correction.iter().zip(tolerances.iter());
                let errors = errors.map(|(value, tolerance)| value.abs() / tolerance);
                let exact = errors.clone().all(|error| error <= 1.0);
                if !exact && level + 1 < LEVELS {
                    return Outcome::Bent(errors.fold(0.0, f64::max));
                }
            }
        }
        let mut event = false;
        if !watched.is_empty() {
            let at = Point {
                t: end,
                y: &room.y,
                yp: &room.yp,
                z,
                u,
                p,
            };
            program
                .kernels
                .evaluate(Function::Roots, at, workspace, &mut room.roots);
            event = watched
                .iter()
                .any(|&number| truth(program, number, room.roots[number]) != (z[number] != 0.0));
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

/// What rates are made of.
struct Model<'s> {
    program: &'s Program,
    places: &'s Places,
    p: &'s [f64],
    z: &'s [f64],
    u: &'s [f64],
    pinned: &'s [(usize, f64)],
}

impl Model<'_> {
    /// Rates and algebraic variables for the states in y, from a guess of them.
    fn rates(
        &self,
        configuration: &Configuration,
        t: f64,
        y: &mut [f64],
        yp: &mut [f64],
        workspace: &mut Workspace,
        Solving { residual, delta }: &mut Solving,
    ) {
        let rounds = if configuration.constant { 1 } else { 8 };
        for _ in 0..rounds {
            let at = Point {
                t,
                y,
                yp,
                z: self.z,
                u: self.u,
                p: self.p,
            };
            self.program
                .kernels
                .evaluate(Function::Residual, at, workspace, residual);
            set_product(&configuration.inverse, residual, delta);
            let mut settled = true;
            for (index, &change) in delta.iter().enumerate() {
                let value = match self.places.differential[index] {
                    true => &mut yp[index],
                    false => &mut y[index],
                };
                *value -= change;
                settled &= change.abs() <= 1e-10 * value.abs() + 1e-13;
            }
            if settled {
                break;
            }
        }
        self.apply_pins(y, yp);
    }

    /// What two stages do not see of the rates, as a mean over the step: rates at a point within it, less those between its
    /// ends. Of what bends evenly, ends are off by `(f'' h^2)/12`, and a point at a part p of it by `p (1 - p) (f'' h^2)/2`.
    fn bend(
        &self,
        configuration: &Configuration,
        t: f64,
        (y, yp): (&[f64], &[f64]),
        workspace: &mut Workspace,
        room: &mut Room,
    ) {
        let between = |begin: &[f64], end: &[f64], out: &mut [f64]| {
            for ((out, begin), end) in out.iter_mut().zip(begin).zip(end) {
                *out = begin + WITHIN * (end - begin);
            }
        };
        between(y, &room.y, &mut room.probe_y);
        between(yp, &room.yp, &mut room.probe_yp);
        gather(&room.probe_yp, &self.places.states, &mut room.rest);
        let within = Model {
            program: self.program,
            places: self.places,
            p: self.p,
            z: self.z,
            u: &room.u_within,
            pinned: self.pinned,
        };
        within.rates(
            configuration,
            t,
            &mut room.probe_y,
            &mut room.probe_yp,
            workspace,
            &mut room.solving,
        );
        for (rest, &place) in room.rest.iter_mut().zip(&self.places.states) {
            *rest = (room.probe_yp[place] - *rest) / (6.0 * WITHIN * (1.0 - WITHIN));
        }
    }

    /// States that the observer does not know, as bristles, may decay faster than a step: their own slopes where they do.
    fn find_decays(
        &self,
        configuration: &Configuration,
        (t, step_s): (f64, f64),
        (y, yp): (&[f64], &[f64]),
        tolerances: &[f64],
        workspace: &mut Workspace,
        room: &mut Room,
    ) {
        room.decays.clear();
        for (state, _) in tolerances
            .iter()
            .enumerate()
            .filter(|(_, t)| t.is_infinite())
        {
            let place = self.places.states[state];
            room.probe_y.copy_from_slice(y);
            room.probe_yp.copy_from_slice(yp);
            let change = PROBE * (1.0 + y[place].abs());
            room.probe_y[place] += change;
            self.rates(
                configuration,
                t,
                &mut room.probe_y,
                &mut room.probe_yp,
                workspace,
                &mut room.solving,
            );
            let slope = (room.probe_yp[place] - room.rate[state]) / change;
            // What the linear part carries already, as the damping of a resonance, stays coupled to the other states.
            let other = (slope - configuration.a[(state, state)]).abs() * step_s > FAST;
            if other && slope * step_s < -FAST {
                room.decays.push((state, slope));
            }
        }
    }

    fn apply_pins(&self, y: &mut [f64], yp: &mut [f64]) {
        for &(position, value) in self.pinned {
            y[position] = value;
            yp[position] = 0.0;
        }
    }
}

/// (exp(z) - 1)/z and (exp(z) - 1 - z)/z^2, of a z well below 0.
fn integrals(z: f64) -> (f64, f64) {
    let first = z.exp_m1() / z;
    (first, (first - 1.0) / z)
}

/// The values at places.
pub(crate) fn gather(from: &[f64], places: &[usize], to: &mut [f64]) {
    for (value, &place) in to.iter_mut().zip(places) {
        *value = from[place];
    }
}

fn scatter(from: &[f64], places: &[usize], to: &mut [f64]) {
    for (&value, &place) in from.iter().zip(places) {
        to[place] = value;
    }
}
