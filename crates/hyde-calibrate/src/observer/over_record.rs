//! An observer over a record: predict a row, compare, correct, on.

use super::gain::Observer;
use crate::linear::set_product;
use crate::plant::{Plant, measured};
use std::ops::ControlFlow;

/// A value that is missing corrects nothing.
pub(crate) fn forget_missing(error: &mut [f64]) {
    let missing = error.iter_mut().filter(|e| !e.is_finite());
    missing.for_each(|e| *e = 0.0);
}

/// Before the correction of a row, or after it.
#[derive(Clone, Copy)]
pub(crate) enum When {
    Before,
    After,
}

/// Runs the observer over the record. At each row, before it is corrected, `visit` gets the plant, the row's number and the
/// innovations in SI.
pub(crate) fn run(
    plant: &mut Plant<'_>,
    observer: &Observer,
    mut visit: impl FnMut(&mut Plant<'_>, usize, &[f64]),
) {
    let _end = run_while(plant, observer, |plant, row, when, error| {
        if matches!(when, When::Before) {
            visit(plant, row, error);
        }
        ControlFlow::Continue(())
    });
}

/// The same before the correction and after it, where what is missing counts as 0; as long as `visit` says so.
pub(crate) fn run_while(
    plant: &mut Plant<'_>,
    observer: &Observer,
    mut visit: impl FnMut(&mut Plant<'_>, usize, When, &[f64]) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let recording = plant.recording;
    let program = plant.program;
    let shown = measured(program);
    let mut outputs = vec![0.0; recording.channels.len()];
    let mut error = vec![0.0; recording.channels.len()];
    let mut increment = vec![0.0; plant.places.states.len()];
    for row in 0..recording.rows() {
        let (at, workspace) = plant.point();
        shown.evaluate(at, workspace, &mut outputs);
        for (channel, output) in outputs.iter().enumerate() {
            error[channel] = recording.error(channel, row, *output);
        }
        visit(plant, row, When::Before, &error)?;
        forget_missing(&mut error);
        set_product(observer.gain_in(plant), &error, &mut increment);
        plant.begin_row(&increment);
        visit(plant, row, When::After, &error)?;
        if row + 1 < recording.rows() {
            plant.advance();
        }
    }
    ControlFlow::Continue(())
}
