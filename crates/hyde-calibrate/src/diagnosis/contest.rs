//! [`Forward::contest`]: hypotheses fitted beside each other, judged, and the one that is taken in.

use super::apart::{Alternative, alternative};
use super::evidence::Gates;
use super::forward::Forward;
use super::scan::Score;
use super::stage::{Ground, Stage};
use super::trial::{Begun, Rejection, Trial, begin, finish, unseen};
use crate::fit::{Goal, Solution};
use rayon::prelude::*;

/// How a contest ended.
pub(crate) struct Contest {
    /// What was fitted, the best first.
    pub(crate) trials: Vec<Trial>,
    /// The number of the trial to take in, and what the records cannot tell from it.
    pub(crate) accepted: Option<(usize, Vec<Alternative>)>,
}

impl Forward<'_> {
    /// Fits some hypotheses on a stage, from the nodes of their scores, beside those of an earlier contest on it.
    pub(super) fn contest(
        &self,
        stage: &Stage,
        scores: Vec<&Score>,
        earlier: Vec<Trial>,
    ) -> Contest {
        let Self {
            ground,
            hypotheses,
            build,
            ..
        } = *self;
        let gates = self.gates_on(stage);
        let begun: Vec<Begun<'_>> = scores
            .into_par_iter()
            .filter_map(|score| begin(ground, stage, hypotheses, score, build, true))
            .collect();
        let solutions = begun.iter().map(|begun| (begun.gain, begun.solution()));
        let known = earlier
            .iter()
            .map(|trial| (trial.gain, &trial.stage.solution));
        let ahead = ahead(solutions.chain(known));
        let goal = ahead.map(|ahead| goal(stage, ahead, gates));
        let least = ahead.map_or(0.0, |(gain, _)| ground.thresholds.contender * gain);
        let mut trials = earlier;
        trials.par_extend(begun.into_par_iter().filter_map(|begun| {
            let worth = begun.gain >= least;
            finish(ground, stage, hypotheses, begun, worth, goal)
        }));
        refine(ground, stage, &mut trials, gates);
        judge(ground, stage, &mut trials, gates);
        let rank = |trial: &Trial| {
            (
                trial.rejected.is_none(),
                trial.fold_gain.unwrap_or(trial.gain),
            )
        };
        trials.sort_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            b.0.cmp(&a.0).then(b.1.total_cmp(&a.1))
        });
        let taken = choice(&trials, gates);
        let accepted = taken.map(|(best, others)| {
            let pair = |other: usize| (&trials[best], &trials[other]);
            let other = |other: usize| alternative(ground, hypotheses, pair(other), gates);
            (best, others.into_iter().map(other).collect())
        });
        Contest { trials, accepted }
    }
}

/// The best of some solutions, each with its gain.
fn ahead<'t>(solutions: impl Iterator<Item = (f64, &'t Solution)>) -> Option<(f64, &'t Solution)> {
    solutions.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// What a solution is to gain over a stage to come within a gate of the best.
fn goal<'s>(stage: &'s Stage, (gain, best): (f64, &Solution), gates: Gates) -> Goal<'s> {
    Goal {
        over: &stage.solution,
        gain: gain - gates.of_one(best),
    }
}

/// Fits to the end those that gain nearly as much as the best, if it is not alone: the same effect one shaft further gains
/// all but a few units of it, and tangents leave as many.
fn refine(ground: &Ground<'_>, stage: &Stage, trials: &mut [Trial], gates: Gates) {
    let fine = |trial: &Trial| trial.rejected.is_none();
    let solutions = trials.iter().filter(|trial| fine(trial));
    let ahead = ahead(solutions.map(|trial| (trial.gain, &trial.stage.solution)));
    let Some(ahead) = ahead else {
        return;
    };
    let (goal, least) = (goal(stage, ahead, gates), ground.thresholds.rival * ahead.0);
    let contends = |trial: &Trial| fine(trial) && trial.gain >= least;
    if trials.iter().filter(|trial| contends(trial)).count() < 2 {
        return;
    }
    let contenders = trials.par_iter_mut().filter(|trial| contends(trial));
    contenders.for_each(|trial| trial.refine(ground, stage, goal));
}

/// Puts the gates to the trials, the best first; halves are fitted only of those that pass the others and come near the
/// best that passes.
fn judge(ground: &Ground<'_>, stage: &Stage, trials: &mut [Trial], gates: Gates) {
    trials.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    let mut plain: Option<f64> = None;
    let mut passed: Option<f64> = None;
    for trial in trials {
        let gate = trial.gate(gates);
        let behind = passed.is_some_and(|best| trial.gain < best - gate);
        trial.rejected = trial
            .rejected
            .or((trial.score < gate).then_some(Rejection::Score))
            .or((trial.gain < gate || !trial.is_told()).then_some(Rejection::Gain))
            .or(behind.then_some(Rejection::Behind));
        if trial.rejected.is_some() {
            continue;
        }
        if trial.fold_gain.is_some() {
            passed = Some(passed.unwrap_or(trial.gain));
            continue;
        }
        plain = plain.or_else(|| unseen(ground, stage));
        let (Some(before), Some(after)) = (plain, unseen(ground, &trial.stage)) else {
            trial.rejected = Some(Rejection::Folds);
            continue;
        };
        let gained = before - after;
        trial.fold_gain = Some(gained);
        if gained < gates.unseen(trial.freedoms, trial.inflation) {
            trial.rejected = Some(Rejection::Folds);
        } else {
            passed = Some(passed.unwrap_or(trial.gain));
        }
    }
}

/// The trial to take in, and those that cannot be told from it. Of these one without a shape on its bound, and of those the
/// one with the fewest sizes and shapes.
fn choice(trials: &[Trial], gates: Gates) -> Option<(usize, Vec<usize>)> {
    let passed: Vec<usize> = (0..trials.len())
        .filter(|&t| trials[t].rejected.is_none())
        .collect();
    let gained = |t: usize| trials[t].fold_gain.unwrap_or(0.0);
    let best = passed
        .iter()
        .copied()
        .max_by(|&a, &b| gained(a).total_cmp(&gained(b)))?;
    let within = trials[best].gate(gates);
    let close = |&t: &usize| {
        gained(t) >= gained(best) - within && trials[t].gain >= trials[best].gain - within
    };
    let alike: Vec<usize> = passed.into_iter().filter(close).collect();
    let simplest = alike.iter().copied().min_by(|&a, &b| {
        let measure = |t: usize| (trials[t].limited, trials[t].freedoms);
        measure(a)
            .cmp(&measure(b))
            .then(gained(b).total_cmp(&gained(a)))
    })?;
    let others = alike.into_iter().filter(|&t| t != simplest).collect();
    Some((simplest, others))
}
