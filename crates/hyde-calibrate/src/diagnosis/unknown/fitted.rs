//! A selected law on the whole model: fitted together with all parameters, cut down, judged.
//!
//! The linear answer that selects terms is that of a small effect. Once it is fitted, another first term may be the better
//! one ([`Fitting::with_best_first`]), and further terms may stand for what parameters do then ([`Fitting::shortest`]).

use super::felt::Felt;
use super::found_law::FoundLaw;
use super::law::Summand;
use super::regression::{Selected, select};
use crate::diagnosis::evidence::{Gates, explained};
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::projection::{Projection, change, dot};
use crate::diagnosis::scan::{Node, Score, VISIBLE};
use crate::diagnosis::stage::Stage;
use crate::diagnosis::trial::{Trial, trial, unseen};

/// What the written effect is called.
const NAME: &str = "Found";

/// What a law is to be.
#[derive(Clone, Copy)]
pub(super) struct Wanted {
    /// Its terms at most.
    pub(super) terms: usize,
    /// What it gains in the linear answer at least.
    pub(super) least: f64,
    /// It explains all.
    pub(super) all: bool,
}

/// What laws of a site are fitted on.
pub(super) struct Fitting<'a> {
    pub(super) inquiry: &'a Inquiry<'a>,
    pub(super) stage: &'a Stage,
    pub(super) projection: &'a Projection,
    pub(super) felt: &'a Felt,
    /// What the map of the site says that a law can gain.
    pub(super) most: f64,
    pub(super) wanted: Wanted,
    pub(super) gates: Gates,
}

/// A law that was selected, with its first term fitted alone, if it was.
struct Begun {
    selected: Selected,
    first: Option<Trial>,
}

impl Fitting<'_> {
    /// A law as it is wanted, fitted together with all parameters; `None` where none passes the gates or explains what a
    /// law can, or where gains fall so slowly that its terms are those of a series.
    pub(super) fn law(&self) -> Option<(Trial, Selected)> {
        let gate = self.gates.of_one(&self.stage.solution);
        let own = self.select(gate, None)?;
        if *own.gains.last()? < self.wanted.least {
            return None;
        }
        let begun = self.with_best_first(own, gate);
        let thresholds = &self.gates.thresholds;
        let gains = &begun.selected.gains;
        if let [first, .., before, last] = gains.as_slice()
            && gains.len() == thresholds.law_terms
            && last - before > thresholds.a_part * first
        {
            return None;
        }
        self.shortest(begun).filter(|(trial, _)| {
            let fitted = &trial.stage.solution;
            !self.wanted.all || explained(fitted, thresholds)
        })
    }

    /// Selects terms, the first one if it is not given.
    fn select(&self, gate: f64, first: Option<(Summand, f64)>) -> Option<Selected> {
        let shapes = self.inquiry.shapes;
        select(
            shapes,
            self.felt,
            self.projection,
            gate,
            self.wanted.terms,
            first,
            &self.gates.thresholds,
        )
    }

    /// Selected anew where another first term is better once it is fitted.
    fn with_best_first(&self, mut own: Selected, gate: f64) -> Begun {
        let (felt, projection) = (self.felt, self.projection);
        let (first, gain) = (own.law.terms[0].clone(), own.gains[0]);
        let thresholds = &self.gates.thresholds;
        // As many products as shapes alone: of products there are more.
        let mut rivals: Vec<(Summand, f64)> = Vec::new();
        for rival in &own.others {
            let shapes = rival.0.factors.len();
            let alike = rivals.iter();
            let alike = alike.filter(|(known, _)| known.factors.len() == shapes);
            if rival.1 >= thresholds.rival * gain && alike.count() < thresholds.few {
                rivals.push(rival.clone());
            }
        }
        if rivals.is_empty() {
            return Begun {
                selected: own,
                first: None,
            };
        }
        let gain_of = |trial: &Option<Trial>| {
            let trial = trial.as_ref();
            trial.map_or(f64::NEG_INFINITY, |trial| trial.gain)
        };
        let mut best = (self.fitted(&own.with_first(1, felt, projection)), None);
        // A rival with a constant more has to be worth it; among terms with as many the better one is likelier.
        let constants = first.constants().len();
        let mut most = gain_of(&best.0);
        for rival in rivals {
            let trial = self.fitted(&own.of_other(rival.clone(), felt, projection));
            let more = rival.0.constants().len() > constants;
            if gain_of(&trial) > most + if more { gate } else { 0.0 } {
                most = gain_of(&trial);
                best = (trial, Some(rival));
            }
        }
        let (mut trial, rival) = best;
        if let Some(rival) = rival {
            let mut others = std::mem::take(&mut own.others);
            others.retain(|(term, _)| *term != rival.0);
            others.insert(0, (first, gain));
            let again = self.select(gate, Some(rival));
            trial = trial.filter(|_| again.is_some());
            own = Selected {
                others,
                ..again.unwrap_or(own)
            };
        }
        Begun {
            selected: own,
            first: trial,
        }
    }

    /// The law with as few of its terms as do: a term that the linear answer asked for may stand for what parameters do
    /// once they are fitted. `None` where none passes the gates, or gains enough of what the map says that a law can.
    fn shortest(&self, begun: Begun) -> Option<(Trial, Selected)> {
        let Begun {
            selected: own,
            mut first,
        } = begun;
        let gates = own.gates(self.gates);
        let mut best: Option<(Trial, Selected)> = None;
        for (number, gain) in own.gains.iter().enumerate() {
            if *gain < self.gates.thresholds.mostly * self.most {
                continue;
            }
            let part = own.with_first(number + 1, self.felt, self.projection);
            let alone = first.take().filter(|_| number == 0);
            let Some(trial) = alone.or_else(|| self.fitted(&part)) else {
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
        best
    }

    /// A law fitted together with all parameters.
    fn fitted(&self, own: &Selected) -> Option<Trial> {
        let inquiry = self.inquiry;
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
        let columns: Vec<Vec<f64>> = terms().flat_map(|term| self.felt.columns(term)).collect();
        let sizes: Vec<f64> = terms().flat_map(|term| term.sizes.clone()).collect();
        let (_, parameters) = self.projection.answered(&change(&columns, &sizes));
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
        let ground = inquiry.ground();
        let trial = trial(&ground, self.stage, &hypotheses, &score, &build)?;
        trial.rejected.is_none().then_some(trial)
    }

    /// A law that was fitted, judged on halves of the records that fits had not seen, and fitted to the end.
    pub(super) fn judged(&self, mut trial: Trial, own: Selected) -> Option<(Trial, FoundLaw)> {
        let (ground, stage) = (self.inquiry.ground(), self.stage);
        let gates = own.gates(self.gates);
        let gate = gates.unseen(own.law.freedoms(), trial.inflation);
        let fold_gain = unseen(&ground, stage)? - unseen(&ground, &trial.stage)?;
        if fold_gain < gate {
            return None;
        }
        trial.fold_gain = Some(fold_gain);
        // Trials are fitted by tangents: what is taken in is fitted to the end.
        let polished = trial.stage.polished(&ground).ok()?;
        trial.settle(polished.solution, stage);
        if !trial.tells_a_size() {
            return None;
        }
        let ends = (own.gains.first().copied(), own.gains.last().copied());
        let (first, last) = (ends.0.unwrap_or(f64::NAN), ends.1.unwrap_or(f64::NAN));
        let (_, hypothesis) = own.law.written(NAME, false);
        let equivalents = own.others.iter().take(3);
        let found = FoundLaw {
            gain: trial.gain,
            fold_gain,
            share: last / self.most,
            equivalents: equivalents
                .map(|(term, gain)| (term.clone(), gain / first))
                .collect(),
            gains: own.gains,
            written: own.law.with(&trial.values).written(NAME, true).0,
            law: own.law,
            hypothesis,
        };
        Some((trial, found))
    }
}
