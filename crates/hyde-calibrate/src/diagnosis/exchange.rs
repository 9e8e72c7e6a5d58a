//! [`Forward::exchange`]: each effect but the last once more against its rivals, beside what was taken in after it.
//!
//! The first effect is chosen while all others are missing: a law with one more shape bends a little towards what came
//! later, and a rival that had been behind may be the right one (exchange after forward selection; Miller, Subset
//! Selection in Regression, 2nd ed. 2002, section 3.6).

use super::contest::Contest;
use super::forward::{Branch, Forward, Taken};
use super::prune::without;
use super::scan::Score;
use super::stage::Stage;
use crate::plant::Unsupported;

/// A rival gained this part of what the effect did when it was taken in.
const RIVAL: f64 = 0.8;
/// Rivals at most, the effect itself among them.
const MOST: usize = 4;

impl Forward<'_> {
    /// Exchanges effects of a branch; whether any was.
    pub(super) fn exchange(&self, branch: &mut Branch) -> Result<bool, Unsupported> {
        let Branch { stage, taken } = branch;
        let earlier = stage.effects.len().saturating_sub(1);
        let mut exchanged = false;
        for effect in stage.numbers().into_iter().take(earlier) {
            let Some(number) = stage.numbers().iter().position(|own| *own == effect) else {
                continue;
            };
            let rivals = self.rivals(effect, taken[number].round, stage);
            if rivals.len() < 2 {
                continue;
            }
            let Some(less) = without(self.ground, stage, number, self.build) else {
                continue;
            };
            let Contest { trials, accepted } = self.contest(&less, rivals, Vec::new());
            let fine = |own: usize| trials.iter().any(|trial| trial.hypothesis == own);
            let Some((best, alternatives)) = accepted.filter(|_| fine(effect)) else {
                continue;
            };
            if trials[best].hypothesis == effect {
                taken[number].alternatives = alternatives;
            } else {
                *stage = trials[best].stage.polished(self.ground)?;
                let Taken { round, .. } = taken.remove(number);
                taken.push(Taken {
                    round,
                    alternatives,
                });
                exchanged = true;
            }
        }
        Ok(exchanged)
    }

    /// Scores of an effect and of those that came near it in its round, without those that the stage has.
    fn rivals(&self, effect: usize, round: usize, stage: &Stage) -> Vec<&Score> {
        let round = &self.rounds[round];
        let gain = |hypothesis: usize| {
            let mut trials = round.trials.iter();
            trials
                .find(|trial| trial.hypothesis == hypothesis)
                .map(|trial| trial.gain)
        };
        let least = RIVAL * gain(effect).unwrap_or(f64::INFINITY);
        let near = |score: &&Score| {
            !stage.has(score.hypothesis) && gain(score.hypothesis).is_some_and(|gain| gain >= least)
        };
        let own = round
            .scores
            .iter()
            .filter(|score| score.hypothesis == effect);
        own.chain(round.scores.iter().filter(near).take(MOST - 1))
            .collect()
    }
}
