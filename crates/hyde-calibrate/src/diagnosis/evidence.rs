//! What counts as evidence: [`Gates`], which gains have to reach, and [`excess`], what is left to explain.
//!
//! The gate of a gain is what the best of all nodes tried would reach by chance in one of a hundred records without
//! any effect: the quantile of chi squared for the effect's sizes and shapes, after Bonferroni. It grows with what
//! innovations tell less than independent ones. A gain on what was not fitted is also to be material: a part of the
//! number of innovations.

use super::thresholds::Thresholds;
use crate::fit::{Solution, inflation};
use crate::observer::Innovations;
use hyde_signal::statistics::{autocorrelation, distributions};

/// What gains have to reach.
#[derive(Clone, Copy, Debug)]
pub struct Gates {
    /// Nodes tried so far.
    pub tried: usize,
    /// Number of innovations.
    pub innovations: usize,
    /// What effects known so far may leave, which is no gain of another one.
    pub left: f64,
    /// What the gates are made of.
    pub thresholds: Thresholds,
}

impl Gates {
    /// What a gain of a hypothesis with so many sizes and shapes has to reach.
    #[must_use]
    pub fn gain(&self, freedoms: usize) -> f64 {
        let chance = self.thresholds.chance / self.tried.max(1) as f64;
        distributions::chi_squared(freedoms.max(1), chance)
    }

    /// What it has to gain on halves of the records by fits to the other halves, with a gate that is so much inflated. A fit
    /// gains one a freedom on what it was fitted to by chance; fits to halves, which scatter twice as much, lose two on both
    /// others.
    #[must_use]
    pub fn unseen(&self, freedoms: usize, inflation: f64) -> f64 {
        let by_chance = 3.0 * freedoms as f64;
        let gate = (self.gain(freedoms) - by_chance) * inflation;
        gate.max(self.material())
    }

    /// What a gain over a model has to reach that a single number is worth.
    pub(super) fn of_one(&self, model: &Solution) -> f64 {
        self.gain(1) * inflation(&model.innovations)
    }

    /// What a gain on what was not fitted has to reach beside that.
    #[must_use]
    pub fn material(&self) -> f64 {
        self.left
            .max(self.thresholds.material * self.innovations as f64)
    }
}

/// The part of what was more than noise that is explained.
pub(super) fn share(before: &Solution, after: &Solution) -> f64 {
    1.0 - excess(after) / excess(before).max(1e-300)
}

/// What is more than noise, of the sum of squares.
pub(super) fn excess(solution: &Solution) -> f64 {
    let channels = solution.innovations.iter().flat_map(Innovations::sizes);
    let more = channels.map(|(list, size)| (size - 1.0).max(0.0) * list.len() as f64);
    more.sum()
}

/// Whether innovations are what the noise makes of them: no channel of a record is materially larger, or more like itself
/// from row to row, beyond what chance makes of so many rows.
pub(super) fn explained(solution: &Solution, thresholds: &Thresholds) -> bool {
    let records = || solution.innovations.iter();
    let channels: usize = records().map(|own| own.channels.len()).sum();
    let chance = distributions::normal(thresholds.chance / channels.max(1) as f64);
    records().flat_map(Innovations::sizes).all(|(list, size)| {
        let rows = list.len().max(1) as f64;
        size <= thresholds.explained_size + chance * (2.0 / rows).sqrt()
            && autocorrelation(&list, 1) * size.clamp(0.0, 1.0)
                <= thresholds.explained_likeness + chance / rows.sqrt()
    })
}
