//! [`diagnose`]: takes in one effect after the other, as long as the best passes every gate, and drops what is not missed
//! any more ([`super::forward`]).
//! What counts as more is [`super::evidence`]; everything is chosen inside the records to fit.

use super::answer::{Diagnosis, verdict};
use super::calibrated::calibrate_found;
use super::claims::only_told;
use super::edges::settled;
use super::evidence::{Gates, excess, explained};
use super::finding::findings;
use super::forward::{Branch, Forward};
use super::holding::holding;
use super::hypothesis::Built;
use super::inquiry::Inquiry;
use super::stage::{Ground, Stage};
use super::unknown::{Places, beside, propose, take_in};
use super::whole::whole;
use crate::observer::Innovations;
use crate::plant::Unsupported;
use crate::records::frozen;

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
