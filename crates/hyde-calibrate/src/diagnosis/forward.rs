//! [`Forward`]: from a stage on takes in one effect after the other, drops what is not missed any more, and tries earlier
//! ones anew against their rivals ([`Forward::exchange`]). Where nothing gains alone and something is left, two are tried together ([`super::pair`]).
//!
//! Effects mask each other, so the best of the first round may be one that stands for several. Where its branch ends with
//! something left, that of the runner-up is followed too ([`Forward::followed`]): a beam of two, which costs nothing
//! where the first one explains all there is.

use super::contest::Contest;
use super::edges::{left_at_edges, settled};
use super::evidence::{Gates, explained};
use super::finding::Taken;
use super::hypothesis::{Build, Hypothesis};
use super::pair::pair;
use super::projection::Projection;
use super::prune::prune;
use super::scan::{Scanner, Score};
use super::stage::{Ground, Stage};
use super::trial::Trial;
use crate::observer::Track;
use crate::plant::Unsupported;

/// A round of the search.
pub struct Round {
    /// Scores, the best first.
    pub scores: Vec<Score>,
    /// What was fitted, the best first.
    pub trials: Vec<Trial>,
    /// The gates.
    pub gates: Gates,
}

/// How far a branch of the search has come.
pub(crate) struct Branch {
    pub(crate) stage: Stage,
    /// What is known of its effects, in their order.
    pub(crate) taken: Vec<Taken>,
    /// Nothing more is to be taken in.
    pub(crate) ended: bool,
    /// Scores on the stage, the best first, where it has been scanned before its round.
    scores: Option<Vec<Score>>,
    /// The effects after each step, by number, and their cost.
    been: Vec<(Vec<usize>, f64)>,
}

impl Branch {
    /// One that begins at a stage without effects.
    pub(crate) fn of(stage: Stage) -> Self {
        Self {
            stage,
            taken: Vec::new(),
            ended: false,
            scores: None,
            been: Vec::new(),
        }
    }

    /// Ends where its effects are those that it has had before, and gain less than a gate beyond that: what is dropped again
    /// would be taken in again.
    fn end_in_a_circle(&mut self, gate: f64) {
        let numbers = self.stage.effects.iter().map(|(number, _)| *number);
        let mut numbers: Vec<usize> = numbers.collect();
        numbers.sort_unstable();
        let cost = self.stage.solution.data;
        let mut been = self.been.iter();
        self.ended |= been.any(|(own, known)| *own == numbers && cost > known - gate);
        self.been.push((numbers, cost));
    }
}

/// The search, and what it has met so far.
pub(crate) struct Forward<'s> {
    pub(crate) ground: &'s Ground<'s>,
    pub(crate) hypotheses: &'s [Hypothesis],
    pub(crate) build: &'s Build<'s>,
    pub(crate) max_effects: usize,
    /// Numbers of hypotheses that are not tried.
    pub(crate) barred: &'s [usize],
    pub(crate) gates: Gates,
    /// The model as it is declared, calibrated.
    pub(crate) declared: &'s Stage,
    pub(crate) rounds: Vec<Round>,
}

impl<'s> Forward<'s> {
    /// What scans a stage.
    pub(super) fn scanner<'t>(
        &self,
        stage: &'t Stage,
        tracks: &'t [Track<'t>],
        projection: &'t Projection,
    ) -> Scanner<'t>
    where
        's: 't,
    {
        Scanner {
            ground: self.ground,
            stage,
            tracks,
            projection,
            hypotheses: self.hypotheses,
            build: self.build,
            gate: self.gates.gain(1),
            fitted: 4 * self.ground.thresholds.few,
        }
    }

    /// The end of a branch, or that of its first round's runner-up, if that is better.
    pub(crate) fn followed(&mut self, branch: Branch) -> Result<Branch, Unsupported> {
        let first = self.follow(branch)?;
        if settled(self.declared, &first.stage, self.ground.thresholds) {
            return Ok(first);
        }
        let Some(second) = self.runner_up(&first)? else {
            return Ok(first);
        };
        let second = self.follow(second)?;
        let (a, b) = (&first.stage, &second.stage);
        let gate = self.gates.of_one(&a.solution);
        let gain = b.solution.gain_over(&a.solution);
        let simpler = b.varied.len() < a.varied.len();
        Ok(if gain >= gate || (gain >= -gate && simpler) {
            second
        } else {
            first
        })
    }

    /// The branch of the hypothesis that came next to the first one taken in, if it is not on that branch as well.
    fn runner_up(&self, first: &Branch) -> Result<Option<Branch>, Unsupported> {
        let has = |trial: &Trial| first.stage.has(trial.hypothesis);
        let Some(taken) = first.taken.first() else {
            return Ok(None);
        };
        let trials = &self.rounds[taken.round].trials;
        let best = trials.iter().filter(|trial| has(trial));
        let best = best.map(|trial| trial.gain).fold(0.0, f64::max);
        let least = self.ground.thresholds.rival * best;
        let fine = |trial: &&Trial| trial.passed() && trial.gain >= least && !has(trial);
        let next = trials.iter().filter(fine);
        let Some(next) = next.max_by(|a, b| a.gain.total_cmp(&b.gain)) else {
            return Ok(None);
        };
        let mut branch = Branch::of(next.stage.polished(self.ground)?);
        let gate = self.gates.of_one(&branch.stage.solution);
        branch.taken.push(Taken {
            round: taken.round,
            alternatives: Vec::new(),
        });
        branch.end_in_a_circle(gate);
        Ok(Some(branch))
    }

    /// Follows a branch to its end.
    fn follow(&mut self, mut branch: Branch) -> Result<Branch, Unsupported> {
        // An effect that is dropped again makes room for another: so many rounds more at most.
        let most = self.rounds.len() + self.max_effects + self.ground.thresholds.retries;
        while !branch.ended && self.rounds.len() < most {
            self.step(&mut branch)?;
        }
        if explained(&branch.stage.solution, self.ground.thresholds)
            && self.exchange(&mut branch)?
        {
            self.prune(&mut branch);
        }
        Ok(branch)
    }

    /// The numbers of all hypotheses that are tried.
    fn all(&self) -> Vec<usize> {
        let all = 0..self.hypotheses.len();
        all.filter(|number| !self.barred.contains(number)).collect()
    }

    /// The gates of what is added to a stage.
    pub(super) fn gates_on(&self, stage: &Stage) -> Gates {
        Gates {
            left: left_at_edges(self.declared, stage, self.ground.thresholds),
            ..self.gates
        }
    }

    /// Scores of some hypotheses, the best first; what was tried for them counts.
    pub(super) fn scored(&mut self, scanner: &Scanner<'_>, hypotheses: &[usize]) -> Vec<Score> {
        let scores = scanner.scores(hypotheses);
        self.gates.tried += scores.iter().map(|score| score.tried).sum::<usize>();
        scores
    }

    /// What the best effect promises on the stage of a branch; the round to come has the scores then.
    pub(crate) fn promise(&mut self, branch: &mut Branch) -> Result<f64, Unsupported> {
        if branch.ended || branch.stage.effects.len() >= self.max_effects {
            return Ok(0.0);
        }
        let scores = self.scores_on(&branch.stage, &self.all())?;
        let best = scores.first().map_or(0.0, Score::gain);
        branch.scores = Some(scores);
        Ok(best)
    }

    /// A round on a branch, if there is room, and what follows from it.
    pub(crate) fn step(&mut self, branch: &mut Branch) -> Result<(), Unsupported> {
        if branch.stage.effects.len() < self.max_effects {
            self.round(branch)?;
        } else {
            branch.ended = true;
        }
        if !branch.ended {
            self.settle(branch)?;
        }
        Ok(())
    }

    /// Drops what is not missed beside what a round took in. What stands on a wrong effect, or one with a wrong shape, is
    /// not built upon.
    pub(crate) fn settle(&mut self, branch: &mut Branch) -> Result<(), Unsupported> {
        self.prune(branch);
        if !explained(&branch.stage.solution, self.ground.thresholds) && self.exchange(branch)? {
            self.prune(branch);
        }
        branch.end_in_a_circle(self.gates.of_one(&branch.stage.solution));
        Ok(())
    }

    /// Drops effects of a branch that are not missed any more.
    fn prune(&self, branch: &mut Branch) {
        for number in prune(self.ground, &mut branch.stage, self.build, self.gates) {
            branch.taken.remove(number);
        }
    }

    /// Fits what scores best on a stage. Effects that are alike where each is large score alike, whichever is there: where
    /// the best leaves something, as many more that score nearly as much are fitted beside it.
    fn fitted(&self, stage: &Stage, scores: &[Score]) -> Contest {
        let thresholds = self.ground.thresholds;
        let most = 2 * thresholds.few;
        let best = scores.first().map_or(0.0, Score::gain);
        let with = |least: f64| scores.iter().take_while(move |score| score.gain() >= least);
        let gate = self.gates.gain(1);
        let survivors = with(gate).take(most).collect();
        let first = self.contest(stage, survivors, Vec::new());
        let solution = |best: usize| &first.trials[best].stage.solution;
        let accepted = first.accepted.as_ref();
        let left = accepted.is_some_and(|(best, _)| !explained(solution(*best), thresholds));
        let more: Vec<&Score> = with(gate.max(thresholds.contender * best))
            .skip(most)
            .take(most)
            .collect();
        if left && !more.is_empty() {
            self.contest(stage, more, first.trials)
        } else {
            first
        }
    }

    /// A round on a branch, which ends where it takes in nothing. What follows from that is left ([`Self::settle`]).
    pub(crate) fn round(&mut self, branch: &mut Branch) -> Result<(), Unsupported> {
        let stage = &branch.stage;
        let tracks = stage.tracks(self.ground)?;
        let projection = Projection::of(stage, &tracks, self.ground)?;
        let projection = projection.ok_or_else(Unsupported::singular)?;
        let scanner = self.scanner(stage, &tracks, &projection);
        let known = branch.scores.take();
        let scores = known.unwrap_or_else(|| self.scored(&scanner, &self.all()));
        let gates = self.gates_on(stage);
        let Contest { trials, accepted } = self.fitted(stage, &scores);
        // The stage with what is taken in, and what the records cannot tell from each of that.
        let next = match accepted {
            Some((best, alternatives)) => {
                let next = trials[best].stage.polished(self.ground)?;
                Some((next, vec![alternatives]))
            }
            None if !explained(&stage.solution, self.ground.thresholds)
                && stage.effects.len() + 2 <= self.max_effects =>
            {
                pair(&scanner, &scores, gates).map(|next| (next, vec![Vec::new(); 2]))
            }
            None => None,
        };
        // They borrow the stage, which the next one replaces.
        drop(tracks);
        let round = self.rounds.len();
        self.rounds.push(Round {
            scores,
            trials,
            gates,
        });
        let Some((next, each)) = next else {
            branch.ended = true;
            return Ok(());
        };
        branch.stage = next;
        branch
            .taken
            .extend(each.into_iter().map(|alternatives| Taken {
                round,
                alternatives,
            }));
        Ok(())
    }
}
