//! [`left_at_edges`]: what an effect with modes of its own may leave of what it explains.
//!
//! The innovations of a play are not of one variance: while it is open the observer knows less, and right after it closes it
//! still does. All rows are weighed alike, so a model that is right leaves a part of what the play explains, at the edges of
//! its modes. No other effect and no law is made of that part.

use super::evidence::{excess, explained};
use super::hypothesis::brings_modes;
use super::stage::Stage;
use super::thresholds::Thresholds;

/// What effects that a stage has beyond the declared model may leave of the sum of squares; 0 of those without modes.
pub(super) fn left_at_edges(declared: &Stage, stage: &Stage, thresholds: &Thresholds) -> f64 {
    match brings_modes(&stage.program, &declared.program) {
        true => thresholds.material * (declared.solution.data - stage.solution.data).max(0.0),
        false => 0.0,
    }
}

/// Whether a stage leaves nothing to seek another kind of answer for: innovations are noise, but for what edges leave.
pub(super) fn settled(declared: &Stage, stage: &Stage, thresholds: &Thresholds) -> bool {
    explained(&stage.solution, thresholds)
        || excess(&stage.solution) <= left_at_edges(declared, stage, thresholds)
}
