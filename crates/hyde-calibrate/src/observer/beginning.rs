//! Where a record begins: the states that its first rows show elsewhere than the model starts.
//!
//! A record may begin in motion, or with a gap closed, and an observer in a mode that holds what moves would never learn of it.
//! Rows that follow each other show a state by what channels do in them: a position by itself, a speed by its own channel or
//! by how a position changes. So the start is moved by least squares on the errors of the first rows,
//!
//! ```text
//! e(k) = C exp(A k T) dx(0) + noise
//! ```
//! in the directions, and by the states, in which it is many standard deviations off; else the model's own start stays. The
//! standard deviations are of the declared noise, or of what least squares leave where that is more, and are larger where that
//! is alike from row to row. Modes follow as in a run:
//! one that holds a state elsewhere than it is shown to be is left ([`hyde_sim::known_start`]), others by their guards.

use super::gain::{deviation, state_names};
use crate::plant::{Plant, Unsupported, measured, output_matrix};
use crate::records::{RecordError, Recording};
use hyde_program::{Program, Workspace};
use hyde_signal::statistics::autocorrelation;
use hyde_signal::{Table, wrap};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// Rows that show it: a model that is somewhat wrong is right for so long.
const ROWS: usize = 30;
/// What is fewer standard deviations off may be noise.
const CLEAR: f64 = 6.0;
/// The observer itself finds a start whose first rows are off by less than so many standard deviations in each channel.
const FOUND: f64 = 5.0;
/// Directions that channels show less than this part of the clearest are not known.
const SHOWN: f64 = 1e-3;
/// How often it is looked from what was found: a gap that closes is a spring from there on.
const ROUNDS: usize = 5;

impl Recording {
    /// A record for a program in the observed form with some values set (position and value), with the states that it shows
    /// elsewhere than the model starts with them; none where there is no observer.
    ///
    /// # Errors
    /// See [`RecordError`].
    pub fn new(
        name: &str,
        program: &Program,
        tables: BTreeMap<String, Table>,
        set: &[(usize, f64)],
    ) -> Result<Self, RecordError> {
        let mut recording = Self::read(name, program, tables)?;
        recording.begin(program, set);
        Ok(recording)
    }

    /// Looks again where the record begins, with other values set: a start that is taken from the rows is a start of the model
    /// with its values.
    pub fn begin(&mut self, program: &Program, set: &[(usize, f64)]) {
        let mut found = Vec::new();
        let _none = look(program, self, set, &mut found);
        self.beginning = found;
    }
}

fn look(
    program: &Program,
    recording: &Recording,
    set: &[(usize, f64)],
    found: &mut Vec<(String, f64)>,
) -> Result<(), Unsupported> {
    let p = recording.parameters(program, set);
    let noise = (0..recording.channels.len()).map(|channel| deviation(program, channel, &p));
    let noise: Vec<f64> = noise.collect();
    let slipping = Plant::at(program, recording, p, &[])?;
    let mut columns = shares(&slipping, &noise);
    let mut here = Errors::of(program, recording, set, (&noise, found))?;
    let rms = |channel: usize| {
        let own = here.errors.iter().skip(channel).step_by(noise.len());
        (own.map(|error| error * error).sum::<f64>() / ROWS as f64).sqrt()
    };
    if (0..noise.len()).all(|channel| rms(channel) < FOUND) {
        return Ok(());
    }
    for _ in 0..ROUNDS {
        let change = clear(&columns, &here.errors, noise.len());
        if change.iter().all(|change| *change == 0.0) {
            break;
        }
        let states = here
            .plant
            .places
            .states
            .iter()
            .zip(state_names(&here.plant));
        let moved = states
            .zip(change.iter())
            .filter_map(|((&state, name), change)| {
                let kept = found.iter().any(|(known, _)| *known == name);
                (kept || *change != 0.0).then(|| (name, here.start[state] + change))
            });
        let moved: Vec<(String, f64)> = moved.collect();
        let there = Errors::of(program, recording, set, (&noise, &moved))?;
        if there.errors.norm_squared() >= here.errors.norm_squared() {
            break;
        }
        *found = moved;
        here = there;
        if here.plant.pinned.is_empty() {
            columns = shares(&here.plant, &noise);
        }
    }
    Ok(())
}

/// A plant left to itself over the first rows, and the errors that it makes there, whitened, row by row.
struct Errors<'p> {
    /// Where its unknowns were at the first row.
    start: Vec<f64>,
    plant: Plant<'p>,
    errors: DVector<f64>,
}

impl<'p> Errors<'p> {
    fn of(
        program: &'p Program,
        recording: &'p Recording,
        set: &[(usize, f64)],
        (noise, beginning): (&[f64], &[(String, f64)]),
    ) -> Result<Self, Unsupported> {
        let mut plant = Plant::beginning(program, recording, set, beginning)?;
        let (start, shown) = (plant.y.clone(), measured(program));
        let still = vec![0.0; plant.places.states.len()];
        let mut outputs = vec![0.0; noise.len()];
        let mut errors = DVector::zeros(ROWS * noise.len());
        let mut last = vec![0.0; noise.len()];
        for row in 0..ROWS {
            let (at, workspace) = plant.point();
            shown.evaluate(at, workspace, &mut outputs);
            for (channel, output) in outputs.iter().enumerate() {
                // A start that is too slow is late by several periods in the end.
                let error = recording.error(channel, row, *output);
                let period = recording.periods[channel];
                if period.is_finite() && error.is_finite() {
                    last[channel] += wrap::nearest(error - last[channel], period);
                } else {
                    last[channel] = error;
                }
                let error = last[channel] / noise[channel];
                let known = error.is_finite();
                errors[row * noise.len() + channel] = if known { error } else { 0.0 };
            }
            plant.begin_row(&still);
            plant.advance();
        }
        Ok(Self {
            start,
            plant,
            errors,
        })
    }
}

/// What a unit of each state at the first row adds to whitened channels in the rows, near where a plant is.
fn shares(plant: &Plant<'_>, noise: &[f64]) -> DMatrix<f64> {
    let mut workspace = Workspace::new(plant.program.n_work);
    let (configuration, places) = (plant.configuration(), &plant.places);
    let at = plant.here();
    let mut c = output_matrix(plant.program, places, configuration, at, &mut workspace);
    for (mut row, noise) in c.row_iter_mut().zip(noise) {
        row /= *noise;
    }
    let mut all = DMatrix::zeros(ROWS * noise.len(), places.states.len());
    for row in 0..ROWS {
        let readings = plant.recording.readings(row).iter();
        for (channel, _) in readings.enumerate().filter(|(_, there)| **there) {
            let into = row * noise.len() + channel;
            all.row_mut(into).copy_from(&c.row(channel));
        }
        c = &c * &configuration.steps[0].exp;
    }
    all
}

/// What each state is clearly off by; 0 where nothing says so.
fn clear(columns: &DMatrix<f64>, errors: &DVector<f64>, channels: usize) -> DVector<f64> {
    let scales = DVector::from_iterator(columns.ncols(), columns.column_iter().map(|c| c.norm()));
    let states: Vec<usize> = (0..scales.len()).filter(|&i| scales[i] > 0.0).collect();
    let mut change = DVector::zeros(scales.len());
    let mut scaled = columns.select_columns(&states);
    for (mut column, &state) in scaled.column_iter_mut().zip(&states) {
        column /= scales[state];
    }
    if !scaled.iter().all(|value| value.is_finite()) {
        return change;
    }
    let parts = scaled.svd(true, true);
    let (Some(u), Some(v)) = (parts.u, parts.v_t) else {
        return change;
    };
    let sizes = &parts.singular_values;
    let shown: Vec<usize> = (0..sizes.len())
        .filter(|&i| sizes[i] > SHOWN * sizes.max())
        .collect();
    let along = u.tr_mul(errors);
    let mut left = errors.clone();
    for &i in &shown {
        left.axpy(-along[i], &u.column(i), 1.0);
    }
    let freedoms = errors.len().saturating_sub(shown.len()).max(1);
    let scatter = (left.norm_squared() / freedoms as f64).max(1.0).sqrt();
    // What is wrong with a model is alike from row to row, and looks like a start.
    let alike = autocorrelation(left.as_slice(), channels).clamp(0.0, 0.95);
    let scatter = scatter * (1.0 + alike) / (1.0 - alike);
    let mut variances = DVector::zeros(scales.len());
    for i in shown {
        if along[i].abs() < CLEAR * scatter {
            continue;
        }
        for (column, &state) in states.iter().enumerate() {
            let share = v[(i, column)] / (sizes[i] * scales[state]);
            change[state] += share * along[i];
            variances[state] += (share * scatter).powi(2);
        }
    }
    change.zip_map(&variances, |change: f64, variance: f64| {
        let clear = change.abs() > CLEAR * variance.sqrt();
        if clear { change } else { 0.0 }
    })
}
