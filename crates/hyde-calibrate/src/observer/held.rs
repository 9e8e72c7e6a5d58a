//! [`Observer::gain_in`]: what an observer corrects a combination of modes by.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps        states that modes fix have none
//! ```
//! The stationary gain K is made in one combination of modes, and kept in every other in which errors do not grow by it. They
//! do where a coupling opens: the encoder of the motor then corrects the table, which nothing holds any more, and innovations
//! say nothing of the model. There the gain is the stationary one of that very combination, with the same noise of the model,
//! its mode being known (Bar-Shalom, Li and Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001,
//! section 11.6.2).

use super::gain::{Observer, stationary};
use crate::plant::{Gains, Plant};
use nalgebra::{DMatrix, Schur};

/// Errors grow where they do by more than this part a row: what nothing shows stays as it is but for rounding.
const GROWTH: f64 = 1e-4;
/// How exact eigenvalues are, and steps at most to find them.
const EXACT: f64 = 1e-10;
const STEPS: usize = 10_000;

impl Observer {
    /// What an error is corrected by in the combination of modes that a plant is in; kept there.
    pub(crate) fn gain_in<'g>(&self, plant: &'g mut Plant<'_>) -> &'g DMatrix<f64> {
        if plant.configuration().gains.is_empty() {
            let gains = self.holding(plant);
            plant.configurations[plant.current].1.gains = gains;
        }
        let readings = plant.recording.readings(plant.row);
        plant.configuration().gains.in_row(readings)
    }

    /// The observer's own gains if they hold the combination of modes, else the stationary ones there.
    fn holding(&self, plant: &mut Plant<'_>) -> Gains {
        if self.process.is_empty() {
            return self.gains.clone();
        }
        let pinned = |position: &usize| plant.pinned.iter().any(|(own, _)| own == position);
        let states = plant.places.states.iter().enumerate();
        let free = states.filter(|(_, position)| !pinned(position));
        let free: Vec<usize> = free.map(|(state, _)| state).collect();
        let outputs = plant.outputs();
        let exp = &plant.configuration().steps[0].exp;
        let among = |states: &[usize]| {
            let exp = exp.select_rows(states).select_columns(states);
            (exp, outputs.select_columns(states))
        };
        let (step, seen) = among(&free);
        if growth(&step, &seen, &self.gains.all.select_rows(&free)) <= 1.0 + GROWTH {
            return self.gains.clone();
        }
        let mut known = free;
        known.retain(|&state| self.knows(state));
        let (step, seen) = among(&known);
        let noise = self.process.select_rows(&known).select_columns(&known);
        let own = stationary(&step, &seen, &noise, &self.noise, &self.rates).gains;
        let states = self.gains.all.nrows();
        own.map(|own| {
            let mut gain = DMatrix::zeros(states, own.ncols());
            for (row, &state) in known.iter().enumerate() {
                gain.set_row(state, &own.row(row));
            }
            gain
        })
    }
}

/// By how much errors grow in a row at most: the largest eigenvalue of exp(A T) (I - K C); none where it is not found.
fn growth(exp: &DMatrix<f64>, outputs: &DMatrix<f64>, gain: &DMatrix<f64>) -> f64 {
    let n = exp.nrows();
    let errors = exp * (DMatrix::identity(n, n) - gain * outputs);
    let found = Schur::try_new(errors, EXACT, STEPS);
    found.map_or(0.0, |found| {
        let eigenvalues = found.complex_eigenvalues();
        eigenvalues.iter().map(|own| own.norm()).fold(0.0, f64::max)
    })
}
