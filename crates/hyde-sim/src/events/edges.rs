//! Edges: that a condition has become true since the round before, for as long as this round of the event iteration lasts.

use super::Instant;
use hyde_program::ReactionKind;

impl Instant<'_, '_> {
    /// The truths of all conditions, where an edge is that its own has become true since the round before.
    pub(crate) fn conditions_with_edges(&mut self, first_at_start: bool) -> Vec<bool> {
        let now = self.state.conditions(self.now.at());
        let became = |number: usize, before: &[bool]| now[number] && !before[number];
        if self.set_edges(|number, before| !first_at_start && became(number, before)) {
            return self.state.conditions(self.now.at());
        }
        now
    }

    /// Sets the truth of every edge from its number among the reactions and the conditions before. Whether there is one.
    pub(crate) fn set_edges(&mut self, truth: impl Fn(usize, &[bool]) -> bool) -> bool {
        let mut any = false;
        for (number, reaction) in self.state.program.reactions.iter().enumerate() {
            if let ReactionKind::Edge(place) = reaction.kind {
                self.state.z[place] = f64::from(u8::from(truth(number, self.conditions)));
                any = true;
            }
        }
        any
    }
}
