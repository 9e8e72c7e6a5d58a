//! Refuses models whose equations cannot determine their unknowns, before anything is eliminated: the smallest sets that
//! conflict, in the words of the model.
//!
//! ```text
//! a.phi = 2*b.phi;  c.phi = 2*d.phi;  a, c joined;  b, d joined      the four angle equations depend on each other,
//!                                                                    and two torques can be moved against each other
//! ```
//! Equations that depend on each other are rows of a [`pencil`] that combine to zero; unknowns that nothing determines are
//! columns that do. Both are found by exact elimination, so that equal ratios are told from nearly equal ones. What only an
//! instant or a mode makes singular is found by the run.

mod closed;
mod conflict;
mod elimination;
mod exact;
mod jam;
mod pencil;
mod residue;
mod shortened;
mod words;

use crate::system::System;
pub(crate) use closed::held_once_more;
pub(crate) use elimination::{Row, combinations};
use hyde_diag::Diagnostics;
pub(crate) use residue::Residue;
pub(crate) use words::noun;

/// Reports what makes the model singular; whether anything does.
pub(crate) fn refuse(system: &System, diagnostics: &mut Diagnostics) -> bool {
    let Some(pencil) = pencil::pencil(system) else {
        return false;
    };
    let dependent = elimination::dependent_sets(&pencil.rows);
    let square = pencil.rows.len() == pencil.columns.len();
    let open = match square && dependent.is_empty() {
        true => Vec::new(),
        false => elimination::dependent_columns(&pencil.rows, pencil.columns.len()),
    };
    if dependent.is_empty() && open.is_empty() {
        return jam::refuse(system, diagnostics);
    }
    conflict::report(system, &pencil, &dependent, &open, diagnostics);
    true
}
