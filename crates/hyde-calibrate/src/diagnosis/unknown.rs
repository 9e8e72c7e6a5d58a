//! [`propose`]: where no effect known explains what is left, a law is made of the model's own variables, written as an
//! effect of the language, and fitted and judged like any other.
//!
//! ```text
//! site           places where a law may act, and the language's words there    unknown/site.rs
//! latent         a force at a site, whatever its course, in the innovations    unknown/latent.rs
//! felt           a site with a probe run along every record                    unknown/felt.rs
//! map            of which variable the force is a function                     unknown/map.rs
//! seen           what records show of a site                                  unknown/seen.rs
//! factor         the shapes a law is a product of                              unknown/factor.rs
//! law            a sum of products; its text                                   unknown/law.rs
//! regression     which products, with which constants                          unknown/regression.rs
//! fitted         the law on the whole model, as short as it can be             unknown/fitted.rs
//! ```
//! The method is that of de Silva, Higdon, Brunton and Kutz (Front. Artif. Intell. 3, 2020, 25) in that the discrepancy of a
//! model is regressed and not the model itself; here in the space of innovations, parameters projected out. A law that
//! explains little of what its map says a force there could explain is refused: the map is the answer then.

mod factor;
mod felt;
mod fitted;
mod latent;
mod law;
mod map;
mod regression;
mod seen;
mod site;

pub use factor::Factor;
pub use latent::LatentForce;
pub use law::{Law, Summand};
pub use map::{Map, Panel, Variable};
pub use seen::{Scales, Seen};
pub use site::{Kind, Site, Written};

use super::hypothesis::{Built, Hypothesis};
use super::projection::Projection;
use super::search::{Diagnosis, Finding, Gates, Verdict, explained};
use super::stage::{Ground, Stage, below};
use super::trial::Trial;
use crate::fit::inflation;
use crate::gain::Observer;
use crate::plant::Unsupported;
use crate::recording::Recording;
use crate::solution::Solution;
use felt::Felt;
use fitted::{shortest, with_best_first};
use rayon::prelude::*;
use regression::{Selected, select};

/// Puts known hypotheses, by number, and written effects on the model; `None` where they cannot be.
pub type Author<'a> = dyn Fn(&[usize], &[Written]) -> Option<Built> + Sync + 'a;

/// Sites whose map gains this part of the best one's are searched for a law, so many at most.
const NEAR: f64 = 0.8;
const SITES: usize = 3;
/// Gains that fall slowly: the last of the most terms a law may have still gains this part of the first.
const SLOW: f64 = 0.1;

/// What a proposal is made from.
#[derive(Clone, Copy)]
pub struct Inquiry<'a> {
    /// The records fitted.
    pub recordings: &'a [Recording],
    /// The observer of the study.
    pub observer: &'a Observer,
    /// Values set from outside, by name, SI.
    pub set: &'a [(String, f64)],
    /// The hypotheses of the diagnosis.
    pub hypotheses: &'a [Hypothesis],
    /// Where a law may act.
    pub sites: &'a [Site],
    /// Compiles.
    pub author: &'a Author<'a>,
}

/// What is missing where no effect known is it.
pub struct Unknown {
    /// The map of the site that explains most, with bands: the signature.
    pub map: Map,
    /// Maps of the other sites, without bands, the best first.
    pub others: Vec<Map>,
    /// The force that the balance at the site would need, record by record.
    pub latent: Vec<LatentForce>,
    /// The law that was found; `None` where no formula is worth its constants.
    pub found: Option<FoundLaw>,
}

/// A law that was found.
pub struct FoundLaw {
    /// The law as it was selected, with what the records show of its site.
    pub law: Law,
    /// The effect written: its text has the values found.
    pub written: Written,
    /// What a report needs of it: it is the hypothesis behind the last one of the diagnosis.
    pub hypothesis: Hypothesis,
    /// What it gained after each term, before it was fitted.
    pub gains: Vec<f64>,
    /// What it gained fitted, and on halves of the records that fits had not seen.
    pub gain: f64,
    /// See [`FoundLaw::gain`].
    pub fold_gain: f64,
    /// What it gains of what the best panel of the map does.
    pub share: f64,
    /// Other forms of the first term with the part of its gain that they have.
    pub equivalents: Vec<(Summand, f64)>,
}

impl FoundLaw {
    /// Its text with other values found.
    pub(super) fn rewrite(&mut self, finding: &Finding) {
        let quantities = finding.sizes.iter().chain(&finding.shapes);
        let values: Vec<f64> = quantities.map(|quantity| quantity.value).collect();
        self.written = self.law.with(&values).written(&self.written.name, true).0;
    }
}

/// Asks what is missing where innovations are not explained, and puts the answer into the diagnosis.
///
/// # Errors
/// The model has no fixed-step form.
pub fn propose(inquiry: &Inquiry<'_>, diagnosis: &mut Diagnosis) -> Result<(), Unsupported> {
    if !(diagnosis.unexplained || is_chain(inquiry, diagnosis)) || inquiry.sites.is_empty() {
        return Ok(());
    }
    let ground = Ground {
        recordings: inquiry.recordings,
        observer: inquiry.observer,
        set: inquiry.set,
    };
    let (base, last) = stages(inquiry, diagnosis)?;
    let tried = diagnosis.rounds.last().map_or(1, |round| round.gates.tried);
    let innovations = inquiry
        .recordings
        .iter()
        .map(|r| r.channels.len() * (r.rows() - r.first_row))
        .sum();
    let gates = Gates { tried, innovations };
    // What was taken in before may have stood for the unknown effect: the law alone is the answer where it does as well
    // as both, and where it does significantly better than what was taken in, or as well with fewer constants.
    let gate = gates.gain(1) * inflation(&last.solution.innovations);
    let mut answer = None;
    if !last.effects.is_empty() {
        let constants = last.varied.len() + last.kept.len() - base.varied.len();
        let better = |alone: &Answer| {
            alone.solution().is_some_and(|(solution, freedoms)| {
                let gain = solution.gain_over(&last.solution);
                gain >= gate || (freedoms < constants && gain >= 0.0)
            })
        };
        let explains = |alone: &Answer| alone.solution().is_some_and(|(own, _)| explained(own));
        answer = law(inquiry, &ground, &base, gates)?.filter(better);
        if answer.as_ref().is_some_and(explains) {
            take_in(inquiry, diagnosis, answer);
            return Ok(());
        }
    }
    if diagnosis.unexplained {
        let both = law(inquiry, &ground, &last, gates)?;
        let as_good = |alone: &Answer| {
            let both = both.as_ref().and_then(Answer::solution);
            let alone = alone.solution();
            alone
                .zip(both)
                .is_none_or(|(alone, both)| alone.0.gain_over(both.0) >= -gate)
        };
        answer = answer.filter(as_good).or(both);
    }
    take_in(inquiry, diagnosis, answer);
    Ok(())
}

/// Whether several effects were taken in at one place where a law may act: they may be the parts of one that is not known.
fn is_chain(inquiry: &Inquiry<'_>, diagnosis: &Diagnosis) -> bool {
    let findings = diagnosis.findings.iter();
    let hypotheses: Vec<&Hypothesis> = findings
        .filter_map(|finding| inquiry.hypotheses.get(finding.hypothesis))
        .collect();
    let may_act = |one: &Hypothesis| inquiry.sites.iter().any(|site| site.path == one.site);
    match hypotheses.as_slice() {
        [first, others @ ..] if !others.is_empty() => {
            may_act(first)
                && others
                    .iter()
                    .all(|other| may_act(other) && at_one_place(first, other))
        }
        _ => false,
    }
}

/// Whether two effects are at one connector, or one of them on a component that is connected there.
fn at_one_place(one: &Hypothesis, other: &Hypothesis) -> bool {
    let is_at = |a: &String, b: &String| a == b || below(a, b).is_some() || below(b, a).is_some();
    let mut places = one.aliases.iter().chain([&one.site]);
    places.any(|a| {
        other
            .aliases
            .iter()
            .chain([&other.site])
            .any(|b| is_at(a, b))
    })
}

/// The site of the answer, the maps of the others, and the law that was found there.
struct Answer {
    place: Felt,
    map: Map,
    others: Vec<Map>,
    projection: Projection,
    found: Option<(FoundLaw, Trial)>,
}

impl Answer {
    /// Where its law leads, with the number of its constants.
    fn solution(&self) -> Option<(&Solution, usize)> {
        let (_, trial) = self.found.as_ref()?;
        Some((&trial.stage.solution, trial.freedoms))
    }

    /// With what a report needs beside it: the bands of the map, and the force that the balance would need.
    fn told(self) -> (Unknown, Option<Trial>) {
        let Self {
            place,
            mut map,
            others,
            projection,
            found,
        } = self;
        map::add_bands(&mut map, &place, &projection);
        let innovations = projection.innovations.as_slice();
        let latent = place.parts();
        let latent =
            latent.filter_map(|(carrier, own)| latent::smoothed(carrier, &innovations[own]));
        let latent = latent.collect();
        let (found, trial) = found.unzip();
        let unknown = Unknown {
            map,
            others,
            latent,
            found,
        };
        (unknown, trial)
    }
}

/// The model without any effect, and with those of the diagnosis.
fn stages(inquiry: &Inquiry<'_>, diagnosis: &Diagnosis) -> Result<(Stage, Stage), Unsupported> {
    let last = diagnosis.stage();
    let program = (inquiry.author)(&[], &[])
        .ok_or_else(Unsupported::singular)?
        .program;
    let mut varied = last.varied_in(&program);
    varied.truncate(diagnosis.before.values.len());
    let base = Stage {
        program,
        effects: Vec::new(),
        varied,
        kept: Vec::new(),
        solution: diagnosis.before.clone(),
    };
    Ok((base, last))
}

/// The law that explains most of what a stage leaves.
fn law(
    inquiry: &Inquiry<'_>,
    ground: &Ground<'_>,
    stage: &Stage,
    gates: Gates,
) -> Result<Option<Answer>, Unsupported> {
    let at = stage.linearise(ground)?;
    let Some(projection) = Projection::new(stage, &at) else {
        return Ok(None);
    };
    let felt = |site: &Site| {
        let felt = Felt::new(ground, stage, site, inquiry.author)?;
        let map = map::map(&felt, &projection);
        Some((felt, map))
    };
    let mut places: Vec<(Felt, Map)> = inquiry.sites.par_iter().filter_map(felt).collect();
    places.sort_by(|a, b| b.1.gain().total_cmp(&a.1.gain()));
    let Some(most) = places.first().map(|(_, map)| map.gain()) else {
        return Ok(None);
    };
    let inflation = inflation(&stage.solution.innovations);
    let gate = gates.gain(1) * inflation;
    let mut selected: Vec<(usize, Selected)> = Vec::new();
    for (number, (felt, map)) in places.iter().enumerate().take(SITES) {
        if map.gain() >= NEAR * most
            && let Some(own) = select(felt, &projection, gate, None)
        {
            let own = with_best_first(inquiry, ground, stage, (felt, &projection), own, gate);
            selected.push((number, own));
        }
    }
    let gain = |own: &Selected| own.gains.last().copied().unwrap_or(0.0);
    selected.sort_by(|a, b| gain(&b.1).total_cmp(&gain(&a.1)));
    let mut best: Option<(usize, FoundLaw, Trial)> = None;
    for (number, own) in selected {
        let slow = own.gains.len() == 3 && own.gains[2] - own.gains[1] > SLOW * own.gains[0];
        if slow {
            continue;
        }
        let (felt, map) = &places[number];
        let at = (felt, &projection, map.gain());
        let Some((trial, found)) = shortest(inquiry, ground, stage, at, &own, gates) else {
            continue;
        };
        if best
            .as_ref()
            .is_none_or(|(_, known, _)| found.fold_gain > known.fold_gain)
        {
            best = Some((number, found, trial));
        }
    }
    let at = best.as_ref().map_or(0, |(number, ..)| *number);
    let (place, map) = places.swap_remove(at);
    let mut others: Vec<Map> = places.into_iter().map(|(_, map)| map).collect();
    others.sort_by(|a, b| b.gain().total_cmp(&a.gain()));
    Ok(Some(Answer {
        place,
        map,
        others,
        projection,
        found: best.map(|(_, found, trial)| (found, trial)),
    }))
}

/// Makes the answer that of the diagnosis.
fn take_in(inquiry: &Inquiry<'_>, diagnosis: &mut Diagnosis, answer: Option<Answer>) {
    let Some(answer) = answer else { return };
    let (unknown, trial) = answer.told();
    if let (Some(trial), Some(own)) = (trial, &unknown.found) {
        let stage = trial.stage;
        let mut hypotheses = inquiry.hypotheses.to_vec();
        hypotheses.push(own.hypothesis.clone());
        diagnosis.unexplained = !explained(&stage.solution);
        diagnosis.verdict = Verdict::Unknown;
        diagnosis.take(stage, &hypotheses);
    }
    diagnosis.unknown = Some(unknown);
}
