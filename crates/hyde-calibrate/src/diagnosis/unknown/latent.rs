//! [`Carrier`]: how a force at a site, whatever its course over time, shows in the innovations.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + b0 f(k) + b1 (f(k+1) - f(k))        change    -C eps
//! ```
//! One run of the observer with a probe on the site ([`super::site::probe`]) gives what a unit of force adds to the
//! equations in every row, and where the site is and how fast. Any course costs a product a row then, and no kernel. Guards
//! are taken to act when they do without it.

use crate::diagnosis::projection::dot;
use crate::gain::Observer;
use crate::plant::Plant;
use crate::recording::Recording;
use crate::tangent::{Direction, Modes, Own, modes};
use hyde_program::Program;
use nalgebra::{Cholesky, DMatrix, DVector};

/// What the probe met, row by row.
#[derive(Clone, Debug, Default)]
pub(crate) struct Course {
    pub(crate) time: Vec<f64>,
    pub(crate) place: Vec<f64>,
    pub(crate) speed: Vec<f64>,
    /// Whether a force acts at all: a friction that holds has no grip to add to.
    pub(crate) acts: Vec<bool>,
}

/// A record with the probe run along it.
pub(crate) struct Carrier {
    pub(crate) course: Course,
    rows: Vec<Row>,
    /// Two vectors a row: what the force at its start, and its growth over the row, do to the states.
    entries: Vec<f64>,
    known: Vec<Modes>,
    gain: DMatrix<f64>,
    deviations: Vec<f64>,
    first_row: usize,
    states: usize,
}

/// Which modes a row is corrected in, which it is stepped in, and the states that are fixed then.
struct Row {
    corrected: usize,
    stepped: usize,
    fixed: Vec<usize>,
}

/// The probe's sizes: force, by place, by speed.
pub(crate) const PROBE: [&str; 3] = ["force", "by_place", "by_speed"];

impl Carrier {
    /// Runs the observer along a record; `p` sets the stage's parameters, `path` is that of the probe's instance.
    pub(crate) fn new(
        program: &Program,
        recording: &Recording,
        observer: &Observer,
        set: &[(usize, f64)],
        path: &str,
    ) -> Option<Self> {
        let mut directions = Vec::new();
        for name in PROBE {
            let (parameter, element) = program.parameter(&format!("{path}.{name}"))?;
            let mut with = set.to_vec();
            with.push((parameter.place + element, 1.0));
            directions.push(Direction {
                p: recording.parameters(program, &with),
                step: 1.0,
            });
        }
        let mut plant = Plant::new(program, recording, set).ok()?;
        let observer = observer.of(&plant);
        if let Some(tolerances) = observer.tolerances() {
            plant.tolerances = tolerances;
        }
        let states = plant.places.states.len();
        let mut found = Self {
            course: Course::default(),
            rows: Vec::new(),
            entries: Vec::new(),
            known: Vec::new(),
            gain: observer.gain.clone(),
            deviations: observer.deviations.clone(),
            first_row: recording.first_row,
            states,
        };
        let mut own = Own::new(program, &plant.p, &directions);
        let mut forces = DMatrix::zeros(own.touched.len(), directions.len());
        let mut numbers = Vec::new();
        let mut error = vec![0.0; recording.channels.len()];
        let mut increment = vec![0.0; states];
        let (mut place, mut speed) = (0.0, 0.0);
        for row in 0..recording.rows() {
            own.outputs(&mut plant);
            for (channel, measured) in program.experiment.measured.iter().enumerate() {
                let difference = recording.channels[channel][row] - own.values[measured.output];
                error[channel] = if difference.is_finite() {
                    difference
                } else {
                    0.0
                };
            }
            let corrected = modes(&mut plant, &mut found.known, &mut numbers, &own.touched);
            crate::dense::set_product(&observer.gain, &error, &mut increment);
            plant.begin_row(&increment);
            let stepped = modes(&mut plant, &mut found.known, &mut numbers, &own.touched);
            own.forces(&mut plant, &directions, &mut forces);
            let unit = forces.column(0);
            let largest = (0..unit.len()).max_by(|&a, &b| unit[a].abs().total_cmp(&unit[b].abs()));
            let largest = largest.filter(|&equation| unit[equation] != 0.0);
            if let Some(equation) = largest {
                place = forces[(equation, 1)] / unit[equation];
                speed = forces[(equation, 2)] / unit[equation];
            }
            found.course.time.push(plant.time());
            found.course.place.push(place);
            found.course.speed.push(speed);
            found.course.acts.push(largest.is_some());
            let of = &found.known[stepped];
            for matrix in [&of.first, &of.second] {
                let start = found.entries.len();
                found.entries.resize(start + states, 0.0);
                crate::dense::add_product(matrix, unit.as_slice(), &mut found.entries[start..]);
            }
            let fixed = plant.pinned.iter().filter_map(|(position, _)| {
                let states = plant.places.states.iter();
                states.into_iter().position(|state| state == position)
            });
            found.rows.push(Row {
                corrected,
                stepped,
                fixed: fixed.collect(),
            });
            if row + 1 < recording.rows() {
                plant.advance();
            }
        }
        Some(found)
    }

    /// The lengths of the channels that count.
    pub(crate) fn lengths(&self) -> Vec<usize> {
        vec![self.rows.len() - self.first_row; self.deviations.len()]
    }

    /// The change of whitened innovations by a course of the force (one value a row), channels one behind the other.
    pub(crate) fn change(&self, force: &[f64]) -> Vec<f64> {
        let channels = self.deviations.len();
        let counted = self.rows.len() - self.first_row;
        let mut change = vec![0.0; channels * counted];
        let mut error = vec![0.0; self.states];
        let mut room = vec![0.0; self.states];
        let mut answer = vec![0.0; channels];
        let mut entries = self.entries.chunks_exact(self.states.max(1));
        for (number, row) in self.rows.iter().enumerate() {
            let (Some(first), Some(second)) = (entries.next(), entries.next()) else {
                break;
            };
            let (corrected, stepped) = (&self.known[row.corrected], &self.known[row.stepped]);
            crate::dense::set_product(&corrected.outputs, &error, &mut answer);
            for (channel, value) in answer.iter_mut().enumerate() {
                *value = -*value;
                if number >= self.first_row {
                    change[channel * counted + number - self.first_row] =
                        *value / self.deviations[channel];
                }
            }
            crate::dense::add_product(&self.gain, &answer, &mut error);
            crate::dense::set_product(&stepped.exp, &error, &mut room);
            let now = force[number];
            let growth = force.get(number + 1).map_or(0.0, |then| then - now);
            for ((value, first), second) in room.iter_mut().zip(first).zip(second) {
                *value += first * now + second * growth;
            }
            row.fixed.iter().for_each(|&state| room[state] = 0.0);
            std::mem::swap(&mut error, &mut room);
        }
        change
    }
}

/// Knots of a smoothed force in a record at most.
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
    let columns: Vec<Vec<f64>> = (0..knots)
        .map(|knot| {
            let hat: Vec<f64> = (0..rows)
                .map(|row| (1.0 - (row as f64 - at(knot)).abs() / width).max(0.0))
                .collect();
            carrier.change(&hat)
        })
        .collect();
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
        deviation: covariance.diagonal().iter().map(|v| v.sqrt()).collect(),
        force: force.iter().copied().collect(),
    })
}
