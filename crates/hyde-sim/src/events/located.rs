//! Instants that were located: how near to zero root functions count as at it.

use super::{Instant, Known};
use crate::root_rates::root_rates;
use crate::zero::{located_s, moved, reach_s};
use hyde_program::RelationUse;

impl Instant<'_, '_> {
    /// Takes down where guards of states became true, if that is their zero as far as the instant can be known.
    pub(super) fn remember_located(&mut self, guards: &[(usize, f64)]) {
        for &(guard, root) in guards {
            self.state.located.retain(|(other, _)| *other != guard);
            if self.state.is_of_states(guard) {
                let rate = self.state.height_rate(guard, self.now.at());
                if root.abs() <= moved(rate, self.now.t) {
                    self.state.located.push((guard, root));
                }
            }
        }
    }

    /// The crossed relations of reactions whose truth is as before: consistent values may fall short of a zero by rounding
    /// that the step to it did not show. As far as the instant can be known they are at it.
    pub(super) fn short_of_zero(&mut self, found: &Known) -> Vec<(usize, f64)> {
        let stay = self.crossed_in_vain(&found.truths);
        if stay.is_empty() {
            return Vec::new();
        }
        let at = self.now.at();
        let rates = root_rates(self.state, self.consistent, at, &stay);
        let known = 0.5 * located_s(self.now.t);
        let within = |relation: usize| (relation, known * rates[relation].mean.abs());
        stay.into_iter().map(within).collect()
    }

    /// The crossed relations of reactions whose truth is as before.
    pub(super) fn crossed_in_vain(&self, truths: &[bool]) -> Vec<usize> {
        let state = &self.state;
        // Those of equations wait for the values of the branch they lead to: one of a loop may lead them all back.
        let stays = |relation: &usize| {
            let known = state.program.relations.get(*relation);
            let of_reaction = known.is_some_and(|r| r.used != RelationUse::Equation);
            of_reaction && truths[*relation] == (state.z[*relation] != 0.0)
        };
        self.crossed.iter().copied().filter(stays).collect()
    }

    /// Guards that lead in a circle may do so by rounding alone: a diode's current is zero where its voltage is. Those that
    /// cross zero within a moment of now count by the direction in which they do.
    pub(super) fn all_but_zero(&mut self, guards: &[usize]) -> Vec<(usize, f64)> {
        let at = self.now.at();
        let rates = root_rates(self.state, self.consistent, at, guards);
        let reach_s = reach_s(self.now.t);
        guards
            .iter()
            .map(|&guard| (guard, 0.5 * reach_s * rates[guard].mean.abs()))
            .collect()
    }
}
