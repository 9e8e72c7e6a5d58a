//! Forward selection of a law's terms in the space of innovations, all parameters answering (orthogonal matching pursuit:
//! Pati, Rezaiifar and Krishnaprasad, Asilomar 1993), the constants of each term refined before the next.

use super::factor::Factor;
use super::felt::Felt;
use super::law::{Law, Summand};
use super::seen::Seen;
use crate::diagnosis::projection::{Projection, Sums};
use crate::diagnosis::search::Gates;
use crate::linear::SIDE_BY_SIDE;
use rayon::prelude::*;
use std::cell::LazyCell;

/// Terms of a law at most.
pub(crate) const MOST_TERMS: usize = 3;
/// A further term is to gain this part of the first.
const LEAST_PART: f64 = 0.01;
/// Terms whose constants are refined in a round, and the part of the best one's gain that they must have before.
const REFINED: usize = 8;
const PROMISING: f64 = 0.4;
/// Wave numbers tried of a wave alone, and of one times another shape.
const WAVES: usize = 240;
const MIXED_WAVES: usize = 120;

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
    felt: &Felt,
    projection: &Projection,
    gate: f64,
    most_terms: usize,
    first: Option<(Summand, f64)>,
) -> Option<Selected> {
    let dictionary = dictionary(felt);
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
        // The best of each form.
        let most = scored.first().map_or(0.0, |(_, gain)| *gain);
        let before = gains.last().copied().unwrap_or(0.0);
        let mut forms: Vec<(Summand, f64)> = Vec::new();
        for (term, gain) in scored {
            let worth = gain - before >= PROMISING * (most - before);
            let new = !forms.iter().any(|(known, _)| same_form(known, &term));
            if worth && new && forms.len() < REFINED {
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
            .map_or(gate, |first: &f64| gate.max(LEAST_PART * first));
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
            .all(|(a, b)| std::mem::discriminant(a) == std::mem::discriminant(b))
}

/// Constants by which a term gains most: a pattern search (Hooke and Jeeves, J. ACM 8, 1961, 212).
fn refine(
    felt: &Felt,
    term: &Summand,
    gain: f64,
    gain_of: &(dyn Fn(&Summand) -> f64 + Sync),
) -> (Summand, f64) {
    let (mut best, mut most) = (term.clone(), gain);
    let mut steps = first_steps(term, &felt.seen, felt.site.kind.turns());
    let first = steps.clone();
    for _ in 0..40 {
        if steps
            .iter()
            .zip(&first)
            .all(|(step, first)| *step < 0.02 * first)
        {
            break;
        }
        for which in 0..steps.len() {
            let mut moved = false;
            for sign in [1.0, -1.0] {
                let mut constants = best.constants();
                let shift = sign * steps[which];
                if is_centre(&best, which) {
                    constants[which] += shift;
                } else {
                    constants[which] *= shift.exp();
                }
                let new = best.with(&constants);
                if !new
                    .factors
                    .iter()
                    .all(|f| f.is_told(&felt.seen, felt.site.kind.turns()))
                {
                    continue;
                }
                let gain = gain_of(&new);
                if gain > most {
                    (best, most, moved) = (new, gain, true);
                    break;
                }
            }
            if !moved {
                steps[which] *= 0.5;
            }
        }
    }
    (best, most)
}

/// Whether a constant is a place or a speed about which something is, which may be 0.
fn is_centre(term: &Summand, which: usize) -> bool {
    let mut number = 0;
    for factor in &term.factors {
        let own = factor.constants().len();
        if which < number + own {
            return own == 2 && which == number;
        }
        number += own;
    }
    false
}

/// The steps that a search for constants begins with: half of a grid's.
fn first_steps(term: &Summand, seen: &Seen, turns: bool) -> Vec<f64> {
    let mut steps = Vec::new();
    for factor in &term.factors {
        let constants = factor.constants();
        match factor {
            Factor::Wave(p) if turns => {
                steps.push(std::f64::consts::PI / (2.0 * seen.travel() * p));
            }
            Factor::Wave(p) => steps.push(p / (4.0 * seen.travel())),
            Factor::SpeedBump(_, width) | Factor::Bump(_, width) | Factor::Step(_, width) => {
                steps.extend([0.5 * width, 0.3]);
            }
            Factor::Speed
            | Factor::Magnitude
            | Factor::SignedSquare
            | Factor::Square
            | Factor::Cube
            | Factor::Place
            | Factor::PlaceMagnitude
            | Factor::PlaceSquare
            | Factor::PlaceSignedSquare
            | Factor::PlaceCube
            | Factor::Yielding(_)
            | Factor::Time
            | Factor::Switching(_)
            | Factor::Turning(_)
            | Factor::Forwards(_)
            | Factor::Backwards(_)
            | Factor::Falling(_)
            | Factor::Bell(_)
            | Factor::Lagged(_)
            | Factor::Worked(_)
            | Factor::Fading(_) => steps.extend(constants.iter().map(|_| 0.3)),
        }
    }
    steps
}

/// The terms that are tried at a site: shapes of speed times shapes of place or time.
fn dictionary(felt: &Felt) -> Vec<Summand> {
    let kind = &felt.site.kind;
    let seen = &felt.seen;
    let parts = |count: i32, least: f64| -> Vec<f64> {
        // From a part of the speed up to it, in equal ratios.
        (0..count)
            .map(|k| seen.speed * least.powf(1.0 - f64::from(k) / f64::from(count - 1)))
            .collect()
    };
    let mut speeds: Vec<Vec<Factor>> = vec![Vec::new()];
    // A friction in proportion to speed is a force, and tried as such.
    if !kind.is_grip() {
        speeds.extend([vec![Factor::Speed], vec![Factor::Magnitude]]);
    }
    let simple = speeds.clone();
    // What acts by direction may do so at one place alone.
    let mut by_direction: Vec<Vec<Factor>> = Vec::new();
    let duration = seen.time.1 - seen.time.0;
    if kind.is_grip() {
        for vs in parts(8, 0.005) {
            speeds.extend([vec![Factor::Falling(vs)], vec![Factor::Bell(vs)]]);
        }
        for v0 in parts(8, 0.05) {
            speeds.push(vec![Factor::SpeedBump(v0, 0.3 * v0)]);
        }
    } else {
        speeds.extend([
            vec![Factor::SignedSquare],
            vec![Factor::Square],
            vec![Factor::Cube],
        ]);
        for (number, vs) in parts(5, 0.005).into_iter().enumerate() {
            let shapes = [Factor::Switching, Factor::Forwards, Factor::Backwards];
            let shapes = shapes.map(|shape| vec![shape(vs)]);
            if number % 2 == 0 {
                by_direction.extend(shapes.clone());
            }
            speeds.extend(shapes);
            speeds.push(vec![Factor::Turning(vs)]);
        }
        let taus = [0.003, 0.01, 0.03, 0.1].map(|part| part * duration.min(3.0));
        speeds.extend(taus.map(|tau| vec![Factor::Lagged(tau)]));
    }
    let travel = seen.travel();
    let mut others: Vec<Vec<Factor>> = vec![
        Vec::new(),
        vec![Factor::Place],
        vec![Factor::PlaceSquare],
        vec![Factor::Time],
    ];
    for tau in [0.1, 0.3, 1.0] {
        others.push(vec![Factor::Fading(tau * duration)]);
        others.push(vec![Factor::Worked(0.1 * tau * duration)]);
    }
    // A spring becomes stiffer as it is stretched, or yields; an amplifier gives less than it is asked for.
    let bends = kind.bends_about_zero();
    if bends {
        others.extend([vec![Factor::PlaceSignedSquare], vec![Factor::PlaceCube]]);
        for part in [0.03, 0.1, 0.3] {
            others.push(vec![Factor::Yielding(part * travel)]);
        }
    } else {
        others.push(vec![Factor::PlaceMagnitude]);
    }
    let mut places: Vec<Vec<Factor>> = Vec::new();
    for count in [10, 24] {
        let width = 1.2 * travel / f64::from(count);
        for k in 0..=count {
            let centre = seen.place.0 + travel * f64::from(k) / f64::from(count);
            places.push(vec![Factor::Bump(centre, 0.6 * width)]);
        }
    }
    for k in 1..8 {
        let centre = seen.place.0 + travel * f64::from(k) / 8.0;
        places.push(vec![Factor::Step(centre, 0.05 * travel)]);
    }
    let mut found = Vec::new();
    let mut add = |speed: &[Factor], other: &[Factor]| {
        let factors = [speed, other].concat();
        found.push(Summand::new(&factors));
    };
    for speed in &speeds {
        for other in &others {
            add(speed, other);
        }
    }
    for speed in simple.iter().chain(&by_direction) {
        for place in &places {
            add(speed, place);
        }
    }
    for speed in simple.iter().filter(|_| !bends) {
        let count = if speed.is_empty() { WAVES } else { MIXED_WAVES };
        for wave in waves(felt, count) {
            add(speed, &[wave]);
        }
    }
    found
}

/// Waves over place, half a turn further each over the whole way.
fn waves(felt: &Felt, count: usize) -> impl Iterator<Item = Factor> {
    let (turns, travel) = (felt.site.kind.turns(), felt.seen.travel());
    (1..=count).map(move |k| {
        let half_turns = k as f64;
        Factor::Wave(if turns {
            half_turns * std::f64::consts::PI / travel
        } else {
            2.0 * travel / half_turns
        })
    })
}

/// What the best wave over place gains, by itself or times speed; in proportion to speed a friction is a force.
pub(crate) fn best_wave(felt: &Felt, projection: &Projection) -> f64 {
    let kind = &felt.site.kind;
    if kind.bends_about_zero() {
        return 0.0;
    }
    let all: Vec<Factor> = waves(felt, MIXED_WAVES).collect();
    let gain = |few: &[Factor]| {
        let mut terms: Vec<Summand> = few.iter().map(|wave| Summand::new(&[*wave])).collect();
        if !kind.is_grip() {
            terms.extend(few.iter().map(|wave| Summand::new(&[Factor::Speed, *wave])));
        }
        let sums = projection.sums_each(&felt.columns_of(&terms));
        let gains = sums.iter().map(|sums| projection.answer_from(sums).gain);
        gains.fold(0.0, f64::max)
    };
    // A wave has two columns.
    let few = all.par_chunks(SIDE_BY_SIDE / 2);
    few.map(gain).reduce(|| 0.0, f64::max)
}
