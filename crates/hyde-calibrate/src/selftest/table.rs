//! [`tally`]: the outcomes of all cases, counted: what was planted against what was found.

use super::case::{Case, Planting};
use super::trial::{Claim, Outcome};
use crate::diagnosis::Relation;
use std::collections::BTreeMap;

/// What is claimed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Found {
    /// Nothing.
    Nothing,
    /// A hypothesis, by number.
    Effect(usize),
    /// A law that no known effect is.
    Law,
}

impl Found {
    fn of(claim: Option<&Claim>) -> Self {
        match claim.map(|claim| claim.hypothesis) {
            None => Self::Nothing,
            Some(Some(number)) => Self::Effect(number),
            Some(None) => Self::Law,
        }
    }
}

/// What became of one hypothesis, planted at all sizes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Row {
    /// Number of the hypothesis.
    pub hypothesis: usize,
    /// Cases in which it showed, and of these those in which it was named first.
    pub visible: usize,
    /// It was named first: itself, or one of those it cannot be told from.
    pub right: usize,
    /// It was claimed alone, its site included.
    pub alone: usize,
    /// Cases in which it did not show, and of these those in which it was named all the same.
    pub hidden: usize,
    /// Named though it hardly shows.
    pub hidden_right: usize,
    /// Cases in which it did not show and another was named.
    pub hidden_wrong: usize,
    /// What it was taken for where it showed.
    pub taken_for: BTreeMap<Found, usize>,
    /// Further effects claimed beside it.
    pub extras: usize,
    /// The least size at which it began to show, SI.
    pub detectable: Option<f64>,
    /// Ratios of the size found to the size planted, where it was named itself.
    pub ratios: Vec<f64>,
}

/// All of them, and the controls: cases, and those of them that came out right.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// A row for each hypothesis that was planted.
    pub rows: Vec<Row>,
    /// Nothing planted: right is `none`.
    pub empty: (usize, usize),
    /// A parameter off: right is `none`.
    pub parameter: (usize, usize),
    /// An effect that the search does not know and that shows: right is to claim no known one, or one that repeats it, or to
    /// say that something is left beside it.
    pub open_set: (usize, usize),
    /// Of these, how often a known effect was claimed that repeats it.
    pub equivalents: usize,
    /// Of these, how often a neighbour was named that effect's own list of confusions has.
    pub neighbours: usize,
    /// Of these, how often a law of its own was written.
    pub laws: usize,
    /// A faulty sensor: right is to claim no effect.
    pub sensor: (usize, usize),
    /// Verdicts `one of` of planted effects that were diagnosed again with a designed record, and of these those in which the
    /// planted effect alone was named then.
    pub designed: (usize, usize),
    /// Keys of controls that came out wrong, with what was claimed.
    pub wrong: Vec<(String, Vec<Found>)>,
}

/// Counts outcomes. `confounds` says which hypotheses an effect is easily taken for.
#[must_use]
pub fn tally(outcomes: &[(&Case, Outcome)], confounds: &dyn Fn(usize, usize) -> bool) -> Table {
    let mut table = Table::default();
    let mut rows: BTreeMap<usize, Row> = BTreeMap::new();
    for (case, outcome) in outcomes {
        let claims = outcome.claims.iter();
        let claimed: Vec<Found> = claims.map(|claim| Found::of(Some(claim))).collect();
        let right = outcome.is_right(&case.kind);
        let counter = match case.kind {
            Planting::Planted(number, _) => {
                let row = rows.entry(number).or_default();
                row.hypothesis = number;
                count(row, outcome);
                if let Some(designed) = &outcome.designed {
                    table.designed.0 += 1;
                    table.designed.1 += usize::from(designed.resolves(number));
                }
                continue;
            }
            Planting::Empty => &mut table.empty,
            Planting::Parameter(_) => &mut table.parameter,
            Planting::Sensor(..) => &mut table.sensor,
            Planting::OpenSet(number, _) => {
                if !outcome.is_visible() {
                    continue;
                }
                let near = |found: &Found| match *found {
                    Found::Nothing | Found::Law => false,
                    Found::Effect(other) => confounds(number, other),
                };
                table.neighbours += usize::from(claimed.first().is_some_and(near));
                table.laws += usize::from(claimed.contains(&Found::Law));
                table.equivalents += usize::from(outcome.equivalent);
                &mut table.open_set
            }
        };
        counter.0 += 1;
        counter.1 += usize::from(right);
        if !right {
            table.wrong.push((case.key.clone(), claimed));
        }
    }
    table.rows = rows.into_values().collect();
    table
}

fn count(row: &mut Row, outcome: &Outcome) {
    let right = outcome.names(row.hypothesis);
    row.detectable = match (row.detectable, outcome.detectable) {
        (Some(a), Some(b)) => Some(f64::min(a, b)),
        (known, None) | (None, known) => known,
    };
    let first = outcome.claims.first();
    if let Some(claim) = first
        && claim.hypothesis == Some(row.hypothesis)
        && outcome.size != 0.0
    {
        row.ratios.push(claim.size / outcome.size);
    }
    if !outcome.is_visible() {
        row.hidden += 1;
        row.hidden_right += usize::from(right);
        row.hidden_wrong += usize::from(!right && first.is_some());
        return;
    }
    row.visible += 1;
    row.right += usize::from(right);
    let alone = |claim: &Claim| {
        let mut others = claim.alternatives.iter();
        let repeats = others.all(|(_, relation)| *relation == Relation::Repeats);
        claim.hypothesis == Some(row.hypothesis) && repeats
    };
    row.alone += usize::from(first.is_some_and(alone));
    row.extras += outcome.claims.len().saturating_sub(1);
    if !right {
        *row.taken_for.entry(Found::of(first)).or_default() += 1;
    }
}
