//! [`Diagnosis`]: what a search found, and the model with it.

use super::apart::Relation;
use super::evidence::{explained, share};
use super::finding::{Finding, Taken, findings};
use super::forward::Round;
use super::hypothesis::Hypothesis;
use super::inquiry::Inquiry;
use super::spread::spread;
use super::stage::{Ground, Stage};
use super::thresholds::Thresholds;
use super::unknown::{FoundLaw, Unknown};
use crate::fit::{Solution, Varied};
use crate::observer::Observer;
use crate::plant::Unsupported;
use crate::records::Frozen;

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is missing that these records would show.
    None,
    /// These effects are missing.
    Effect,
    /// One of several that these records cannot tell apart.
    OneOf,
    /// Something is missing, and no effect known is it, or is most of it.
    Unknown,
}

/// A diagnosis.
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Verdict,
    /// The effects taken in.
    pub findings: Vec<Finding>,
    /// Their hypotheses, by number, with the paths of their instances.
    pub effects: Vec<(usize, String)>,
    /// The rounds of the search.
    pub rounds: Vec<Round>,
    /// Parameters and costs before any effect, and after all.
    pub before: Solution,
    /// The solution with all effects.
    pub after: Solution,
    /// The program with all effects.
    pub program: hyde_program::Program,
    /// What was varied in the end.
    pub varied: Vec<Varied>,
    /// What stays as it is, by name.
    pub kept: Vec<(String, f64)>,
    /// Something is left that no effect known explains.
    pub unexplained: bool,
    /// What that is, as far as it could be told.
    pub unknown: Option<Unknown>,
    /// The observer that all models were compared by, where it is not that of the inquiry: that of the model found.
    pub observer: Option<Observer>,
    /// Readings that were held for a while: they ask for forces that no drive knows, and no law is sought of them.
    pub frozen: Vec<Frozen>,
    /// Hypotheses that a search before took in and could not tell from their neutral values: this one was made without them.
    pub barred: Vec<usize>,
}

impl Diagnosis {
    /// The model as it was found.
    pub(crate) fn stage(&self) -> Stage {
        Stage {
            program: self.program.clone(),
            effects: self.effects.clone(),
            varied: self.varied.clone(),
            kept: self.kept.clone(),
            solution: self.after.clone(),
        }
    }

    /// The name of the channel that was held.
    #[must_use]
    pub fn channel(&self, held: &Frozen) -> &str {
        &self.program.experiment.measured[held.channel].name
    }

    /// The law among what was found.
    #[must_use]
    pub fn law(&self) -> Option<&FoundLaw> {
        self.unknown.as_ref()?.found.as_ref()
    }

    /// Widens the intervals by what shapes that the records do not determine might be.
    pub(super) fn spread(&mut self, inquiry: &Inquiry<'_>) -> Result<(), Unsupported> {
        let (ground, hypotheses) = (self.ground(inquiry), self.hypotheses(inquiry));
        self.findings = spread(&ground, &hypotheses, &self.stage(), self.findings.clone())?;
        Ok(())
    }

    /// What its models are compared on.
    pub(super) fn ground<'g>(&'g self, inquiry: &'g Inquiry<'g>) -> Ground<'g> {
        Ground {
            observer: self.observer.as_ref().unwrap_or(inquiry.observer),
            ..inquiry.ground()
        }
    }

    /// The hypotheses of the inquiry, and that of a law that was found behind them.
    pub(super) fn hypotheses(&self, inquiry: &Inquiry<'_>) -> Vec<Hypothesis> {
        let law = self.law().map(|law| law.hypothesis.clone());
        inquiry.hypotheses.iter().cloned().chain(law).collect()
    }

    /// Makes a stage the answer. What is known of effects that were found before stays.
    pub(crate) fn take(&mut self, stage: Stage, hypotheses: &[Hypothesis]) {
        let known = std::mem::take(&mut self.findings);
        let round = self.rounds.len();
        let taken = stage.effects.iter().map(|(number, _)| {
            let same = known.iter().find(|finding| finding.hypothesis == *number);
            same.map_or_else(
                || Taken {
                    round,
                    alternatives: Vec::new(),
                },
                Finding::taken,
            )
        });
        self.findings = findings(&stage, hypotheses, taken.collect());
        self.effects = stage.effects;
        self.after = stage.solution;
        self.program = stage.program;
        self.varied = stage.varied;
        self.kept = stage.kept;
    }
}

/// What findings come to, of a model that went from one solution to another by them.
pub(super) fn verdict(
    findings: &[Finding],
    (before, after): (&Solution, &Solution),
    thresholds: &Thresholds,
) -> Verdict {
    let unexplained = !explained(after, thresholds);
    match findings {
        [] if unexplained => Verdict::Unknown,
        [] => Verdict::None,
        _ if unexplained && share(before, after) < thresholds.mostly => Verdict::Unknown,
        list if list
            .iter()
            .any(|own| own.related(Relation::Another).next().is_some()) =>
        {
            Verdict::OneOf
        }
        _ => Verdict::Effect,
    }
}
