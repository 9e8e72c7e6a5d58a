//! Constraints between states, of which the run chooses some to be states.

/// Variables of one order that constraints tie to each other: as many as there are no constraints for are states, and
/// the run chooses which (dummy derivatives).
#[derive(Clone, Debug)]
pub struct Selection {
    /// Positions of the variables in the solver's vector.
    pub candidates: Vec<usize>,
    /// Rows of the constraints.
    pub constraints: Vec<usize>,
    /// Position of the factors in the memory: for each state a row with a one at the variable chosen.
    pub factors: usize,
}
