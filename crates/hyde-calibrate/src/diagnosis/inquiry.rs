//! [`Inquiry`]: what a diagnosis is asked of.

use super::hypothesis::{Built, Hypothesis};
use super::stage::Ground;
use super::thresholds::Thresholds;
use super::unknown::{Site, Written};
use crate::fit::Varied;
use crate::observer::Observer;
use crate::records::Recording;
use hyde_ir::LawShape;
use std::sync::Arc;

/// Puts known hypotheses, by number, and written effects on the model; `None` where they cannot be.
pub type Author<'a> = dyn Fn(&[usize], &[Written]) -> Option<Built> + Sync + 'a;

/// A model on records, with all that may be missing of it.
#[derive(Clone, Copy)]
pub struct Inquiry<'a> {
    /// The records fitted.
    pub recordings: &'a [Recording],
    /// The observer of the study.
    pub observer: &'a Observer,
    /// What calibration varies.
    pub varied: &'a [Varied],
    /// Values set from outside, by name, SI.
    pub set: &'a [(String, f64)],
    /// Every effect at every site.
    pub hypotheses: &'a [Hypothesis],
    /// Where a law that no effect is may act.
    pub sites: &'a [Site],
    /// The shapes that a law may be made of.
    pub shapes: &'a [Arc<LawShape>],
    /// Compiles.
    pub author: &'a Author<'a>,
    /// How many effects are claimed at most.
    pub max_effects: usize,
    /// Numbers of hypotheses that are not tried: what an earlier search took in and could not tell from its neutral value.
    pub barred: &'a [usize],
    /// What decides: those of the method, or others to see what each is worth.
    pub thresholds: &'a Thresholds,
}

impl Inquiry<'_> {
    pub(crate) fn ground(&self) -> Ground<'_> {
        Ground {
            recordings: self.recordings,
            observer: self.observer,
            set: self.set,
            thresholds: self.thresholds,
        }
    }
}
