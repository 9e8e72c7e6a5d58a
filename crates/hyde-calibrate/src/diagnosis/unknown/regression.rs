//! Forward selection of a law's terms in the space of innovations, all parameters answering (orthogonal matching pursuit:
//! Pati, Rezaiifar and Krishnaprasad, Asilomar 1993), the constants of each term refined before the next.

use super::factor::{Factor, Step, is_of_speed, is_tried};
use super::felt::Felt;
use super::latent::Carrier;
use super::law::{Law, Summand};
use crate::diagnosis::evidence::Gates;
use crate::diagnosis::projection::{Projection, Sums};
use crate::diagnosis::thresholds::Thresholds;
use crate::linear::SIDE_BY_SIDE;
use hyde_ir::LawShape;
use rayon::prelude::*;
use std::cell::LazyCell;
use std::sync::Arc;

/// A law with what it gains in the linear answer.
#[derive(Clone, Debug)]
pub(crate) struct Selected {
    pub(crate) law: Law,
    /// What it gains after each term.
    pub(crate) gains: Vec<f64>,
    /// Other first terms, with what they gain alone, the best first.
    pub(crate) others: Vec<(Summand, f64)>,
    /// Number of terms tried.
    pub(crate) tried: usize,
}

/// Selects terms until the next one gains too little, so many at most; the first may be given, with what it gains.
pub(crate) fn select(
    shapes: &[Arc<LawShape>],
    felt: &Felt,
    projection: &Projection,
    gate: f64,
    most_terms: usize,
    first: Option<(Summand, f64)>,
    thresholds: &Thresholds,
) -> Option<Selected> {
    let dictionary = dictionary(shapes, felt, thresholds.law_cost);
    // Of terms alone, as many as are run side by side at a time; nothing where the first one is given and no other asked.
    let each = LazyCell::new(|| -> Vec<Sums> {
        let several = dictionary.par_chunks(SIDE_BY_SIDE);
        several
            .flat_map_iter(|few| projection.sums_each(&felt.columns_of(few)))
            .collect()
    });
    let alone = |term: &Summand| projection.sums(&felt.columns(term));
    let (mut terms, mut gains): (Vec<Summand>, Vec<f64>) = first.into_iter().unzip();
    let mut others = Vec::new();
    let mut tried = 0;
    while terms.len() < most_terms {
        // What a term gains beside those that are known: of its columns only products are needed.
        let known: Vec<Vec<f64>> = terms.iter().flat_map(|term| felt.columns(term)).collect();
        let (of_known, common) = (projection.sums(&known), felt.common(&known));
        let gain_beside = |term: &Summand, sums: &Sums| {
            let common = felt.common_with(term, &common);
            projection
                .answer_from(&sums.beside(&of_known, &common))
                .gain
        };
        let gain_of = |term: &Summand| gain_beside(term, &alone(term));
        let mut scored: Vec<(Summand, f64)> = dictionary
            .par_iter()
            .zip(&*each)
            .map(|(term, sums)| (term.clone(), gain_beside(term, sums)))
            .filter(|(_, gain)| gain.is_finite())
            .collect();
        tried += scored.len();
        scored.sort_by(|a, b| b.1.total_cmp(&a.1));
        // The best of each form, as many products as shapes alone: there are more of them.
        let most = scored.first().map_or(0.0, |(_, gain)| *gain);
        let before = gains.last().copied().unwrap_or(0.0);
        let mut forms: Vec<(Summand, f64)> = Vec::new();
        for (term, gain) in scored {
            let worth = gain - before >= thresholds.contender * (most - before);
            let new = !forms.iter().any(|(known, _)| same_form(known, &term));
            let alike = forms.iter();
            let alike = alike.filter(|(known, _)| known.factors.len() == term.factors.len());
            if worth && new && alike.count() < 2 * thresholds.few {
                forms.push((term, gain));
            }
        }
        let refined = forms
            .into_par_iter()
            .map(|(term, gain)| refine(felt, &term, gain, &gain_of));
        let mut refined: Vec<(Summand, f64)> = refined.collect();
        refined.sort_by(|a, b| b.1.total_cmp(&a.1));
        let best = refined.first()?.1;
        let least = gains
            .first()
            .map_or(gate, |first: &f64| gate.max(thresholds.negligible * first));
        if best - before < least {
            break;
        }
        // Of those that are as good, the one with the fewest constants.
        let freedoms = |term: &Summand| term.sizes.len() + term.constants().len();
        let alike = refined.iter().enumerate();
        let (chosen, _) = alike
            .filter(|(_, (_, gain))| *gain >= best - gate)
            .min_by_key(|(number, (term, _))| (freedoms(term), *number))?;
        let (term, gain) = refined.remove(chosen);
        if terms.is_empty() {
            others = refined;
        }
        terms.push(term);
        gains.push(gain);
    }
    if terms.is_empty() {
        return None;
    }
    Some(Selected {
        law: sized(felt, projection, terms),
        gains,
        others,
        tried,
    })
}

impl Selected {
    /// The gates once its terms have been tried.
    pub(crate) fn gates(&self, before: Gates) -> Gates {
        Gates {
            tried: before.tried + self.tried,
            ..before
        }
    }

    /// The law of another first term alone.
    pub(crate) fn of_other(
        &self,
        (term, gain): (Summand, f64),
        felt: &Felt,
        projection: &Projection,
    ) -> Self {
        Self {
            law: sized(felt, projection, vec![term]),
            gains: vec![gain],
            ..self.clone()
        }
    }

    /// The same with its first terms alone.
    pub(crate) fn with_first(&self, count: usize, felt: &Felt, projection: &Projection) -> Self {
        let terms = self.law.terms[..count].to_vec();
        Self {
            law: sized(felt, projection, terms),
            gains: self.gains[..count].to_vec(),
            ..self.clone()
        }
    }
}

/// A law of terms, their sizes in the linear answer.
fn sized(felt: &Felt, projection: &Projection, mut terms: Vec<Summand>) -> Law {
    let columns: Vec<Vec<f64>> = terms.iter().flat_map(|term| felt.columns(term)).collect();
    let mut sizes = projection.answer(&columns).sizes.into_iter();
    for term in &mut terms {
        let own: Vec<f64> = sizes.by_ref().take(term.sizes.len()).collect();
        term.sizes = own;
    }
    Law {
        site: felt.site.clone(),
        terms,
        seen: felt.seen,
    }
}

fn same_form(a: &Summand, b: &Summand) -> bool {
    a.factors.len() == b.factors.len()
        && a.factors
            .iter()
            .zip(&b.factors)
            .all(|(a, b)| a.has_shape_of(b))
}

/// Constants by which a term gains most: a pattern search (Hooke and Jeeves, J. ACM 8, 1961, 212).
fn refine(
    felt: &Felt,
    term: &Summand,
    gain: f64,
    gain_of: &(dyn Fn(&Summand) -> f64 + Sync),
) -> (Summand, f64) {
    let (mut best, mut most) = (term.clone(), gain);
    let factors = term.factors.iter();
    let first: Vec<Step> = factors
        .flat_map(|factor| factor.steps(&felt.seen))
        .collect();
    // What is left of each first step.
    let mut parts = vec![1.0; first.len()];
    for _ in 0..40 {
        if parts.iter().all(|part| *part < 0.02) {
            break;
        }
        for (which, (step, part)) in first.iter().zip(&mut parts).enumerate() {
            let mut moved = false;
            for sign in [1.0, -1.0] {
                let mut constants = best.constants();
                match step {
                    Step::Added(step) => constants[which] += sign * *part * step,
                    Step::Ratio(step) => constants[which] *= (sign * *part * step).exp(),
                }
                let new = best.with(&constants);
                if !new.factors.iter().all(|factor| factor.is_told(&felt.seen)) {
                    continue;
                }
                let gain = gain_of(&new);
                if gain > most {
                    (best, most, moved) = (new, gain, true);
                    break;
                }
            }
            if !moved {
                *part *= 0.5;
            }
        }
    }
    (best, most)
}

/// The terms that are tried at a site: shapes of speed times shapes of something else, of so much cost together at most.
fn dictionary(shapes: &[Arc<LawShape>], felt: &Felt, most_cost: usize) -> Vec<Summand> {
    let seen = &felt.seen;
    let tried = shapes
        .iter()
        .filter(|shape| is_tried(shape, &felt.site.kind, seen));
    let (of_speed, others): (Vec<_>, Vec<_>) = tried.partition(|shape| is_of_speed(shape));
    let few = |shape: &LawShape| shape.few.unwrap_or(usize::MAX);
    let mut found = vec![Summand::new(&[])];
    for shape in of_speed.iter().chain(&others) {
        found.extend(Factor::tried(shape, seen).map(|factor| Summand::new(&[factor])));
    }
    for speed in &of_speed {
        for other in others
            .iter()
            .filter(|other| (speed.cost + other.cost) as usize <= most_cost)
        {
            let most = match other.cost {
                0 => [usize::MAX; 2],
                _ => [few(speed), few(other)],
            };
            for second in Factor::tried(other, seen).take(most[1]) {
                for first in Factor::tried(speed, seen).take(most[0]) {
                    found.push(Summand::new(&[first, second.clone()]));
                }
            }
        }
    }
    found
}

/// What the best wave over place gains, by itself or times speed; in proportion to speed a friction is a force.
pub(crate) fn best_wave(shapes: &[Arc<LawShape>], felt: &Felt, projection: &Projection) -> f64 {
    let kind = &felt.site.kind;
    let waves = shapes.iter().filter(|shape| {
        let tried = is_tried(shape, kind, &felt.seen) && !is_of_speed(shape);
        tried && shape.outputs.len() > 1
    });
    let of = |shape| Factor::tried(shape, &felt.seen).take(shape.few.unwrap_or(usize::MAX));
    let all: Vec<Factor> = waves.flat_map(of).collect();
    let gain = |few: &[Factor]| {
        let forces = |carrier: &Carrier| {
            let course = &carrier.course;
            let alone = few.iter().flat_map(|wave| wave.along(course, &felt.seen));
            let mut forces: Vec<Vec<f64>> = alone.collect();
            if !kind.is_grip() {
                let times_speed = |force: &Vec<f64>| {
                    let rows = force.iter().zip(&course.speed);
                    rows.map(|(value, speed)| value * (speed / felt.scales.speed))
                        .collect()
                };
                forces.extend(forces.iter().map(times_speed).collect::<Vec<_>>());
            }
            forces
        };
        let changes = felt.changes_along(&forces);
        let mut pairs: Vec<Vec<Vec<f64>>> = Vec::new();
        let mut changes = changes.into_iter();
        for wave in few.iter().cycle() {
            let own: Vec<Vec<f64>> = changes.by_ref().take(wave.values().len()).collect();
            if own.is_empty() {
                break;
            }
            pairs.push(own);
        }
        let sums = projection.sums_each(&pairs);
        let gains = sums.iter().map(|sums| projection.answer_from(sums).gain);
        gains.fold(0.0, f64::max)
    };
    // A wave has two columns.
    let few = all.par_chunks(SIDE_BY_SIDE / 2);
    few.map(gain).reduce(|| 0.0, f64::max)
}
