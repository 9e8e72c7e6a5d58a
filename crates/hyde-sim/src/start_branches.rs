//! The branches of equations with switches at the start, where the guessed one has no solution.
//!
//! ```text
//! abs(z)*z + z = -2        z >= 0 is the guess, and z^2 + z = -2 has no solution; -z^2 + z = -2 has z = -1
//! ```
//! What a relation is before anything is solved is a guess. Other truths are tried from the start values, first all that
//! differ in one relation, then in two, and so on, until a solution agrees with its own truths.

use crate::active::is_active;
use crate::consistent::Consistent;
use crate::events::branches::{next_choice, relations_in_loops};
use crate::moment::Moment;
use crate::state::State;
use crate::zero;
use hyde_program::{Function, RelationUse};

/// Solutions tried at most: a start that has none is to be reported soon.
const MAX_TRIED: usize = 200;

/// Goes to the nearest branch that agrees with itself, from the start values; whether there is one.
pub(crate) fn other_branch(
    state: &mut State<'_>,
    consistent: &mut Consistent,
    (now, start): (&mut Moment, &Moment),
) -> bool {
    let before = (state.z.clone(), now.clone());
    let free = relations_in_loops(state, &before.0);
    let mut tried = 0;
    for count in 1..=free.len() {
        let mut chosen: Vec<usize> = (0..count).collect();
        loop {
            state.z.clone_from(&before.0);
            now.clone_from(start);
            for &number in &chosen {
                state.z[free[number]] = 1.0 - state.z[free[number]];
            }
            if consistent.solve(state, now, true).is_ok() && agrees(state, now) {
                return true;
            }
            tried += 1;
            if tried == MAX_TRIED || !next_choice(&mut chosen, free.len()) {
                break;
            }
        }
        if tried == MAX_TRIED {
            break;
        }
    }
    (state.z, *now) = before;
    false
}

/// Whether the relations of equations are what the values say.
fn agrees(state: &mut State<'_>, now: &Moment) -> bool {
    let roots = state.values(Function::Roots, now.at());
    let relations = state.program.relations.iter().enumerate();
    let mut of_equations = relations.filter(|(number, relation)| {
        relation.used == RelationUse::Equation && is_active(state, *number)
    });
    of_equations.all(|(number, _)| !zero::contradicts(roots[number], state.z[number] != 0.0))
}
