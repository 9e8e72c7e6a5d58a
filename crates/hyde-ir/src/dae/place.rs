//! Where the value of a variable lies, or what it equals.

use crate::id::{ExprId, VarId};

/// Where values lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Space {
    /// The solver's vector: states and implicit algebraic variables.
    Unknown,
    /// What changes only at events: truths of relations, modes, discrete, clocked and held variables.
    Memory,
    /// Columns of records at the current time.
    Input,
    /// Explicit variables, computed from the others.
    Work,
    /// Parameters, then what is derived from them alone.
    Parameter,
}

/// A variable's first element within a space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The space.
    pub space: Space,
    /// Position of element 0.
    pub base: usize,
}

/// What a variable that was eliminated stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alias {
    /// An element of another variable, negated or not.
    Of {
        /// The variable kept.
        var: VarId,
        /// Its element.
        element: usize,
        /// Whether the sign differs.
        negated: bool,
    },
    /// An expression of parameters alone.
    Value(ExprId),
}

/// A block of the solver's vector: consecutive elements of one variable with one residual each.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// The variable.
    pub var: VarId,
    /// Its first element in this block.
    pub first: usize,
    /// Number of elements.
    pub len: usize,
    /// Position of the first element in the vector; its residual is the row of the same number.
    pub offset: usize,
    /// A state: its derivative appears.
    pub differential: bool,
}
