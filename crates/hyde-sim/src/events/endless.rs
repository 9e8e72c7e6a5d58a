//! Rounds of events without end: what tells them, and what they are.

use super::Instant;
use crate::failure::{Failure, FailureKind};
use hyde_program::{ReactionKind, Target};

impl Instant<'_, '_> {
    /// Whether a reaction leads to another mode and no more. One that lets a state jump, as an impact does, may come back to
    /// its mode at the same instant: the next ball in the row is struck.
    pub(super) fn only_changes_mode(&self, reaction: usize) -> bool {
        let program = self.state.program;
        let reaction = &program.reactions[reaction];
        let mut targets = program.assignments[reaction.assignments.clone()].iter();
        matches!(reaction.kind, ReactionKind::Transition { .. })
            && !targets.any(|assignment| matches!(assignment.target, Target::State(_)))
    }

    pub(super) fn mode_key(&self) -> Vec<u64> {
        let program = self.state.program;
        program
            .automata
            .iter()
            .map(|automaton| self.state.z[automaton.place].to_bits())
            .collect()
    }

    pub(super) fn chattering(&self, causes: &[String]) -> Box<Failure> {
        let program = self.state.program;
        let mut distinct: Vec<String> = Vec::new();
        for cause in causes.iter().rev() {
            if !distinct.contains(cause) {
                distinct.push(cause.clone());
            }
        }
        distinct.truncate(4);
        let mut failure = Failure::new(FailureKind::Chattering(distinct.clone()), self.t);
        for reaction in program
            .reactions
            .iter()
            .filter(|reaction| distinct.contains(&reaction.text))
        {
            if !failure.origins.contains(&reaction.origin) {
                failure = failure.at_origin(&reaction.origin);
            }
        }
        failure
    }
}
