//! [`Exchange`]: each effect but the last once more against its rivals, beside what was taken in after it.
//!
//! The first effect is chosen while all others are missing: a law with one more shape bends a little towards what came
//! later, and a rival that had been behind may be the right one (exchange after forward selection; Miller, Subset
//! Selection in Regression, 2nd ed. 2002, section 3.6).

use super::apart::Alternative;
use super::contest::{Contest, contest};
use super::hypothesis::{Build, Hypothesis};
use super::prune::without;
use super::scan::Score;
use super::search::{Gates, Round};
use super::stage::{Ground, Stage};
use crate::plant::Unsupported;

/// A rival gained this part of what the effect did when it was taken in.
const RIVAL: f64 = 0.8;
/// Rivals at most, the effect itself among them.
const MOST: usize = 4;

/// An effect that was taken in.
#[derive(Clone)]
pub(crate) struct Taken {
    /// The number of the round.
    pub(crate) round: usize,
    /// What the records cannot tell from it.
    pub(crate) alternatives: Vec<Alternative>,
}

/// What an exchange needs to know of the search.
pub(crate) struct Exchange<'s> {
    pub(crate) ground: &'s Ground<'s>,
    pub(crate) hypotheses: &'s [Hypothesis],
    pub(crate) build: &'s Build<'s>,
    pub(crate) gates: Gates,
    pub(crate) rounds: &'s [Round],
}

impl Exchange<'_> {
    /// Exchanges effects of a stage, with what is known of them; whether any was.
    pub(crate) fn exchange(
        &self,
        stage: &mut Stage,
        taken: &mut Vec<Taken>,
    ) -> Result<bool, Unsupported> {
        let earlier = stage.effects.len().saturating_sub(1);
        let effects: Vec<usize> = stage.effects.iter().map(|(effect, _)| *effect).collect();
        let mut exchanged = false;
        for effect in effects.into_iter().take(earlier) {
            let place = |(own, _): &(usize, String)| *own == effect;
            let Some(number) = stage.effects.iter().position(place) else {
                continue;
            };
            let rivals = self.rivals(effect, taken[number].round, stage);
            if rivals.len() < 2 {
                continue;
            }
            let Some(less) = without(self.ground, stage, number, self.build) else {
                continue;
            };
            let Contest { trials, accepted } = contest(
                self.ground,
                &less,
                self.hypotheses,
                rivals,
                self.build,
                self.gates,
            );
            let fine = |own: usize| trials.iter().any(|trial| trial.hypothesis == own);
            let Some((best, alternatives)) = accepted.filter(|_| fine(effect)) else {
                continue;
            };
            let round = taken[number].round;
            if trials[best].hypothesis == effect {
                taken[number].alternatives = alternatives;
            } else {
                *stage = trials[best].stage.polished(self.ground)?;
                taken.remove(number);
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
        let has = |hypothesis: usize| stage.effects.iter().any(|(own, _)| *own == hypothesis);
        let near = |score: &&Score| {
            !has(score.hypothesis) && gain(score.hypothesis).is_some_and(|gain| gain >= least)
        };
        let own = round
            .scores
            .iter()
            .filter(|score| score.hypothesis == effect);
        own.chain(round.scores.iter().filter(near).take(MOST - 1))
            .collect()
    }
}
