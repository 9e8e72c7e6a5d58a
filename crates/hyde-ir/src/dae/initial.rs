//! Start values and initial conditions.

use super::Place;
use crate::id::{ExprId, VarId};
use crate::{Index, Range};
use hyde_diag::Origin;

/// Why a condition is part of the initial system (I3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// `fixed = true` or an `initial equation`.
    Declared,
    /// Taken from the start value of a state because conditions were missing.
    Filled,
}

/// A condition at the start.
#[derive(Clone, Debug)]
pub enum InitialCondition {
    /// States take their start values.
    Fixed {
        /// Position of the first in the solver's vector.
        state: usize,
        /// Number of them.
        len: usize,
        /// Why.
        reason: Reason,
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
