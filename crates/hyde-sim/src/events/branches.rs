//! The branches of equations with switches: which truths their relations can have together at an instant.
//!
//! ```text
//! u = in + 0.1*y;  y = clamp(1e4*u, -15, 15)        at in = -1.5 y is -15 or 15; at in > -1.5 it is 15 and no other
//! ```
//! Rounds of events turn the relations that the solution contradicts. At a fold, as where this trigger tips, they go in a
//! circle: the branch that they come from has no solution behind it, and the one beyond the limit leads back. Then the other
//! truths are tried from where the instant began, first all that differ in one relation from those there, then in two, and
//! so on, until a solution agrees with its own truths. So nothing that need not tip does.

use super::Instant;
use crate::active::is_active;
use crate::failure::Failure;
use crate::moment::Moment;
use crate::state::State;
use hyde_program::{Function, RelationUse, Wrt};

/// Solutions tried at most.
const MAX_TRIED: usize = 4000;

/// Values of rounds are the same to this, relative, and a thousandth of it absolute.
const SAME: f64 = 1e-12;

/// Where the relations of equations began to settle, and what they were since.
pub(super) struct Branches {
    z: Vec<f64>,
    values: Moment,
    seen: Vec<Seen>,
}

/// A round: the memory, and the consistent values.
struct Seen {
    z: Vec<u64>,
    values: Moment,
}

/// What became of a round.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    /// Consistent values.
    Values,
    /// The same as all the way round the circle: the truths that change do not matter here, as the sign of a root that is 0,
    /// and are followed from here on.
    Indifferent,
}

impl Branches {
    /// None of them seen yet.
    pub(super) fn from(instant: &Instant<'_, '_>) -> Self {
        Self {
            z: instant.state.z.clone(),
            values: instant.now.clone(),
            seen: Vec::new(),
        }
    }

    /// The rounds since the memory was as it is; none if it never was.
    fn circle(&self, z: &[f64]) -> &[Seen] {
        let same = |seen: &Seen| seen.z.iter().zip(z).all(|(a, b)| *a == b.to_bits());
        let first = self.seen.iter().position(same);
        first.map_or(&[], |first| &self.seen[first..])
    }
}

impl Instant<'_, '_> {
    /// Consistent values with the relations as they are now; if there are none, or these relations were tried before, those
    /// of the nearest branch that agrees with itself. `branches` know the rounds before.
    pub(super) fn solve_or_tip(
        &mut self,
        branches: &mut Branches,
        scheduled: &[usize],
        located: &[(usize, f64)],
        at_start: bool,
    ) -> Result<Found, Box<Failure>> {
        let circle = branches.circle(&self.state.z);
        let in_circle = !circle.is_empty();
        if in_circle {
            if self.tip(branches, scheduled, located, at_start) {
                return Ok(Found::Values);
            }
            if circle.iter().all(|seen| self.is_same(seen)) {
                let turned = turned_in(circle, self.state.program.relations.len());
                let at = self.now.at();
                self.state.follow(&turned, at);
                return Ok(Found::Indifferent);
            }
        }
        let before = self.now.clone();
        let solved = self.consistent.solve(self.state, self.now, at_start);
        if let Err(failure) = solved
            && (in_circle || !self.tip(branches, scheduled, located, at_start))
        {
            *self.now = before;
            return Err(failure);
        }
        branches.seen.push(Seen {
            z: self.state.z.iter().map(|value| value.to_bits()).collect(),
            values: self.now.clone(),
        });
        Ok(Found::Values)
    }

    /// Whether the values are those of a round before, but for rounding.
    fn is_same(&self, seen: &Seen) -> bool {
        let now = self.now.y.iter().chain(self.now.yp.iter());
        let before = seen.values.y.iter().chain(&seen.values.yp);
        now.zip(before)
            .all(|(a, b)| (a - b).abs() <= SAME * (1e-3 + a.abs().max(b.abs())))
    }

    /// Goes to the nearest branch that agrees with itself; whether there is one.
    fn tip(
        &mut self,
        branches: &Branches,
        scheduled: &[usize],
        located: &[(usize, f64)],
        at_start: bool,
    ) -> bool {
        let before = (self.state.z.clone(), self.now.clone());
        let free = relations_in_loops(self.state, &branches.z);
        let mut tried = 0;
        for count in 0..=free.len() {
            let mut chosen: Vec<usize> = (0..count).collect();
            loop {
                if tried == MAX_TRIED {
                    (self.state.z, *self.now) = before;
                    return false;
                }
                tried += 1;
                self.state.z.clone_from(&branches.z);
                self.now.clone_from(&branches.values);
                for &number in &chosen {
                    let relation = free[number];
                    self.state.z[relation] = 1.0 - self.state.z[relation];
                }
                if self.agrees(scheduled, located, at_start) {
                    return true;
                }
                if !next_choice(&mut chosen, free.len()) {
                    break;
                }
            }
        }
        (self.state.z, *self.now) = before;
        false
    }

    /// Whether the solution with the relations as they are has these very truths.
    fn agrees(&mut self, scheduled: &[usize], located: &[(usize, f64)], at_start: bool) -> bool {
        let solved = self.consistent.solve(self.state, self.now, at_start);
        if solved.is_err() {
            return false;
        }
        let Ok(known) = self.truths(scheduled, located) else {
            return false;
        };
        let relations = self.state.program.relations.iter().enumerate();
        let mut of_equations = relations.filter(|(number, relation)| {
            relation.used == RelationUse::Equation && is_active(self.state, *number)
        });
        of_equations.all(|(number, _)| known.truths[number] == (self.state.z[number] != 0.0))
    }
}

/// The relations of equations that read what consistent values determine. Those that changed since `before` come first.
pub(crate) fn relations_in_loops(state: &State<'_>, before: &[f64]) -> Vec<usize> {
    let program = state.program;
    let mut reads = vec![false; program.relations.len()];
    for entry in program.partials(Function::Roots) {
        reads[entry.row] |= match entry.wrt {
            Wrt::Unknown(column) => !state.differential[column],
            Wrt::Derivative(_) => true,
            Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => false,
        };
    }
    let mut found: Vec<usize> = (0..reads.len())
        .filter(|&number| {
            let relation = &program.relations[number];
            reads[number]
                && relation.used == RelationUse::Equation
                && !relation.scheduled
                && is_active(state, number)
        })
        .collect();
    found.sort_by_key(|&number| state.z[number].to_bits() == before[number].to_bits());
    found
}

/// The relations that are not the same all the way round.
fn turned_in(circle: &[Seen], n_relations: usize) -> Vec<usize> {
    let differs = |number: &usize| {
        circle
            .iter()
            .any(|seen| seen.z[*number] != circle[0].z[*number])
    };
    (0..n_relations).filter(differs).collect()
}

/// The next choice of as many numbers below `n`, ascending in itself; whether there is one.
pub(crate) fn next_choice(chosen: &mut [usize], n: usize) -> bool {
    let count = chosen.len();
    for place in (0..count).rev() {
        if chosen[place] < n - (count - place) {
            chosen[place] += 1;
            for later in place + 1..count {
                chosen[later] = chosen[later - 1] + 1;
            }
            return true;
        }
    }
    false
}
