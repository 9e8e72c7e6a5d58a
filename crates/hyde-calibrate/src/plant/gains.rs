//! [`Gains`]: what corrects the states of a plant by the errors of its channels, for each kind of row.

use crate::records::Readings;
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

    /// One for each kind of row, those with a reading of every channel of `count` among them or not.
    pub(crate) fn of_kinds(
        count: usize,
        kinds: &[Readings],
        gain: impl Fn(&Readings) -> DMatrix<f64>,
    ) -> Self {
        let all = vec![true; count];
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
