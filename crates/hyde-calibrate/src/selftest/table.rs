//! [`tally`]: the outcomes of all cases, counted: what was planted against what was found.

use super::case::{Case, Kind};
use super::trial::Outcome;
use crate::diagnosis::{Hypothesis, Verdict};
use std::collections::BTreeMap;

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
    /// What it was taken for where it showed: by hypothesis; `None` for nothing.
    pub taken_for: BTreeMap<Option<usize>, usize>,
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
    /// An effect that the search does not know and that shows: right is to say that something is left, or nothing.
    pub open_set: (usize, usize),
    /// Of these, how often a neighbour was named that effect's own list of confusions has.
    pub neighbours: usize,
    /// A faulty sensor: right is to claim no effect.
    pub sensor: (usize, usize),
    /// Keys of controls that came out wrong, with what was claimed.
    pub wrong: Vec<(String, Vec<usize>)>,
}

/// Counts outcomes. `confounds` says which hypotheses an effect is easily taken for.
#[must_use]
pub fn tally(
    hypotheses: &[Hypothesis],
    outcomes: &[(&Case, Outcome)],
    confounds: &dyn Fn(usize, usize) -> bool,
) -> Table {
    let mut table = Table::default();
    let mut rows: BTreeMap<usize, Row> = BTreeMap::new();
    for (case, outcome) in outcomes {
        let claimed: Vec<usize> = outcome
            .claims
            .iter()
            .map(|claim| claim.hypothesis)
            .collect();
        let (counter, right) = match case.kind {
            Kind::Planted(number, _) => {
                let row = rows.entry(number).or_default();
                row.hypothesis = number;
                count(row, outcome);
                continue;
            }
            Kind::Empty => (&mut table.empty, outcome.verdict == Verdict::None),
            Kind::Parameter(_) => (&mut table.parameter, outcome.verdict == Verdict::None),
            Kind::Sensor(..) => (&mut table.sensor, claimed.is_empty()),
            Kind::OpenSet(number, _) => {
                if !outcome.is_visible() {
                    continue;
                }
                let near = |&other: &usize| {
                    confounds(number, other) || hypotheses[other].site == hypotheses[number].site
                };
                table.neighbours += usize::from(claimed.first().is_some_and(near));
                let right = claimed.is_empty() || outcome.unexplained;
                (&mut table.open_set, right)
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
        && claim.hypothesis == row.hypothesis
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
    row.alone += usize::from(
        first.is_some_and(|c| c.hypothesis == row.hypothesis && c.alternatives.is_empty()),
    );
    row.extras += outcome.claims.len().saturating_sub(1);
    if !right {
        let other = first.map(|claim| claim.hypothesis);
        *row.taken_for.entry(other).or_default() += 1;
    }
}
