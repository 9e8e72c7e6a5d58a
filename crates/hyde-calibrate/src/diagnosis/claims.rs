//! [`only_told`]: the last gate of a diagnosis: what is claimed is told from its neutral value.
//!
//! An effect passes its gates when it is taken in, beside what is known then. At the end, with every other effect and all
//! parameters fitted beside it, the 95 % interval of its size may hold 0: then the records do not say that it is there. It
//! goes, everything else is fitted again, and what is left is asked the same. Beside an `unknown` without a law an effect
//! is a part of what is missing only if it explains a part that is worth a word. What is left is asked once more with the
//! intervals over all that its records allow of shapes that they do not determine ([`super::undetermined`]): these are the
//! intervals that are printed.

use super::answer::{Diagnosis, Verdict, verdict};
use super::calibrated::calibrate_found;
use super::evidence::{excess, explained};
use super::finding::{Finding, Quantity};
use super::hypothesis::Built;
use super::inquiry::Inquiry;
use super::prune::without;
use super::stage::Stage;
use crate::plant::Unsupported;
use hyde_program::Program;

/// A model with effects, everything in it fitted.
pub struct FoundModel {
    stage: Stage,
}

impl FoundModel {
    /// Its effects: numbers of hypotheses; that of a law is behind the last of the inquiry.
    #[must_use]
    pub fn hypotheses(&self) -> Vec<usize> {
        self.stage.numbers()
    }

    /// Its program, in the observed form.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.stage.program
    }

    /// Everything that was fitted or chosen, by name, SI.
    #[must_use]
    pub fn values(&self) -> Vec<(String, f64)> {
        self.stage.values()
    }

    /// What was minimised.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.stage.solution.cost()
    }
}

impl Diagnosis {
    /// The model that was found.
    #[must_use]
    pub fn model(&self) -> FoundModel {
        FoundModel {
            stage: self.stage(),
        }
    }

    /// The model without one of its findings, everything else fitted again.
    ///
    /// # Errors
    /// The model has no fixed-step form.
    pub fn without(
        &self,
        inquiry: &Inquiry<'_>,
        finding: usize,
    ) -> Result<FoundModel, Unsupported> {
        let ground = self.ground(inquiry);
        let own = inquiry.hypotheses.len();
        let law = self.law().map(|law| &law.written);
        let build = |list: &[usize]| -> Option<Built> {
            let known: Vec<usize> = list.iter().copied().filter(|&one| one != own).collect();
            let written = law.filter(|_| known.len() < list.len());
            (inquiry.author)(&known, written.map_or(&[], std::slice::from_ref))
        };
        let less = without(&ground, &self.stage(), finding, &build);
        let less = less.ok_or_else(Unsupported::singular)?;
        Ok(FoundModel {
            stage: less.polished(&ground)?,
        })
    }

    /// Makes a model with fewer findings the answer, those of them that are told.
    ///
    /// # Errors
    /// The model has no fixed-step form.
    pub fn keep(&mut self, inquiry: &Inquiry<'_>, model: FoundModel) -> Result<(), Unsupported> {
        self.reduce(inquiry, model)?;
        only_told(inquiry, self).map(drop)
    }

    /// The same with intervals as curvature has them.
    fn reduce(&mut self, inquiry: &Inquiry<'_>, model: FoundModel) -> Result<(), Unsupported> {
        let FoundModel { stage } = model;
        let hypotheses = self.hypotheses(inquiry);
        if !stage.has(inquiry.hypotheses.len())
            && let Some(unknown) = &mut self.unknown
        {
            unknown.found = None;
        }
        self.take(stage, &hypotheses);
        calibrate_found(inquiry, self)?;
        self.unexplained = !explained(&self.after, inquiry.thresholds);
        self.verdict = match self.law() {
            Some(_) => Verdict::Unknown,
            None => verdict(
                &self.findings,
                (&self.before, &self.after),
                inquiry.thresholds,
            ),
        };
        Ok(())
    }

    /// Whether what the model has beside one with fewer findings explains a part of what is missing that is worth a word.
    fn explains_a_part_beside(&self, less: &FoundModel, part: f64) -> bool {
        let gained = excess(&less.stage.solution) - excess(&self.after);
        gained >= part * excess(&self.before)
    }
}

/// Drops effects, the least told first, until all that is claimed is told from 0 whatever shapes that the records do not
/// determine might be, and a part of what is missing; the hypotheses that were not told.
pub(super) fn only_told(
    inquiry: &Inquiry<'_>,
    diagnosis: &mut Diagnosis,
) -> Result<Vec<usize>, Unsupported> {
    let mut dropped = Vec::new();
    loop {
        while let Some(number) = least_told(&diagnosis.findings) {
            dropped.push(diagnosis.findings[number].hypothesis);
            let less = diagnosis.without(inquiry, number)?;
            diagnosis.reduce(inquiry, less)?;
        }
        only_parts(inquiry, diagnosis)?;
        diagnosis.spread(inquiry)?;
        if least_told(&diagnosis.findings).is_none() {
            return Ok(dropped);
        }
    }
}

/// Drops effects beside an `unknown` without a law that explain no part of what is missing that is worth a word.
fn only_parts(inquiry: &Inquiry<'_>, diagnosis: &mut Diagnosis) -> Result<(), Unsupported> {
    let mut number = 0;
    while diagnosis.verdict == Verdict::Unknown
        && diagnosis.law().is_none()
        && number < diagnosis.findings.len()
    {
        let less = diagnosis.without(inquiry, number)?;
        if diagnosis.explains_a_part_beside(&less, inquiry.thresholds.a_part) {
            number += 1;
        } else {
            diagnosis.reduce(inquiry, less)?;
        }
    }
    Ok(())
}

/// The finding that is told least of those that are not.
fn least_told(findings: &[Finding]) -> Option<usize> {
    let part = |number: usize| {
        let Quantity {
            value, interval, ..
        } = findings[number].size;
        let part = value.abs() / (interval.1 - interval.0).abs();
        if part.is_finite() { part } else { 0.0 }
    };
    let not = (0..findings.len()).filter(|&number| !findings[number].size.is_told());
    not.min_by(|&a, &b| part(a).total_cmp(&part(b)))
}
