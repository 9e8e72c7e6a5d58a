//! [`Forward::exchange`]: each effect but the last once more against its rivals, beside what was taken in after it.
//!
//! The first effect is chosen while all others are missing: a law with one more shape bends a little towards what came
//! later, and a rival that had been behind may be the right one (exchange after forward selection; Miller, Subset
//! Selection in Regression, 2nd ed. 2002, section 3.6). A period that was led away has minima between it and the right
//! one, which no fit crosses: effect and rivals are scanned anew where the others are.

use super::contest::Contest;
use super::evidence::explained;
use super::finding::Taken;
use super::forward::{Branch, Forward};
use super::projection::Projection;
use super::prune::without;
use super::scan::Score;
use super::stage::Stage;
use crate::plant::Unsupported;

impl Forward<'_> {
    /// Exchanges effects of a branch, or their shapes; whether any was.
    pub(super) fn exchange(&mut self, branch: &mut Branch) -> Result<bool, Unsupported> {
        let Branch { stage, taken, .. } = branch;
        let earlier = stage.effects.len().saturating_sub(1);
        let mut exchanged = false;
        for effect in stage.numbers().into_iter().take(earlier) {
            let Some(number) = stage.numbers().iter().position(|own| *own == effect) else {
                continue;
            };
            let rivals = self.rivals(effect, taken[number].round, stage);
            let left = !explained(&stage.solution, self.ground.thresholds);
            if rivals.len() < 2 && !left {
                continue;
            }
            let Some(less) = without(self.ground, stage, number, self.build) else {
                continue;
            };
            let scores = self.scores_on(&less, &rivals)?;
            let Contest { trials, accepted } =
                self.contest(&less, scores.iter().collect(), Vec::new());
            let fine = |own: usize| trials.iter().any(|trial| trial.hypothesis == own);
            let Some((best, alternatives)) = accepted.filter(|_| fine(effect)) else {
                continue;
            };
            let gate = self.gates.of_one(&stage.solution);
            let gain = trials[best].stage.solution.gain_over(&stage.solution);
            let same = trials[best].hypothesis == effect;
            if same && gain < gate {
                taken[number].alternatives = alternatives;
            } else if gain > -gate {
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

    /// Scores of some hypotheses on a stage, the best first.
    pub(super) fn scores_on(
        &mut self,
        stage: &Stage,
        hypotheses: &[usize],
    ) -> Result<Vec<Score>, Unsupported> {
        let tracks = stage.tracks(self.ground)?;
        let projection = Projection::of(stage, &tracks, self.ground)?;
        let projection = projection.ok_or_else(Unsupported::singular)?;
        let scanner = self.scanner(stage, &tracks, &projection);
        Ok(self.scored(&scanner, hypotheses))
    }

    /// An effect and those that came near it in its round, without those that the stage has.
    fn rivals(&self, effect: usize, round: usize, stage: &Stage) -> Vec<usize> {
        let trials = &self.rounds[round].trials;
        let own = trials.iter().find(|trial| trial.hypothesis == effect);
        let thresholds = self.ground.thresholds;
        let part = match explained(&stage.solution, thresholds) {
            true => thresholds.rival,
            false => thresholds.contender,
        };
        let least = part * own.map_or(f64::INFINITY, |trial| trial.gain);
        let mut near: Vec<_> = trials
            .iter()
            .filter(|trial| !stage.has(trial.hypothesis) && trial.gain >= least)
            .collect();
        near.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        let near = near.into_iter().map(|trial| trial.hypothesis);
        std::iter::once(effect)
            .chain(near.take(thresholds.few))
            .collect()
    }
}
