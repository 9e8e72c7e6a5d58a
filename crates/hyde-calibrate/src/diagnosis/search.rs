//! [`diagnose`]: takes in one effect after the other, as long as the best passes every gate, and drops what is not missed
//! any more ([`super::forward`]).
//!
//! The gate of a gain is twice what the best of all nodes tried would reach by chance in one of a hundred records without
//! any effect: the quantile of chi squared for the effect's sizes and shapes, after Bonferroni. It grows with what
//! innovations tell less than independent ones. A gain on what was not fitted is also to be material: a part of the
//! number of innovations. Everything is chosen inside the records to fit.

use super::apart::Relation;
use super::calibrated::calibrate_found;
use super::claims::only_told;
use super::edges::settled;
use super::finding::{Finding, findings};
use super::forward::{Branch, Forward, Taken};
use super::holding::holding;
use super::hypothesis::{Built, Hypothesis};
use super::inquiry::Inquiry;
use super::scan::Score;
use super::stage::{Ground, Stage};
use super::thresholds::Thresholds;
use super::trial::Trial;
use super::undetermined::with_undetermined;
use super::unknown::{Places, beside, propose, take_in};
use super::whole::whole;
use crate::fit::{Solution, Varied, inflation};
use crate::observer::{Innovations, Observer};
use crate::plant::Unsupported;
use crate::records::{Frozen, frozen};
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
        let Thresholds { chance, margin, .. } = self.thresholds;
        margin * distributions::chi_squared(freedoms.max(1), chance / self.tried.max(1) as f64)
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

/// A round of the search.
pub struct Round {
    /// Scores, the best first.
    pub scores: Vec<Score>,
    /// What was fitted, the best first.
    pub trials: Vec<Trial>,
    /// The gates.
    pub gates: Gates,
}

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
    pub unknown: Option<super::Unknown>,
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
    pub fn law(&self) -> Option<&super::FoundLaw> {
        self.unknown.as_ref()?.found.as_ref()
    }

    /// Widens the intervals by what shapes that the records do not determine might be.
    pub(super) fn spread(&mut self, inquiry: &Inquiry<'_>) -> Result<(), Unsupported> {
        let (ground, hypotheses) = (self.ground(inquiry), self.hypotheses(inquiry));
        self.findings =
            with_undetermined(&ground, &hypotheses, &self.stage(), self.findings.clone())?;
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

/// Finds what a model lacks.
///
/// # Errors
/// The model has no fixed-step form.
pub fn diagnose(inquiry: &Inquiry<'_>) -> Result<Diagnosis, Unsupported> {
    search_by(inquiry, By::Declared)
}

/// Whose observer all models are compared by.
#[derive(Clone, Copy, PartialEq, Eq)]
enum By {
    Declared,
    Found,
}

fn search_by(inquiry: &Inquiry<'_>, by: By) -> Result<Diagnosis, Unsupported> {
    let (ground, thresholds) = (inquiry.ground(), inquiry.thresholds);
    let frozen = frozen(inquiry.recordings);
    let build = |numbers: &[usize]| (inquiry.author)(numbers, &[]);
    let declared = calibrated(inquiry, &ground)?;
    let innovations = declared.solution.innovations.iter();
    let innovations = innovations.map(Innovations::count).sum();
    let mut search = Forward {
        ground: &ground,
        hypotheses: inquiry.hypotheses,
        build: &build,
        max_effects: inquiry.max_effects,
        barred: inquiry.barred,
        gates: Gates {
            tried: 1,
            innovations,
            left: 0.0,
            thresholds: *thresholds,
        },
        declared: &declared,
        rounds: Vec::new(),
    };
    let mut branch = Branch::of(declared.clone());
    search.round(&mut branch)?;
    if by == By::Declared
        && let Some(observer) = holding(inquiry, &declared, &branch.stage)?
    {
        let own = Inquiry {
            observer: &observer,
            ..*inquiry
        };
        let found = search_by(&own, By::Found)?;
        return Ok(Diagnosis {
            observer: Some(observer),
            ..found
        });
    }
    // A law of one term that explains what no effect does alone, or beside another, spares the rest of the search.
    let (mut law, mut places) = (None, None);
    if frozen.is_empty() && !settled(&declared, &branch.stage, thresholds) {
        places = Places::of(inquiry, &declared)?;
        let looked = places.as_ref();
        let best = looked.and_then(|own| own.plain_law(&branch.stage, search.gates));
        if best.is_some() {
            law = places.take().map(|own| own.answer(best));
        }
    }
    if law.is_none() {
        if !branch.ended {
            search.settle(&mut branch)?;
            search.step(&mut branch)?;
        }
        // A further effect that promises most of what is left is looked at before a law.
        if !explained(&branch.stage.solution, thresholds) {
            let left = excess(&branch.stage.solution);
            if search.promise(&mut branch)? >= thresholds.mostly * left {
                search.step(&mut branch)?;
            }
        }
        if frozen.is_empty() && !settled(&declared, &branch.stage, thresholds) {
            law = beside(inquiry, &search.rounds[0], &branch.stage, search.gates)?;
        }
        if law.is_none() {
            branch = search.followed(branch)?;
        }
    }
    let Forward { rounds, gates, .. } = search;
    let Branch { stage, taken, .. } = branch;
    let stage = whole(&ground, inquiry.hypotheses, stage)?;
    let findings = findings(&stage, inquiry.hypotheses, taken);
    let before = &declared.solution;
    let unexplained = !explained(&stage.solution, thresholds);
    let mut diagnosis = Diagnosis {
        verdict: verdict(&findings, (before, &stage.solution), thresholds),
        findings,
        effects: stage.effects,
        rounds,
        before: before.clone(),
        after: stage.solution,
        program: stage.program,
        varied: stage.varied,
        kept: stage.kept,
        unexplained,
        unknown: None,
        frozen,
        observer: None,
        barred: inquiry.barred.to_vec(),
    };
    match law {
        Some(answer) => take_in(inquiry, &mut diagnosis, answer),
        None => propose(inquiry, &mut diagnosis, &declared, places, gates)?,
    }
    calibrate_found(inquiry, &mut diagnosis)?;
    let dropped = only_told(inquiry, &mut diagnosis)?;
    let nothing = diagnosis.findings.is_empty() && diagnosis.unexplained && !dropped.is_empty();
    if nothing && inquiry.barred.len() < thresholds.retries {
        // What stood in for another effect, better than this where both were begun, is out of its way.
        let barred = [inquiry.barred, &dropped].concat();
        let own = Inquiry {
            barred: &barred,
            ..*inquiry
        };
        let again = search_by(&own, by)?;
        if !again.findings.is_empty() {
            return Ok(again);
        }
    }
    Ok(diagnosis)
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

/// The model as it is declared, calibrated.
fn calibrated(inquiry: &Inquiry<'_>, ground: &Ground<'_>) -> Result<Stage, Unsupported> {
    let Built { program, .. } = (inquiry.author)(&[], &[]).ok_or_else(Unsupported::singular)?;
    let varied = inquiry.varied.to_vec();
    let settings = ground.set_in(&program, &[]);
    let start: Vec<f64> = varied.iter().map(|varied| varied.nominal).collect();
    let solution = ground
        .problem(&program, &varied, &settings, None)
        .solve(&start)?;
    Ok(Stage {
        program,
        effects: Vec::new(),
        varied,
        kept: Vec::new(),
        solution,
    })
}

/// The part of what was more than noise that is explained.
fn share(before: &Solution, after: &Solution) -> f64 {
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
