//! What the time of a row and the correction at its end make of errors, for all directions by the same product.

use super::known::{Known, Modes};
use crate::observer::gain::Observer;
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// What a row's time and the correction at its end make of errors, forces at both ends and what channels show: corrected
/// errors, and the whitened change of innovations.
#[derive(Default)]
pub(super) struct Corrected {
    /// By the combination of modes of the row, if it is one step or none, and the modes at its end.
    made: BTreeMap<(Option<usize>, usize), DMatrix<f64>>,
}

impl Corrected {
    pub(super) fn of(
        &mut self,
        known: &mut Known<'_>,
        stepped: Option<usize>,
        seen: usize,
        touched: usize,
    ) -> &DMatrix<f64> {
        self.made.entry((stepped, seen)).or_insert_with(|| {
            let observer = known.observer();
            let (channels, states) = known.modes[seen].outputs.shape();
            // Errors before the correction, of errors and forces.
            let errors = match stepped {
                Some(configuration) => known.leg(configuration, 0).clone(),
                None => DMatrix::identity(states, states + 2 * touched),
            };
            let mut matrix = DMatrix::zeros(states + channels, errors.ncols() + channels);
            correct(&errors, &known.modes[seen], observer, &mut matrix);
            matrix
        })
    }
}

/// What the correction at the end of a row makes of errors there, a column of `errors` each, and of what channels show beside
/// them: corrected errors, and below them the whitened change of innovations.
pub(super) fn correct(
    errors: &DMatrix<f64>,
    Modes {
        outputs,
        gain,
        readings,
        ..
    }: &Modes,
    observer: &Observer,
    matrix: &mut DMatrix<f64>,
) {
    let ((channels, states), inner) = (outputs.shape(), errors.ncols());
    matrix.fill(0.0);
    let (of_errors, of_channels) = matrix
        .as_mut_slice()
        .split_at_mut(inner * (states + channels));
    let columns = of_errors.chunks_exact_mut(states + channels);
    for (column, errors) in columns.zip(errors.as_slice().chunks_exact(states.max(1))) {
        let (kept, answers) = column.split_at_mut(states);
        kept.copy_from_slice(errors);
        for (outputs, error) in outputs.as_slice().chunks_exact(channels).zip(errors) {
            let each = answers.iter_mut().zip(outputs);
            each.for_each(|(answer, output)| *answer -= output * error);
        }
        for (channel, answer) in answers.iter_mut().enumerate() {
            let gain = gain.column(channel);
            let each = kept.iter_mut().zip(gain.iter());
            each.for_each(|(kept, gain)| *kept += gain * *answer);
            *answer /= observer.deviations[channel];
        }
    }
    let columns = of_channels.chunks_exact_mut(states + channels);
    for (channel, column) in columns.enumerate() {
        let gain = gain.column(channel);
        let each = column.iter_mut().zip(gain.iter());
        each.for_each(|(kept, gain)| *kept = -gain);
        if readings[channel] {
            column[states + channel] = -1.0 / observer.deviations[channel];
        }
    }
}
