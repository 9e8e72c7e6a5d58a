//! The differential suite: random drive models, each computed in two ways that must agree.
//!
//! A refusal with a diagnostic, or a run that ends with a failure, is no disagreement, but it is counted: a generator that is
//! mostly refused tests nothing.

pub(crate) mod arrays;
pub(crate) mod bodies;
pub(crate) mod circuits;
mod complex_step;
mod model;
mod trajectories;
mod ways;

pub use model::{Model, random};
pub use ways::Way;

use rayon::prelude::*;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What came of a comparison.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// Both ways agree.
    Agrees,
    /// One of them ended with a diagnostic or a failure: what it said.
    Refused(String),
    /// The model has nothing to compare.
    Nothing,
    /// They do not agree, and nothing was said: variable, time, both values.
    Disagrees(String),
}

/// What came of many models.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// Comparisons that agree, are refused, have nothing to compare, of each way.
    pub counts: BTreeMap<Way, [usize; 3]>,
    /// Every disagreement with its seed and model.
    pub disagreements: Vec<String>,
    /// Every refusal with its seed.
    pub refusals: Vec<String>,
}

impl Summary {
    /// Adds what came of other models.
    pub fn add(&mut self, other: Self) {
        for (way, counts) in other.counts {
            let own = self.counts.entry(way).or_default();
            own.iter_mut()
                .zip(counts)
                .for_each(|(own, more)| *own += more);
        }
        self.disagreements.extend(other.disagreements);
        self.refusals.extend(other.refusals);
    }

    /// The part of the comparisons that was refused.
    #[must_use]
    pub fn refused(&self) -> f64 {
        let sum = |which: usize| {
            self.counts
                .values()
                .map(|counts| counts[which])
                .sum::<usize>()
        };
        sum(1) as f64 / (sum(0) + sum(1)).max(1) as f64
    }
}

/// Compares the models of some seeds in some ways.
#[must_use]
pub fn compare(seeds: std::ops::Range<u64>, ways: impl Fn(u64) -> Vec<Way> + Sync) -> Summary {
    let seeds: Vec<u64> = seeds.collect();
    let found: Vec<(u64, Way, Verdict)> = seeds
        .par_iter()
        .flat_map_iter(|&seed| {
            let verdicts = one(seed, &ways(seed));
            verdicts
                .into_iter()
                .map(move |(way, verdict)| (seed, way, verdict))
        })
        .collect();
    let mut summary = Summary::default();
    for (seed, way, verdict) in found {
        let counts = summary.counts.entry(way).or_default();
        match verdict {
            Verdict::Agrees => counts[0] += 1,
            Verdict::Refused(reason) => {
                counts[1] += 1;
                summary
                    .refusals
                    .push(format!("seed {seed}, {way:?}: {reason}"));
            }
            Verdict::Nothing => counts[2] += 1,
            Verdict::Disagrees(reason) => {
                let text = random(seed).text;
                let told = format!("seed {seed}, {way:?}: {reason}\n{text}");
                summary.disagreements.push(told);
            }
        }
    }
    summary
}

/// Compares the model of a seed.
fn one(seed: u64, chosen: &[Way]) -> Vec<(Way, Verdict)> {
    let model = random(seed);
    let subject = match guarded(|| ways::Subject::new(&model)) {
        Ok(Ok(subject)) => subject,
        Ok(Err(reason)) => return vec![(Way::Methods, Verdict::Refused(reason))],
        Err(panic) => return vec![(Way::Methods, Verdict::Disagrees(panic))],
    };
    let verdict = |way: Way| match guarded(|| subject.compare(way)) {
        Ok(verdict) => verdict,
        Err(panic) => Verdict::Disagrees(panic),
    };
    chosen.iter().map(|&way| (way, verdict(way))).collect()
}

/// A panic as what it says.
fn guarded<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| {
        let text = panic.downcast_ref::<String>().cloned();
        let text = text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()));
        format!("a panic: {}", text.unwrap_or_default())
    })
}
