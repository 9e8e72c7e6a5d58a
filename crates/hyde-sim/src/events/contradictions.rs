//! Reactions that fire at one instant and give a variable different values.

use super::Instant;
use crate::results::{Contradiction, MOST_CONTRADICTIONS};
use hyde_program::ReactionKind;

impl Instant<'_, '_> {
    /// Notes where reactions that fire together give a variable different values, and where two `when` give it one: the second
    /// does not add to what the first one does.
    pub(super) fn note_contradictions(&mut self, fired: &[usize], values: &[f64]) {
        if fired.len() < 2 {
            return;
        }
        let program = self.state.program;
        let mut given: Vec<(usize, usize)> = Vec::new();
        for &number in fired {
            for index in program.reactions[number].assignments.clone() {
                let target = program.assignments[index].target;
                let when =
                    |by: usize| matches!(program.reactions[by].kind, ReactionKind::When { .. });
                let mut before = given.iter();
                let other = before.find(|(other, by)| {
                    *by != number
                        && program.assignments[*other].target == target
                        && (when(*by) && when(number)
                            || values[*other].to_bits() != values[index].to_bits())
                });
                if let Some(&(other, by)) = other
                    && self.contradictions.len() < MOST_CONTRADICTIONS
                {
                    self.contradictions.push(Contradiction {
                        t: self.now.t,
                        causes: [by, number].map(|by| program.reactions[by].text.clone()),
                        values: [values[other], values[index]],
                    });
                }
                given.push((index, number));
            }
        }
    }
}
