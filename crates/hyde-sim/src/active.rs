//! [`is_active`]: which relations matter where the run is.

use crate::state::State;

/// Whether a relation matters in the current modes, and is neither held at its zero nor followed.
pub(crate) fn is_active(state: &State<'_>, relation: usize) -> bool {
    let used = state.program.relations[relation].used;
    let matters = used.matters(|automaton, mode| state.in_mode(automaton, mode));
    matters && !state.is_loose(relation) && !state.slides.iter().any(|slide| slide.holds(relation))
}
