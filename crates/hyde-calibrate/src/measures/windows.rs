//! Open-loop windows: how far a model runs from its record within 100 ms, when nothing corrects it (L1, measure b).
//!
//! Each window starts where the observer is, moved by what the window itself says about its start: one step of least
//! squares on the errors in the window, weighed by their noise, against the spread of the observer's states. A change
//! that does not bring the window nearer is dropped.

use crate::linear::set_product;
use crate::observer::{Observer, forget_missing, run};
use crate::plant::{Plant, Snapshot, Unsupported, measured};
use crate::records::Recording;
use hyde_program::Program;
use nalgebra::{DMatrix, DVector};

/// Length of a window in s.
pub const WINDOW_S: f64 = 0.1;
/// A start is varied by this part of the spread of a state.
const VARIED: f64 = 0.5;

/// Errors of a record's windows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Windows {
    /// Where each begins in s.
    pub start_s: Vec<f64>,
    /// Root mean square of each, SI: one list a channel; NaN where nothing was measured.
    pub rms: Vec<Vec<f64>>,
}

/// The windows of a record.
pub(crate) fn windows(
    program: &Program,
    recording: &Recording,
    observer: &Observer,
    set: &[(usize, f64)],
) -> Result<Windows, Unsupported> {
    let (mut plant, observer) = observer.on(program, recording, set)?;
    let length = ((WINDOW_S / recording.step_s).round() as usize).max(1);
    let mut starts: Vec<(Snapshot, Vec<f64>)> = Vec::new();
    run(&mut plant, &observer, |plant, row, error| {
        let counted = row.checked_sub(recording.first_row);
        let whole = row + length < recording.rows();
        if whole && counted.is_some_and(|rows| rows.is_multiple_of(length)) {
            let mut known = error.to_vec();
            forget_missing(&mut known);
            let mut increment = vec![0.0; plant.places.states.len()];
            set_product(observer.gain_in(plant), &known, &mut increment);
            starts.push((Snapshot::of(plant), increment));
        }
    });
    let mut found = Windows {
        start_s: Vec::new(),
        rms: vec![Vec::new(); recording.channels.len()],
    };
    for (start, increment) in &starts {
        let plain = window(&mut plant, start, increment, length);
        let best = match moved(&mut plant, &observer, start, increment, &plain, length) {
            Some(other) if size(&other, &observer) < size(&plain, &observer) => other,
            Some(_) | None => plain,
        };
        found
            .start_s
            .push(recording.start_s + recording.step_s * start.row as f64);
        for (list, errors) in found.rms.iter_mut().zip(best) {
            let known: Vec<f64> = errors.into_iter().filter(|e| e.is_finite()).collect();
            list.push(match known.is_empty() {
                true => f64::NAN,
                false => hyde_signal::statistics::rms(&known),
            });
        }
    }
    Ok(found)
}

impl Windows {
    /// Root mean square over all windows of a channel, SI; NaN where there is none.
    #[must_use]
    pub fn total(&self, channel: usize) -> f64 {
        let known = self.rms[channel].iter().filter(|rms| rms.is_finite());
        let (sum, count) = known.fold((0.0, 0.0), |(sum, n), rms| (sum + rms * rms, n + 1.0));
        (sum / count).sqrt()
    }
}

/// Errors of the rows behind the start, channel by channel, the states moved by an increment at the start.
fn window(
    plant: &mut Plant<'_>,
    start: &Snapshot,
    increment: &[f64],
    length: usize,
) -> Vec<Vec<f64>> {
    start.restore(plant);
    let (program, recording) = (plant.program, plant.recording);
    let still = vec![0.0; increment.len()];
    let shown = measured(program);
    let mut outputs = vec![0.0; recording.channels.len()];
    let mut errors = vec![Vec::with_capacity(length); recording.channels.len()];
    plant.begin_row(increment);
    for row in start.row + 1..=start.row + length {
        plant.advance();
        let (at, workspace) = plant.point();
        shown.evaluate(at, workspace, &mut outputs);
        for (channel, output) in outputs.iter().enumerate() {
            errors[channel].push(recording.error(channel, row, *output));
        }
        plant.begin_row(&still);
    }
    errors
}

/// The window from the start that suits it best by one step of least squares; `None` where that has no answer.
fn moved(
    plant: &mut Plant<'_>,
    observer: &Observer,
    start: &Snapshot,
    increment: &[f64],
    plain: &[Vec<f64>],
    length: usize,
) -> Option<Vec<Vec<f64>>> {
    let whitened = |errors: &[Vec<f64>]| -> Vec<f64> {
        let each = errors.iter().zip(&observer.noise);
        each.flat_map(|(list, noise)| list.iter().map(move |e| e / noise))
            .map(|e| if e.is_finite() { e } else { 0.0 })
            .collect()
    };
    let here = DVector::from_vec(whitened(plain));
    let known: Vec<usize> = (0..increment.len())
        .filter(|&state| observer.spread[state].is_finite() && observer.spread[state] > 0.0)
        .collect();
    let mut columns = DMatrix::zeros(here.len(), known.len());
    for (column, &state) in known.iter().enumerate() {
        let mut other = increment.to_vec();
        other[state] += VARIED * observer.spread[state];
        let errors = DVector::from_vec(whitened(&window(plant, start, &other, length)));
        columns.set_column(column, &((errors - &here) / VARIED));
    }
    // In units of each state's spread, what is known of the start beforehand is the identity.
    let curvature = columns.transpose() * &columns + DMatrix::identity(known.len(), known.len());
    let step = curvature.cholesky()?.solve(&(columns.transpose() * -here));
    let mut best = increment.to_vec();
    for (&state, part) in known.iter().zip(step.iter()) {
        best[state] += part * observer.spread[state];
    }
    Some(window(plant, start, &best, length))
}

/// The sum of squares of a window in units of its noise.
fn size(errors: &[Vec<f64>], observer: &Observer) -> f64 {
    let of = |(list, noise): (&Vec<f64>, &f64)| -> f64 {
        let known = list.iter().filter(|e| e.is_finite());
        known.map(|e| (e / noise).powi(2)).sum()
    };
    errors.iter().zip(&observer.noise).map(of).sum()
}
