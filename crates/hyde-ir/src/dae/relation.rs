//! Relations whose truth is frozen between events.

use crate::id::ExprId;
use hyde_diag::Origin;

/// What a relation is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelationUse {
    /// Its frozen truth stands in equations: an event whenever it changes.
    Equation,
    /// It stands in an exit of a mode, by the numbers of the automaton and of the mode: watched while the mode is on.
    Exit(usize, usize),
    /// It stands in a `when` condition.
    When,
    /// It stands in an `assert`.
    Assert,
}

impl RelationUse {
    /// Whether the relation is looked at: an exit only while its mode is on. `in_mode` says whether an automaton is in a mode.
    #[must_use]
    pub fn matters(self, in_mode: impl Fn(usize, usize) -> bool) -> bool {
        match self {
            Self::Exit(automaton, mode) => in_mode(automaton, mode),
            Self::Equation | Self::When | Self::Assert => true,
        }
    }
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
