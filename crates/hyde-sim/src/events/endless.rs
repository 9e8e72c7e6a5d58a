//! Rounds of events without end: what tells them, and what they are.

use super::Instant;
use crate::failed_equation::with_values;
use crate::failure::{Failure, FailureKind};
use crate::root_rates::root_rates;
use hyde_program::{ReactionKind, RelationUse, Target};

impl Instant<'_, '_> {
    /// Whether a reaction leads to another mode and no more. One that lets a state jump, as an impact does, or counts what a
    /// condition reads, may come back to its mode at the same instant: the next ball in the row is struck.
    pub(super) fn only_changes_mode(&self, reaction: usize) -> bool {
        let program = self.state.program;
        let reaction = &program.reactions[reaction];
        let mut targets = program.assignments[reaction.assignments.clone()].iter();
        matches!(reaction.kind, ReactionKind::Transition { .. })
            && !targets.any(|assignment| {
                assignment.counts || matches!(assignment.target, Target::State(_))
            })
    }

    /// Whether a `when` clause lets a state jump.
    pub(super) fn strikes(&self, reaction: usize) -> bool {
        let program = self.state.program;
        let reaction = &program.reactions[reaction];
        let mut targets = program.assignments[reaction.assignments.clone()].iter();
        matches!(reaction.kind, ReactionKind::When { .. })
            && targets.any(|assignment| matches!(assignment.target, Target::State(_)))
    }

    /// The located condition of a stroke that stays true, for what is struck does not leave its zero or is back within the
    /// moment that instants can be told apart by. So would it be after every stroke that follows.
    pub(super) fn comes_back_at_once(&mut self, truths: &[bool], roots: &[f64]) -> Option<usize> {
        let relations = &self.state.program.relations;
        let of_strokes = self.crossed.iter().copied().filter(|&relation| {
            let known = relations.get(relation);
            known.is_some_and(|known| known.used == RelationUse::When) && truths[relation]
        });
        let located: Vec<usize> = of_strokes.collect();
        if located.is_empty() {
            return None;
        }
        let at = self.now.at();
        let rates = root_rates(self.state, self.consistent, at, &located);
        let mut located = located.into_iter();
        located.find(|&relation| rates[relation].returns_before(roots[relation]))
    }

    /// The strokes that follow take no time, and the condition, true all the while, would not become true any more.
    pub(super) fn struck_without_end(&mut self, condition: &str) -> Box<Failure> {
        let kind = FailureKind::Zeno {
            cause: condition.to_owned(),
            sum_s: self.now.t,
        };
        let failure = Failure::new(kind, self.now.t);
        let mut relations = self.state.program.relations.iter();
        let failure = match relations.find(|relation| relation.text == condition) {
            Some(relation) => failure.at_origin(&relation.origin),
            None => failure,
        };
        let at = self.now.at();
        with_values(failure, self.state, at, condition)
    }

    /// Rounds that do not end: strokes of one condition alone, or conditions that make each other true.
    pub(super) fn without_end(&mut self, causes: &[String], struck: bool) -> Box<Failure> {
        match causes.first() {
            Some(cause) if struck && causes.iter().all(|other| other == cause) => {
                self.struck_without_end(cause)
            }
            Some(_) | None => self.chattering(causes),
        }
    }

    pub(super) fn mode_key(&self) -> Vec<u64> {
        let program = self.state.program;
        program
            .automata
            .iter()
            .map(|automaton| self.state.z[automaton.place].to_bits())
            .collect()
    }

    pub(super) fn chattering(&mut self, causes: &[String]) -> Box<Failure> {
        let program = self.state.program;
        let mut distinct: Vec<String> = Vec::new();
        for cause in causes.iter().rev() {
            if !distinct.contains(cause) {
                distinct.push(cause.clone());
            }
        }
        distinct.truncate(4);
        let mut failure = Failure::new(FailureKind::Chattering(distinct.clone()), self.now.t);
        for reaction in program
            .reactions
            .iter()
            .filter(|reaction| distinct.contains(&reaction.text))
        {
            if !failure.origins.contains(&reaction.origin) {
                failure = failure.at_origin(&reaction.origin);
            }
        }
        let at = self.now.at();
        for condition in &distinct {
            failure = with_values(failure, self.state, at, condition);
        }
        failure
    }
}
