//! Constraints between states, of which the run chooses some to be states.

use crate::id::VarId;
use hyde_diag::Origin;

/// Variables of one order that constraints tie to each other: as many as there are no constraints for are states, and
/// the run chooses which (dummy derivatives).
///
/// A variable that a constraint gives for the whole run is [`Dependent`].
#[derive(Clone, Debug)]
pub struct Selection {
    /// Positions of the variables in the solver's vector.
    pub candidates: Vec<usize>,
    /// Rows of the constraints.
    pub constraints: Vec<usize>,
    /// What the author's choice does to each variable: its column of the constraints' Jacobian is multiplied by it before
    /// the run picks columns, so that 0 keeps it a state and a large factor does not.
    pub weights: Vec<f64>,
    /// Position of the factors in the memory: for each state a row with a one at the variable chosen.
    pub factors: usize,
}

/// A variable with a derivative that is no state, for an equation gives it by states.
#[derive(Clone, Debug)]
pub struct Dependent {
    /// The variable.
    pub var: VarId,
    /// Its element; 0 of a scalar, the first of a whole array.
    pub element: usize,
    /// Number of its elements that are given so.
    pub len: usize,
    /// The equation that gives it.
    pub origin: Origin,
}

/// A [`Selection`] in names.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The variables chosen from.
    pub candidates: Vec<String>,
    /// How many of them are states.
    pub states: usize,
    /// Where the constraints are written.
    pub constraints: Vec<Origin>,
}
