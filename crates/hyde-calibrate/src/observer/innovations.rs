//! [`Innovations`]: what an observer met along a record that its model did not predict, in standard deviations.

use super::gain::Observer;
use super::over_record::{When, run_while};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;
use hyde_signal::statistics::mean_square;
use std::borrow::Cow;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Whitened innovations of a record: each channel's, row by row, in standard deviations.
#[derive(Clone, Debug, Default)]
pub struct Innovations {
    /// One list a channel, rows from the first that counts.
    pub channels: Vec<Vec<f64>>,
    /// The step of each channel's quantiser, in the same units; 0 without one.
    pub(crate) counts: Vec<f64>,
    /// The rows of each channel that have no reading, ascending; their innovations are 0.
    pub(crate) absent: Vec<Arc<[usize]>>,
}

impl Innovations {
    /// Those of a program with some parameters set (position and value).
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn of(
        program: &Program,
        recording: &Recording,
        observer: &Observer,
        set: &[(usize, f64)],
    ) -> Result<Self, Unsupported> {
        let whole = Self::within(program, recording, observer, set, f64::INFINITY)?;
        Ok(whole.unwrap_or_default())
    }

    /// The same as long as the sum of their squares stays within a limit, else `None`: what is worse than that is not run
    /// to its end.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub(crate) fn within(
        program: &Program,
        recording: &Recording,
        observer: &Observer,
        set: &[(usize, f64)],
        limit: f64,
    ) -> Result<Option<Self>, Unsupported> {
        let (mut plant, observer) = observer.on(program, recording, set)?;
        let mut found = Self::empty(recording, &observer);
        let mut sum = 0.0;
        let end = run_while(&mut plant, &observer, |_, row, when, error| {
            if matches!(when, When::Before) && row >= recording.first_row {
                sum += found.add(error, recording.readings(row), &observer);
            }
            if sum <= limit {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        });
        Ok(end.is_continue().then_some(found))
    }

    /// None yet, with room for all rows of a record.
    pub(crate) fn empty(recording: &Recording, observer: &Observer) -> Self {
        let rows = recording.rows() - recording.first_row;
        let counts = observer.rounding.iter().zip(&observer.deviations);
        Self {
            channels: vec![Vec::with_capacity(rows); recording.channels.len()],
            counts: counts.map(|(step, deviation)| step / deviation).collect(),
            absent: recording.absent.clone(),
        }
    }

    /// Adds those of a row, given in SI; the sum of their squares.
    pub(crate) fn add(&mut self, error: &[f64], readings: &[bool], observer: &Observer) -> f64 {
        let mut sum = 0.0;
        let known = error.iter().zip(&observer.deviations).zip(readings);
        for (list, ((error, deviation), there)) in self.channels.iter_mut().zip(known) {
            let value = match there {
                true => whitened(*error, *deviation),
                false => 0.0,
            };
            sum += value * value;
            list.push(value);
        }
        sum
    }

    /// Those of a channel's readings: without the rows that have none.
    #[must_use]
    pub fn of_readings(&self, channel: usize) -> Cow<'_, [f64]> {
        self.of_rows(channel, &self.channels[channel])
    }

    /// Values of rows, in those that have a reading of a channel.
    pub(crate) fn of_rows<'v>(&self, channel: usize, list: &'v [f64]) -> Cow<'v, [f64]> {
        let absent = self.absent.get(channel).filter(|absent| !absent.is_empty());
        let Some(absent) = absent else {
            return Cow::Borrowed(list);
        };
        let mut absent = absent.iter().peekable();
        let there = |(row, _): &(usize, &f64)| absent.next_if(|own| **own == *row).is_none();
        let known = list.iter().enumerate().filter(there);
        Cow::Owned(known.map(|(_, value)| *value).collect())
    }

    /// The same of each channel.
    pub(crate) fn each_of_readings(&self) -> impl Iterator<Item = Cow<'_, [f64]>> {
        (0..self.channels.len()).map(|channel| self.of_readings(channel))
    }

    /// How many readings there are.
    #[must_use]
    pub fn count(&self) -> usize {
        let rows: usize = self.channels.iter().map(Vec::len).sum();
        rows - self.absent.iter().map(|absent| absent.len()).sum::<usize>()
    }

    /// Each channel's readings, with their mean square as it would be if what is measured lay evenly between the counts of a quantiser.
    ///
    /// It does not where an axis stands, or moves by a whole number of counts a row: rounding is the same there over and
    /// over, of a model that is right too. How much the prediction is rounded by is the innovation but for whole counts, and
    /// its mean square over `q^2/12` is what has to be taken out.
    pub(crate) fn sizes(&self) -> impl Iterator<Item = (Cow<'_, [f64]>, f64)> {
        let each = self.each_of_readings().zip(&self.counts);
        each.map(|(list, &count)| {
            let uneven = match count > 0.0 {
                true => {
                    let rounded = list.iter().map(|r| r - count * (r / count).round());
                    let rounded: Vec<f64> = rounded.collect();
                    mean_square(&rounded) - count * count / 12.0
                }
                false => 0.0,
            };
            let size = mean_square(&list) - uneven;
            (list, size)
        })
    }

    /// Their mean square, over all channels.
    #[must_use]
    pub fn chi(&self) -> f64 {
        self.sum_of_squares() / (self.count() as f64).max(1.0)
    }

    /// The sum of their squares.
    #[must_use]
    pub fn sum_of_squares(&self) -> f64 {
        self.channels.iter().flatten().map(|r| r * r).sum()
    }
}

/// An innovation in standard deviations; what diverged is far off, and no more than that.
fn whitened(error: f64, deviation: f64) -> f64 {
    let value = error / deviation;
    if value.is_finite() {
        value.clamp(-1e6, 1e6)
    } else {
        1e6
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a quantiser of a step of 1 makes of positions, seen from predictions that are off by an error, and whitened.
    fn rounded(positions: impl Iterator<Item = f64>, off: impl Fn(usize) -> f64) -> Innovations {
        let deviation = (1.0 / 12.0_f64).sqrt();
        let error = |(row, place): (usize, f64)| place.floor() + 0.5 - (place + off(row));
        let innovations = positions.enumerate().map(error);
        Innovations {
            channels: vec![innovations.map(|error| error / deviation).collect()],
            counts: vec![1.0 / deviation],
            absent: Vec::new(),
        }
    }

    fn size(innovations: &Innovations) -> f64 {
        innovations.sizes().next().unwrap().1
    }

    #[test]
    fn where_rounding_is_uneven_a_model_that_is_right_is_of_size_one() {
        let rows = 0..20_000_u32;
        let evenly = rows.clone().map(|row| 0.381_966 * f64::from(row));
        assert!((size(&rounded(evenly, |_| 0.0)) - 1.0).abs() < 1e-3);
        for place in [0.02, 0.3, 0.5, 0.98] {
            // By 24 counts a row, and trembling by a fiftieth of one.
            let trembling = |row: u32| 0.02 * (2.4 * f64::from(row)).sin();
            let whole = rows
                .clone()
                .map(|row| 24.0 * f64::from(row) + place + trembling(row));
            let own = rounded(whole, |_| 0.0);
            assert!((size(&own) - 1.0).abs() < 1e-12);
            assert!((own.chi() - 1.0).abs() > 0.4, "{}", own.chi());
        }
    }

    #[test]
    fn an_error_of_the_prediction_adds_its_mean_square() {
        let evenly = (0..20_000_u32).map(|row| 0.381_966 * f64::from(row));
        let off = |row: usize| 0.2 * (1.7 * row as f64).sin();
        let expected = 1.0 + 0.02 * 12.0;
        let found = rounded(evenly, off);
        assert!((size(&found) - expected).abs() < 5e-3, "{}", size(&found));
        assert!((found.chi() - expected).abs() < 5e-3);
    }
}
