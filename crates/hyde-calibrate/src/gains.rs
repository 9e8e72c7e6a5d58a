//! [`Gains`]: what an observer corrects states by, for each kind of row.
//!
//! ```text
//! K = P C'(C P C' + R)^-1        C and R of the channels that have a reading in the row
//! ```
//! P is one for all rows: the stationary covariance of a prediction if a channel that has a reading in every m-th row had one
//! in each, of m times the variance, which tells as much in the mean.

use crate::readings::Readings;
use nalgebra::DMatrix;

/// A gain for each kind of row: a row a state, a column a channel, 0 of those without a reading.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gains {
    /// That of rows with a reading of every channel.
    pub(crate) all: DMatrix<f64>,
    others: Vec<(Readings, DMatrix<f64>)>,
}

impl Gains {
    /// Gains that correct nothing; none yet for 0 states and channels.
    pub(crate) fn none(states: usize, channels: usize) -> Self {
        Self {
            all: DMatrix::zeros(states, channels),
            others: Vec::new(),
        }
    }

    /// Those of a covariance of the prediction, for some kinds of rows; `noise` is the standard deviation of each channel.
    pub(crate) fn of(
        p: &DMatrix<f64>,
        c: &DMatrix<f64>,
        noise: &[f64],
        kinds: &[Readings],
    ) -> Self {
        let gain = |readings: &Readings| {
            let channels = 0..noise.len();
            let known: Vec<usize> = channels.filter(|&channel| readings[channel]).collect();
            let seen = c.select_rows(&known);
            let mut s = &seen * p * seen.transpose();
            for (row, &channel) in known.iter().enumerate() {
                s[(row, row)] += noise[channel] * noise[channel];
            }
            let inverse = s.clone().try_inverse();
            let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(s.nrows(), s.ncols()));
            let own = p * seen.transpose() * inverse;
            let mut gain = DMatrix::zeros(p.nrows(), noise.len());
            for (column, &channel) in known.iter().enumerate() {
                gain.set_column(channel, &own.column(column));
            }
            gain
        };
        let all = vec![true; noise.len()];
        let others = kinds.iter().filter(|readings| **readings != all);
        Self {
            others: others.map(|own| (own.clone(), gain(own))).collect(),
            all: gain(&all),
        }
    }

    /// Whether there are none yet.
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// That of a kind of row; of one that was not known when they were made that with all readings, whose missing ones
    /// correct nothing.
    pub(crate) fn in_row(&self, readings: &Readings) -> &DMatrix<f64> {
        let own = self.others.iter().find(|(known, _)| known == readings);
        own.map_or(&self.all, |(_, gain)| gain)
    }

    /// Each with its states changed.
    pub(crate) fn map(&self, change: impl Fn(&DMatrix<f64>) -> DMatrix<f64>) -> Self {
        let others = self.others.iter();
        Self {
            all: change(&self.all),
            others: others
                .map(|(readings, gain)| (readings.clone(), change(gain)))
                .collect(),
        }
    }
}
