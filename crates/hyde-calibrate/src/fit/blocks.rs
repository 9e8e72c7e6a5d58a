//! Blocks of a second: every other one judges what was fitted to the rest, and how gradients scatter from one to the next
//! says what parameters are known to.

use crate::observer::Innovations;
use crate::records::Recording;
use nalgebra::{DMatrix, DVector, DVectorView};

/// Every other block of a second, of each record: what one half has been fitted to, the other judges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fold {
    /// Whether the odd blocks count.
    pub odd: bool,
}

impl Fold {
    /// The other half.
    #[must_use]
    pub fn other(self) -> Self {
        Self { odd: !self.odd }
    }

    /// Takes what does not count out of a record's innovations.
    pub(crate) fn keep(self, innovations: &mut Innovations, recording: &Recording) {
        let block = rows_of_a_block(recording);
        for list in &mut innovations.channels {
            for (number, value) in list.iter_mut().enumerate() {
                if ((number / block) % 2 == 1) != self.odd {
                    *value = 0.0;
                }
            }
        }
    }

    /// The same of derivatives.
    pub(crate) fn keep_rows(self, derivatives: &mut DMatrix<f64>, recording: &Recording) {
        let block = rows_of_a_block(recording);
        let rows = recording.rows() - recording.first_row;
        for (number, mut row) in derivatives.row_iter_mut().enumerate() {
            if ((number % rows / block) % 2 == 1) != self.odd {
                row.fill(0.0);
            }
        }
    }
}

/// Half the gradients of the sum of squares over each second of a record.
pub(crate) fn gradients(
    derivatives: &DMatrix<f64>,
    innovations: &Innovations,
    recording: &Recording,
) -> Vec<DVector<f64>> {
    let rows = recording.rows() - recording.first_row;
    let length = rows_of_a_block(recording);
    let mut found = Vec::new();
    for first in (0..rows).step_by(length) {
        let count = length.min(rows - first);
        let mut sum = DVector::zeros(derivatives.ncols());
        for (channel, list) in innovations.channels.iter().enumerate() {
            let own = derivatives.rows(channel * rows + first, count);
            let values = DVectorView::from_slice(&list[first..first + count], count);
            sum += own.tr_mul(&values);
        }
        found.push(sum);
    }
    found
}

/// Rows of a second.
pub(crate) fn rows_of_a_block(recording: &Recording) -> usize {
    ((1.0 / recording.step_s).round() as usize).max(1)
}
