//! Relations whose truth is frozen between events.

use crate::id::{AutomatonId, ExprId};
use hyde_diag::Origin;

/// What a relation is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelationUse {
    /// Its frozen truth stands in equations: an event whenever it changes.
    Equation,
    /// It stands in an exit of that mode: watched while the mode is on.
    Exit(AutomatonId, u32),
    /// It stands in a `when` condition.
    When,
    /// It stands in an `assert`.
    Assert,
}

/// A relation: true where its root function is positive (or not negative, if inclusive).
#[derive(Clone, Debug)]
pub struct Relation {
    /// Root function `g`.
    pub root: ExprId,
    /// Whether `g = 0` counts as true where the flow does not decide (M2).
    pub inclusive: bool,
    /// `g = sign*time - s`: the instant is `s*sign`, scheduled and never searched for.
    pub time_event: Option<ExprId>,
    /// What it is for.
    pub used: RelationUse,
    /// As written.
    pub text: String,
    /// Where it is written.
    pub origin: Origin,
}
