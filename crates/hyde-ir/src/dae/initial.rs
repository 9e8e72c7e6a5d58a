//! Start values and initial conditions.

use super::Place;
use crate::id::{ExprId, VarId};
use crate::{Index, Range};
use hyde_diag::Origin;

/// How firmly a state holds its start value. Where initial equations determine states, the loosest yield first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Firmness {
    /// `fixed = false` is said.
    Free,
    /// Nothing is said.
    Open,
    /// `start` is said: a guess.
    Guess,
    /// Declared fixed by a part, for every use of it.
    Default,
    /// Declared fixed for this model: it never yields.
    Given,
}

/// A condition at the start.
#[derive(Clone, Debug)]
pub enum InitialCondition {
    /// States take their start values, unless initial equations determine them.
    Fixed {
        /// Position of the first in the solver's vector.
        state: usize,
        /// Number of them.
        len: usize,
        /// How firmly.
        firmness: Firmness,
        /// By the names that equations read, an initial equation determines it.
        yields: bool,
        /// Where its start is declared.
        origin: Origin,
    },
    /// `0 = value`.
    Equation {
        /// Values of the counter.
        range: Range,
        /// The residual.
        value: ExprId,
        /// Where it is written.
        origin: Origin,
    },
    /// Nothing to solve: a variable that other conditions determine, and the start value that its author gave it. Behind
    /// all equations.
    Check {
        /// The variable as named.
        var: VarId,
        /// Its value.
        value: ExprId,
        /// Its start value, of parameters alone.
        start: ExprId,
    },
}

/// Start value of the elements of a place.
#[derive(Clone, Debug)]
pub struct Start {
    /// Where.
    pub place: Place,
    /// Values of the counter.
    pub range: Range,
    /// Element at a value of the counter.
    pub index: Index,
    /// Of parameters alone.
    pub value: ExprId,
}
