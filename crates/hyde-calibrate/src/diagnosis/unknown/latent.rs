//! [`Carrier`]: how a force at a site, whatever its course over time, shows in the innovations.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + b0 f(k) + b1 (f(k+1) - f(k))        change    -(C eps + d f(k))
//! ```
//! A force acts by b0 and b1; a sensor's error shows by d, and moves the states by what the observer makes of it, `-exp(A T) K d`.
//! One run of the observer with a probe on the site ([`super::probe::probe`]) gives what a unit of force adds to the
//! equations in every row, and where the site is and how fast. Any course costs a product a row then, and no kernel; and so
//! does what any change has in common with every course, which is the same rows backwards. Guards are taken to act when they
//! do without the force.

use super::probe::{Point, sizes_of, strongest};
use crate::diagnosis::projection::dot;
use crate::linear::{SIDE_BY_SIDE, add_product, set_product, set_products};
use crate::observer::{Direction, Forces, Known, Modes, Observer, Own, Place, Track, When};
use crate::records::Recording;
use hyde_program::Program;
use nalgebra::{Cholesky, DMatrix, DVector};
use std::collections::BTreeMap;

/// What the probe met, row by row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Course {
    pub(crate) time: Vec<f64>,
    pub(crate) place: Vec<f64>,
    pub(crate) speed: Vec<f64>,
    /// 0 where the probe does not tell it.
    pub(crate) acceleration: Vec<f64>,
    /// 0 where the site has none.
    pub(crate) signal: Vec<f64>,
    /// Whether a force acts at all: a friction that holds has no grip to add to.
    pub(crate) acts: Vec<bool>,
}

/// A record with the probe run along it.
pub(crate) struct Carrier {
    pub(crate) course: Course,
    rows: Vec<Row>,
    /// Two vectors a row: what the force at its start, and its growth over the row, do to the states.
    entries: Vec<f64>,
    /// A value a row and channel: how a unit shows in whitened innovations at once.
    shown: Vec<f64>,
    passages: Vec<Passage>,
    channels: usize,
    first_row: usize,
    states: usize,
}

/// How a row is passed, by the number of its matrices, and the states that are fixed in it.
struct Row {
    passage: usize,
    fixed: Vec<usize>,
}

/// What a row makes of an error of the states: how whitened innovations change, and below them the error at the next row.
struct Passage {
    matrix: DMatrix<f64>,
    transposed: DMatrix<f64>,
}

impl Passage {
    fn new(corrected: &Modes, stepped: &Modes, observer: &Observer) -> Self {
        let (channels, states) = corrected.outputs.shape();
        let mut matrix = DMatrix::zeros(channels + states, states);
        for (channel, deviation) in observer.deviations.iter().enumerate() {
            let own = corrected.outputs.row(channel) / -deviation;
            matrix.row_mut(channel).copy_from(&own);
        }
        let kept = DMatrix::identity(states, states) - &corrected.gain * &corrected.outputs;
        matrix
            .rows_mut(channels, states)
            .copy_from(&(&stepped.exp * kept));
        Self {
            transposed: matrix.transpose(),
            matrix,
        }
    }
}

impl Carrier {
    /// Runs the observer along a record; `p` sets the stage's parameters, `path` is that of the probe's instance.
    pub(crate) fn new(
        program: &Program,
        recording: &Recording,
        observer: &Observer,
        set: &[(usize, f64)],
        path: &str,
    ) -> Option<Self> {
        let sizes = sizes_of(program, path);
        let mut directions = Vec::new();
        for name in &sizes {
            let (parameter, element) = program.parameter(name)?;
            let mut with = set.to_vec();
            with.push((parameter.place + element, 1.0));
            directions.push(Direction {
                p: recording.parameters(program, &with),
                step: 1.0,
            });
        }
        let track = Track::new(program, recording, observer, set).ok()?;
        let (observer, states) = (&track.route.observer, track.route.places.states.len());
        let mut found = Self {
            course: Course::default(),
            rows: Vec::new(),
            entries: Vec::new(),
            shown: Vec::new(),
            passages: Vec::new(),
            channels: recording.channels.len(),
            first_row: recording.first_row,
            states,
        };
        let p = recording.parameters(program, set);
        let mut own = Own::new(program, (&track, p.as_slice()), &directions);
        let mut known = Known::new(&track, recording, &own.touched);
        let mut forces = DMatrix::zeros(own.touched.len(), directions.len());
        let mut by_output = DMatrix::zeros(recording.channels.len(), directions.len());
        let mut passages = BTreeMap::new();
        let mut increment = vec![0.0; states];
        let mut last = Point::default();
        for (row, passed) in track.route.rows.iter().enumerate() {
            let [before, after] = passed.modes;
            if own.shown {
                own.seen(Place::Row(row, When::Before), &mut by_output);
            }
            let corrected = known.modes(row, When::Before, before);
            let stepped = known.modes(row, When::After, after);
            own.forces(Place::Row(row, When::After), &mut forces);
            found.course.time.push(track.route.time(row));
            let added = strongest(&forces).or_else(|| strongest(&by_output));
            let at = added.map(|added| Point::told(&sizes, &added));
            last = at.unwrap_or(last);
            found.course.place.push(last.place);
            found.course.speed.push(last.speed);
            found.course.acceleration.push(last.acceleration);
            found.course.signal.push(last.signal);
            found.course.acts.push(at.is_some());
            let [corrected_by, stepped_by] = [&known.modes[corrected], &known.modes[stepped]];
            let unit = forces.column(0);
            let read = by_output.column(0);
            let read = read.iter().zip(&corrected_by.readings);
            let shown = read.map(|(value, there)| if *there { -value } else { 0.0 });
            let shown: Vec<f64> = shown.collect();
            for matrix in [&stepped_by.first, &stepped_by.second] {
                let start = found.entries.len();
                found.entries.resize(start + states, 0.0);
                add_product(matrix, unit.as_slice(), &mut found.entries[start..]);
            }
            if shown.iter().any(|value| *value != 0.0) {
                set_product(&corrected_by.gain, &shown, &mut increment);
                let first = found.entries.len() - 2 * states;
                let first = &mut found.entries[first..][..states];
                add_product(&stepped_by.exp, &increment, first);
            }
            let whitened = shown.iter().zip(&observer.deviations);
            found
                .shown
                .extend(whitened.map(|(value, deviation)| value / deviation));
            let passage = *passages.entry((corrected, stepped)).or_insert_with(|| {
                let made = Passage::new(corrected_by, stepped_by, observer);
                found.passages.push(made);
                found.passages.len() - 1
            });
            // What a mode fixed within the row has no error since; the little that grew again until its end is left out.
            let events = track.legs(row).iter().filter_map(|leg| leg.event.as_ref());
            let mut fixed = passed.fixed.clone();
            fixed.extend(events.flat_map(|event| &event.fixed));
            found.rows.push(Row { passage, fixed });
        }
        Some(found)
    }

    /// The lengths of the channels that count.
    pub(crate) fn lengths(&self) -> Vec<usize> {
        vec![self.rows.len() - self.first_row; self.channels]
    }

    /// The changes of whitened innovations by courses of the force (a value a row), channels one behind the other.
    pub(crate) fn changes(&self, forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let few = forces.chunks(SIDE_BY_SIDE);
        few.flat_map(|few| match few.len() {
            // Registers that are mostly empty cost more than one course after the other.
            ..3 => few
                .chunks(1)
                .flat_map(|one| self.beside::<1>(one))
                .collect(),
            3.. => self.beside::<SIDE_BY_SIDE>(few),
        })
        .collect()
    }

    /// The same of so many courses at most, side by side.
    fn beside<const N: usize>(&self, forces: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let counted = self.rows.len() - self.first_row;
        let mut changes = vec![vec![0.0; self.channels * counted]; forces.len()];
        let mut errors = vec![[0.0; N]; self.states];
        let mut room = vec![[0.0; N]; self.channels + self.states];
        let at = |row: usize| -> [f64; N] {
            let force = |n: usize| forces.get(n).and_then(|force| force.get(row));
            std::array::from_fn(|n| force(n).copied().unwrap_or(0.0))
        };
        let mut now = at(0);
        let entries = self.entries.chunks_exact(2 * self.states.max(1));
        for (number, (row, entry)) in self.rows.iter().zip(entries).enumerate() {
            let matrix = &self.passages[row.passage].matrix;
            set_products::<N>(matrix, errors.as_flattened(), room.as_flattened_mut());
            let (answer, next) = room.split_at(self.channels);
            if let Some(counts) = number.checked_sub(self.first_row) {
                let shown = &self.shown[number * self.channels..];
                for (channel, (values, shown)) in answer.iter().zip(shown).enumerate() {
                    let place = channel * counted + counts;
                    for ((change, value), now) in changes.iter_mut().zip(values).zip(now) {
                        change[place] = value + shown * now;
                    }
                }
            }
            // The last force does not grow any more.
            let then = if number + 1 < self.rows.len() {
                at(number + 1)
            } else {
                now
            };
            let (first, second) = entry.split_at(self.states);
            let each = errors.iter_mut().zip(next).zip(first.iter().zip(second));
            for ((errors, next), (first, second)) in each {
                for n in 0..N {
                    errors[n] = next[n] + first * now[n] + second * (then[n] - now[n]);
                }
            }
            row.fixed.iter().for_each(|&state| errors[state] = [0.0; N]);
            now = then;
        }
        changes
    }

    /// What the changes by unit forces in each row have in common with a given change: the transpose of [`Self::changes`].
    pub(crate) fn common(&self, change: &[f64]) -> Vec<f64> {
        let counted = self.rows.len() - self.first_row;
        let mut force = vec![0.0; self.rows.len()];
        // How much the change to come has in common with an error of the states behind a row.
        let mut later = vec![0.0; self.states];
        let mut room = vec![0.0; self.channels + self.states];
        for (number, row) in self.rows.iter().enumerate().rev() {
            row.fixed.iter().for_each(|&state| later[state] = 0.0);
            let (first, second) = self.entries[2 * self.states * number..].split_at(self.states);
            let growth = dot(&second[..self.states], &later);
            // The last force does not grow any more.
            if let Some(then) = force.get_mut(number + 1) {
                *then += growth;
                force[number] -= growth;
            }
            force[number] += dot(first, &later);
            for channel in 0..self.channels {
                let at = number.checked_sub(self.first_row);
                room[channel] = at.map_or(0.0, |at| change[channel * counted + at]);
                force[number] += self.shown[number * self.channels + channel] * room[channel];
            }
            room[self.channels..].copy_from_slice(&later);
            set_product(&self.passages[row.passage].transposed, &room, &mut later);
        }
        force
    }
}

/// Numerics: knots of a smoothed force in a record at most.
const KNOTS: usize = 200;

/// A force at a site over a record, smoothed.
#[derive(Clone, Debug, PartialEq)]
pub struct LatentForce {
    /// Times in s.
    pub time: Vec<f64>,
    /// Where the site was, SI.
    pub place: Vec<f64>,
    /// How fast, SI.
    pub speed: Vec<f64>,
    /// How fast that changes, SI; 0 where it is not known.
    pub acceleration: Vec<f64>,
    /// What the site has beside them, SI; 0 where that is nothing.
    pub signal: Vec<f64>,
    /// The force or torque that the balance would need there, SI.
    pub force: Vec<f64>,
    /// Its standard deviation, SI.
    pub deviation: Vec<f64>,
}

/// The force at a site that explains the innovations of a record, linear between knots, its bends as small as the record
/// allows: the weight of bends has the greatest likelihood of a grid (Rasmussen and Williams, Gaussian Processes for
/// Machine Learning, 2006, section 5.4.1). `innovations` are whitened, channels one behind the other.
pub(crate) fn smoothed(carrier: &Carrier, innovations: &[f64]) -> Option<LatentForce> {
    let rows = carrier.course.time.len();
    let knots = KNOTS.min(rows / 4);
    if knots < 5 {
        return None;
    }
    let at = |knot: usize| knot as f64 * (rows - 1) as f64 / (knots - 1) as f64;
    let width = at(1);
    let hat = |knot: usize| -> Vec<f64> {
        let each = 0..rows;
        each.map(|row| (1.0 - (row as f64 - at(knot)).abs() / width).max(0.0))
            .collect()
    };
    let columns = carrier.changes(&(0..knots).map(hat).collect::<Vec<_>>());
    let mut gram = DMatrix::zeros(knots, knots);
    let mut b = DVector::zeros(knots);
    for i in 0..knots {
        for j in 0..=i {
            gram[(i, j)] = dot(&columns[i], &columns[j]);
            gram[(j, i)] = gram[(i, j)];
        }
        b[i] = -dot(&columns[i], innovations);
    }
    let mut bends = DMatrix::zeros(knots, knots);
    for k in 1..knots - 1 {
        let stencil = [(k - 1, 1.0), (k, -2.0), (k + 1, 1.0)];
        for (i, a) in stencil {
            for (j, c) in stencil {
                bends[(i, j)] += a * c;
            }
        }
    }
    let scale = gram.trace() / knots as f64;
    let mut best: Option<(f64, DVector<f64>, DMatrix<f64>)> = None;
    for step in -8..=8 {
        let weight = scale * 10.0_f64.powi(step);
        let matrix = &gram + &bends * weight + DMatrix::identity(knots, knots) * (1e-9 * scale);
        let Some(factor) = Cholesky::new(matrix) else {
            continue;
        };
        let force = factor.solve(&b);
        let log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|d| d.ln()).sum();
        let likelihood =
            0.5 * b.dot(&force) - log_determinant + 0.5 * (knots - 2) as f64 * weight.ln();
        if best.as_ref().is_none_or(|(known, ..)| likelihood > *known) {
            best = Some((likelihood, force, factor.inverse()));
        }
    }
    let (_, force, covariance) = best?;
    let row_of = |knot: usize| (at(knot).round() as usize).min(rows - 1);
    let of = |list: &[f64]| (0..knots).map(|knot| list[row_of(knot)]).collect();
    Some(LatentForce {
        time: of(&carrier.course.time),
        place: of(&carrier.course.place),
        speed: of(&carrier.course.speed),
        acceleration: of(&carrier.course.acceleration),
        signal: of(&carrier.course.signal),
        deviation: covariance.diagonal().iter().map(|v| v.sqrt()).collect(),
        force: force.iter().copied().collect(),
    })
}
