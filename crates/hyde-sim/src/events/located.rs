//! Instants that were located: how near to zero root functions count as at it.

use super::{Instant, Known};
use crate::root_rates::{RootRate, root_rates};
use crate::zero::{self, located_s, moved, reach_s};
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
    pub(super) fn all_but_zero(&mut self, guards: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let rates = self.rates_of(guards);
        let reach_s = reach_s(self.now.t);
        let near = |&(guard, _): &(usize, f64)| (guard, 0.5 * reach_s * rates[guard].mean.abs());
        guards.iter().map(near).collect()
    }

    /// The guards in a circle that nothing but noise leads in, with how far from zero each may be until its sign counts
    /// again: at rest, as of a friction without a force, all of them stay beneath the tolerance for long. `None` where one of
    /// them does not. The mode is left as it is then, for no result shows the difference.
    pub(super) fn at_rest(&mut self, guards: &[(usize, f64)]) -> Option<Vec<(usize, f64)>> {
        let beneath = zero::beneath(self.state, self.now.at());
        let rates = self.rates_of(guards);
        let stays = |&(guard, root): &(usize, f64)| {
            root.abs() + self.long_s * rates[guard].mean.abs() <= beneath[guard]
        };
        let bands = guards.iter().map(|&(guard, _)| (guard, beneath[guard]));
        guards.iter().all(stays).then(|| bands.collect())
    }

    fn rates_of(&mut self, guards: &[(usize, f64)]) -> Vec<RootRate> {
        let numbers: Vec<usize> = guards.iter().map(|(guard, _)| *guard).collect();
        root_rates(self.state, self.consistent, self.now.at(), &numbers)
    }
}
