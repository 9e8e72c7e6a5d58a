//! [`analyze`]: from a [`FlatModel`] to a [`Dae`]: what is the same becomes one, what is explicit leaves the solver's
//! vector, what remains is matched row by row.
//!
//! In order:
//! 0. `regularity`: a model that cannot determine its unknowns is refused, with the smallest sets that conflict;
//! 1. `alias` and `derivatives`, repeated until nothing changes: variables that are equal become one, before and
//!    after differentiation (M5); derivatives of explicit variables become explicit;
//! 2. `reduce`: equations that constrain states to each other are differentiated, and states chosen among the
//!    constrained variables while running; constraints that only their numbers make dependent are refused (`redundant`);
//! 3. `prescribed`: modes that fix what is prescribed let it move;
//!    `relations`: comparisons in continuous equations become relations with root functions;
//! 4. `matching`: every equation is matched to the unknown it determines, array equations as a whole (F3);
//! 5. `explicit`: algebraic variables with an explicit solution become definitions, loops are torn;
//! 6. `layout`: every variable gets its place;
//! 7. `pins`: modes that fix a state exchange rows with the force that holds it (M3);
//! 8. `clocked`: the equations of each clocked part become ordered assignments;
//! 9. `events`: exits, `when` and `assert` become reactions;
//! 10. `initial`: the initial system; starts set from outside that nothing reads are told (idle_starts.rs);
//! 11. `outputs`: what is reported;
//! 12. `partials`: derivatives of every function; through arrays that read the same scalars by arrays of derivatives
//!     (`shapes`); on the way how fast sines of the time turn (`turning`);
//! 13. `hoist`: what depends on parameters alone is computed once a run.

mod alias;
mod cells;
mod clocked;
mod derivatives;
mod events;
mod explicit;
pub mod graph;
mod held_speed;
mod hoist;
mod idle_starts;
mod initial;
mod layout;
mod matching;
mod mode_constraints;
mod outputs;
mod partials;
mod pins;
mod prescribed;
mod reduce;
mod redundant;
mod refusals;
mod regularity;
mod relations;
mod segments;
mod set_model;
mod shapes;
mod sliding;
mod solve;
mod split;
mod state_choices;
mod still;
mod system;
mod turning;
mod unroll;
mod whole_arrays;

pub use outputs::beside_time;
pub use partials::rows;
pub use sliding::sliding_cells;
pub use still::{
    TickWrt, number_slopes, parameter_slopes, start_slopes, still_partials, tick_partials,
};

use hyde_diag::Diagnostics;
use hyde_ir::{Dae, FlatModel};
use std::collections::BTreeMap;

/// Analyses a flat model, of which some parameters are set from outside: whether its equations are redundant is asked of these
/// values, and nothing else reads them.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn analyze(
    flat: FlatModel,
    settings: &BTreeMap<String, f64>,
    diagnostics: &mut Diagnostics,
) -> Option<Dae> {
    let set = set_model::with_values(&flat, settings);
    let is_set = set.is_some();
    if set.is_some_and(|set| is_redundant(set, diagnostics)) {
        return None;
    }
    let mut system = system::System::new(flat);
    if !is_set && regularity::refuse(&system, diagnostics) {
        return None;
    }
    derivatives::simplify(&mut system, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    reduce::reduce(&mut system);
    if !is_set && redundant::refuse(&mut system, diagnostics) {
        return None;
    }
    prescribed::let_move(&mut system, diagnostics);
    relations::extract(&mut system);
    let matched = matching::match_equations(&mut system, diagnostics)?;
    let order = explicit::choose(&mut system, &matched);
    let mut dae = layout::place(&mut system, &matched, &order);
    pins::exchange_rows(&mut dae, &mut system, &matched, &order, diagnostics);
    clocked::sort(&mut dae, &mut system, diagnostics);
    events::react(&mut dae, &mut system, diagnostics);
    state_choices::check(&mut dae, &mut system, diagnostics);
    initial::conditions(&mut dae, &mut system, diagnostics);
    if diagnostics.has_errors() {
        return None;
    }
    idle_starts::warn(&dae, settings, diagnostics);
    outputs::report(&mut dae, &mut system);
    partials::differentiate(&mut dae);
    hoist::hoist(&mut dae);
    Some(dae)
}

/// Reports equations that are redundant, or unknowns that none determines, before and after the index is reduced.
fn is_redundant(flat: FlatModel, diagnostics: &mut Diagnostics) -> bool {
    let mut system = system::System::new(flat);
    if regularity::refuse(&system, diagnostics) {
        return true;
    }
    // What else is wrong is told of the model as it is declared.
    let mut other = Diagnostics::new();
    derivatives::simplify(&mut system, &mut other);
    if other.has_errors() {
        return false;
    }
    reduce::reduce(&mut system);
    redundant::refuse(&mut system, diagnostics)
}
