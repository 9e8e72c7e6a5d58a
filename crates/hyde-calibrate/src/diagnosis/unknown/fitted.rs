//! A selected law on the whole model: fitted together with all parameters, cut down, judged.
//!
//! The linear answer that selects terms is that of a small effect. Once it is fitted, another first term may be the better
//! one ([`with_best_first`]), and further terms may stand for what parameters do then ([`shortest`]).

use super::FoundLaw;
use super::felt::Felt;
use super::law::Summand;
use super::regression::{Selected, select};
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::projection::{Projection, change, dot};
use crate::diagnosis::scan::{Node, Score};
use crate::diagnosis::search::Gates;
use crate::diagnosis::stage::{Ground, Stage};
use crate::diagnosis::trial::{Trial, trial, unseen};

/// What the written effect is called.
const NAME: &str = "Found";
/// A law is refused that gains less than this part of what its map says that one can.
const LEAST_SHARE: f64 = 0.6;
/// Other first terms that gain this part of the best one are fitted beside it, so many at most.
const RIVAL: f64 = 0.9;
const RIVALS: usize = 2;
/// A change of innovations that can be seen: the sum of its squares.
const VISIBLE: f64 = 100.0;

/// Selected anew where another first term is better once it is fitted: the linear answer is that of a small effect.
pub(super) fn with_best_first(
    inquiry: &Inquiry<'_>,
    ground: &Ground<'_>,
    stage: &Stage,
    (felt, projection): (&Felt, &Projection),
    mut own: Selected,
    most_terms: usize,
    gate: f64,
) -> Selected {
    let (first, gain) = (own.law.terms[0].clone(), own.gains[0]);
    let near = |(_, other): &&(Summand, f64)| *other >= RIVAL * gain;
    let rivals: Vec<(Summand, f64)> = own
        .others
        .iter()
        .filter(near)
        .take(RIVALS)
        .cloned()
        .collect();
    if rivals.is_empty() {
        return own;
    }
    let fitted_gain = |part: &Selected| {
        let trial = fitted(inquiry, ground, stage, (felt, projection), part);
        trial.map_or(f64::NEG_INFINITY, |trial| trial.gain)
    };
    let mut most = fitted_gain(&own.with_first(1, felt, projection)) + gate;
    let mut best = None;
    for rival in rivals {
        let gain = fitted_gain(&own.of_other(rival.clone(), felt, projection));
        if gain > most {
            (most, best) = (gain, Some(rival));
        }
    }
    if let Some(rival) = best {
        let mut others = std::mem::take(&mut own.others);
        others.retain(|(term, _)| *term != rival.0);
        others.insert(0, (first, gain));
        let again = select(felt, projection, gate, most_terms, Some(rival));
        own = Selected {
            others,
            ..again.unwrap_or(own)
        };
    }
    own
}

/// The law with as few of its terms as do: a term that the linear answer asked for may stand for what parameters do once
/// they are fitted. `None` where none passes the gates, or explains what the map says that a law can: `most`.
pub(super) fn shortest(
    inquiry: &Inquiry<'_>,
    ground: &Ground<'_>,
    stage: &Stage,
    (felt, projection, most): (&Felt, &Projection, f64),
    own: &Selected,
    gates: Gates,
) -> Option<(Trial, FoundLaw)> {
    let gates = Gates {
        tried: gates.tried + own.tried,
        ..gates
    };
    let mut best: Option<(Trial, Selected)> = None;
    for (number, gain) in own.gains.iter().enumerate() {
        if *gain < LEAST_SHARE * most {
            continue;
        }
        let part = own.with_first(number + 1, felt, projection);
        let Some(trial) = fitted(inquiry, ground, stage, (felt, projection), &part) else {
            continue;
        };
        let known = best.as_ref();
        let (gain, freedoms) =
            known.map_or((0.0, 0), |(trial, part)| (trial.gain, part.law.freedoms()));
        let more = part.law.freedoms() - freedoms;
        if trial.gain - gain < gates.gain(more) * trial.inflation {
            break;
        }
        best = Some((trial, part));
    }
    let (trial, part) = best?;
    judged(ground, stage, trial, part, most, gates)
}

/// A law fitted together with all parameters.
fn fitted(
    inquiry: &Inquiry<'_>,
    ground: &Ground<'_>,
    stage: &Stage,
    (felt, projection): (&Felt, &Projection),
    own: &Selected,
) -> Option<Trial> {
    let (written, hypothesis) = own.law.written(NAME, false);
    let number = inquiry.hypotheses.len();
    let mut hypotheses = inquiry.hypotheses.to_vec();
    hypotheses.push(hypothesis);
    let build = |list: &[usize]| {
        let known: Vec<usize> = list.iter().copied().filter(|&one| one != number).collect();
        let written = (known.len() < list.len()).then_some(&written);
        (inquiry.author)(&known, written.map_or(&[], std::slice::from_ref))
    };
    let terms = || own.law.terms.iter();
    let columns: Vec<Vec<f64>> = terms().flat_map(|term| felt.columns(term)).collect();
    let sizes: Vec<f64> = terms().flat_map(|term| term.sizes.clone()).collect();
    let (_, parameters) = projection.answered(&change(&columns, &sizes));
    let score = Score {
        hypothesis: number,
        nodes: vec![Node {
            shapes: terms().flat_map(Summand::constants).collect(),
            parameters,
            sizes,
            visible: columns
                .iter()
                .map(|column| (VISIBLE / dot(column, column).max(1e-300)).sqrt())
                .collect(),
            gain: *own.gains.last()?,
            linear: true,
        }],
        tried: own.tried,
        linear: false,
        detectable: None,
    };
    let trial = trial(ground, stage, &hypotheses, &score, &build)?;
    trial.rejected.is_none().then_some(trial)
}

/// A law that was fitted, judged on halves of the records that fits had not seen.
fn judged(
    ground: &Ground<'_>,
    stage: &Stage,
    mut trial: Trial,
    own: Selected,
    most: f64,
    gates: Gates,
) -> Option<(Trial, FoundLaw)> {
    let gate = gates.gain(own.law.freedoms()) * trial.inflation;
    let fold_gain = unseen(ground, stage)? - unseen(ground, &trial.stage)?;
    if fold_gain < gate.max(gates.material()) {
        return None;
    }
    trial.fold_gain = Some(fold_gain);
    // Trials are fitted by tangents: what is taken in is fitted to the end.
    let polished = trial.stage.polished(ground).ok()?;
    trial.settle(polished.solution, stage);
    if !trial.tells_a_size() {
        return None;
    }
    let ends = (own.gains.first().copied(), own.gains.last().copied());
    let (first, last) = (ends.0.unwrap_or(f64::NAN), ends.1.unwrap_or(f64::NAN));
    let (_, hypothesis) = own.law.written(NAME, false);
    let found = FoundLaw {
        gain: trial.gain,
        fold_gain,
        share: last / most,
        equivalents: own
            .others
            .iter()
            .take(3)
            .map(|(term, gain)| (term.clone(), gain / first))
            .collect(),
        gains: own.gains,
        written: own.law.with(&trial.values).written(NAME, true).0,
        law: own.law,
        hypothesis,
    };
    Some((trial, found))
}
