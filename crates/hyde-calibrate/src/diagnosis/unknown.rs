//! [`propose`]: where no effect known explains what is left, a law is made of the model's own variables, written as an
//! effect of the language, and fitted and judged like any other.
//!
//! ```text
//! site           where a law may act, as declared, and the words for it        unknown/site.rs
//! probe          an effect by which a force at a site is felt                  unknown/probe.rs
//! latent         a force at a site, whatever its course, in the innovations    unknown/latent.rs
//! felt           a site with a probe run along every record                    unknown/felt.rs
//! map            of which variable the force is a function                     unknown/map.rs
//! seen           what records show of a site                                   unknown/seen.rs
//! factor         a shape of the library with its constants                       unknown/factor.rs
//! law            a sum of products; its text                                   unknown/law.rs
//! regression     which products, with which constants                          unknown/regression.rs
//! places         the sites of a stage, and the law that explains most there    unknown/places.rs
//! fitted         the law on the whole model, as short as it can be             unknown/fitted.rs
//! found law      what is missing, and the law that was found                   unknown/found_law.rs
//! ```
//! The method is that of de Silva, Higdon, Brunton and Kutz (Front. Artif. Intell. 3, 2020, 25) in that the discrepancy of a
//! model is regressed and not the model itself; here in the space of innovations, parameters projected out. A law that
//! explains little of what its map says a force there could explain is refused: the map is the answer then.

mod factor;
mod felt;
mod fitted;
mod found_law;
mod latent;
mod law;
mod map;
mod places;
mod probe;
mod regression;
mod seen;
mod site;

pub use factor::Factor;
pub(crate) use felt::Felt;
pub use found_law::{FoundLaw, Unknown};
pub use latent::LatentForce;
pub use law::{Law, Summand};
pub use map::{Map, Panel, Variable};
pub(crate) use places::{Answer, Places};
pub(crate) use probe::{Point, probe, probes, sizes_of, strongest};
pub use seen::{Scales, Seen};
pub use site::{Kind, LawVariable, Site, Written};

use super::answer::{Diagnosis, Verdict};
use super::edges::settled;
use super::evidence::{Gates, explained};
use super::forward::Round;
use super::hypothesis::Hypothesis;
use super::inquiry::Inquiry;
use super::stage::{Stage, below};
use super::trial::Trial;
use crate::plant::Unsupported;

/// Asks what is missing where innovations are not explained, and puts the answer into the diagnosis. `places` are those of
/// the declared model, if they are known.
pub(super) fn propose(
    inquiry: &Inquiry<'_>,
    diagnosis: &mut Diagnosis,
    declared: &Stage,
    places: Option<Places<'_>>,
    gates: Gates,
) -> Result<(), Unsupported> {
    let last = diagnosis.stage();
    let here = match settled(declared, &last, inquiry.thresholds) {
        true => sites_of_made_up(inquiry, diagnosis),
        false => inquiry.sites.to_vec(),
    };
    if here.is_empty() {
        return Ok(());
    }
    let there = Inquiry {
        sites: &here,
        ..*inquiry
    };
    let places = match places {
        Some(places) => Some(places),
        None => Places::of(&there, declared)?,
    };
    let lawful = diagnosis.frozen.is_empty();
    let law = |places: Places<'_>, least: f64| match lawful {
        true => places.law(least, gates),
        false => places.answer(None),
    };
    // A law alone has to gain what the effects do that were taken in.
    let theirs = last.solution.gain_over(&declared.solution);
    let least = inquiry.thresholds.contender * theirs;
    let Some(alone) = places.map(|places| law(places, least)) else {
        return Ok(());
    };
    if last.effects.is_empty() {
        take_in(inquiry, diagnosis, alone);
        return Ok(());
    }
    // What was taken in before may have stood for the unknown effect: the law alone is the answer where it does as well
    // as both, and where it does significantly better than what was taken in, or as well with fewer constants.
    let gate = gates.of_one(&last.solution);
    let constants = last.varied.len() + last.kept.len() - declared.varied.len();
    let better = |alone: &Answer| {
        alone.solution().is_some_and(|(solution, freedoms)| {
            let gain = solution.gain_over(&last.solution);
            gain >= gate || (freedoms < constants && gain >= 0.0)
        })
    };
    let mut answer = Some(alone).filter(better);
    let explains = |alone: &Answer| {
        alone
            .solution()
            .is_some_and(|(own, _)| explained(own, inquiry.thresholds))
    };
    let room = last.effects.len() < inquiry.max_effects;
    if room && diagnosis.unexplained && !answer.as_ref().is_some_and(explains) {
        let both = Places::of(inquiry, &last)?.map(|places| law(places, 0.0));
        let as_good = |alone: &Answer| {
            let both = both.as_ref().and_then(Answer::solution);
            let alone = alone.solution();
            alone
                .zip(both)
                .is_none_or(|(alone, both)| alone.0.gain_over(both.0) >= -gate)
        };
        answer = answer.filter(as_good).or(both);
    }
    if let Some(answer) = answer {
        take_in(inquiry, diagnosis, answer);
    }
    Ok(())
}

/// The law of one term that explains all beside one of the effects that were best in the first round, and better than what
/// was taken in since: a form of friction bends towards what is missing beside it, and what comes next stands on that. The
/// effect passed its gates, or does where nothing else is missing: the law says what had inflated them.
pub(super) fn beside(
    inquiry: &Inquiry<'_>,
    first: &Round,
    last: &Stage,
    gates: Gates,
) -> Result<Option<Answer>, Unsupported> {
    let fine = |trial: &&Trial| trial.passed() || trial.would_pass(first.gates);
    let best = first.trials.iter().filter(fine).map(|trial| trial.gain);
    let least = inquiry.thresholds.rival * best.fold(0.0, f64::max);
    let ones = first.trials.iter().filter(fine);
    let ones = ones.filter(|trial| trial.gain >= least);
    let law = |inquiry: &Inquiry<'_>, trial: &Trial| -> Result<Option<Answer>, Unsupported> {
        let places = Places::of(inquiry, &trial.stage)?;
        Ok(places.and_then(|places| {
            let law = places.plain_law(last, gates)?;
            Some(places.answer(Some(law)))
        }))
    };
    let gain = |answer: &Answer| {
        let found = answer.solution();
        found.map_or(0.0, |(own, _)| own.gain_over(&last.solution))
    };
    let mut found: Option<Answer> = None;
    for trial in ones.take(inquiry.thresholds.few) {
        // Beside another first one the law is sought at its site, and everywhere only if it does better there.
        if let Some(known) = &found {
            let there = Inquiry {
                sites: std::slice::from_ref(known.site()),
                ..*inquiry
            };
            if law(&there, trial)?.is_none_or(|own| gain(&own) <= gain(known)) {
                continue;
            }
        }
        found = law(inquiry, trial)?.or(found);
    }
    Ok(found)
}

/// The sites where what explains all may be made up of what is not there: several effects for one, or one that shapes bend
/// until it looks like another. Of a single effect with one shape at most there is no simpler law.
fn sites_of_made_up(inquiry: &Inquiry<'_>, diagnosis: &Diagnosis) -> Vec<Site> {
    let findings = diagnosis.findings.iter();
    let effects: Vec<&Hypothesis> = findings
        .filter_map(|finding| inquiry.hypotheses.get(finding.hypothesis))
        .collect();
    if effects.len() < 2 && effects.iter().all(|effect| effect.shapes.len() < 2) {
        return Vec::new();
    }
    let is_near = |site: &&Site| effects.iter().any(|effect| at_one_place(effect, site));
    inquiry.sites.iter().filter(is_near).cloned().collect()
}

/// Whether an effect and a law are at one connector, or one of them on a component that is connected there.
fn at_one_place(one: &Hypothesis, other: &Site) -> bool {
    let is_at = |a: &String, b: &String| a == b || below(a, b).is_some() || below(b, a).is_some();
    let mut places = one.aliases.iter().chain([&one.site]);
    places.any(|a| {
        other
            .aliases
            .iter()
            .chain([&other.path])
            .any(|b| is_at(a, b))
    })
}

/// Makes the answer that of the diagnosis.
pub(super) fn take_in(inquiry: &Inquiry<'_>, diagnosis: &mut Diagnosis, answer: Answer) {
    let (unknown, trial) = answer.told();
    if let (Some(trial), Some(own)) = (trial, &unknown.found) {
        let stage = trial.stage;
        let mut hypotheses = inquiry.hypotheses.to_vec();
        hypotheses.push(own.hypothesis.clone());
        diagnosis.unexplained = !explained(&stage.solution, inquiry.thresholds);
        diagnosis.verdict = Verdict::Unknown;
        diagnosis.take(stage, &hypotheses);
    }
    diagnosis.unknown = Some(unknown);
}
