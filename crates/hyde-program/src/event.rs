//! What happens at events: relations, reactions, pins, clocks and delayed quantities.

use hyde_diag::Origin;
use hyde_ir::dae::{Firmness, ReactionKind, RelationUse, Target};

/// A relation: true where its root function is positive.
#[derive(Clone, Debug)]
pub struct Relation {
    /// Counts as true where the root function is zero and stays zero (M2).
    pub inclusive: bool,
    /// Its instant is known beforehand ([`crate::Constant::TimeEvent`]) and scheduled.
    pub scheduled: bool,
    /// Its root function is sums, products, magnitudes and limits of unknowns: between two steps it turns no more often than
    /// they do.
    pub arithmetic: bool,
    /// What it is for.
    pub used: RelationUse,
    /// As written.
    pub text: String,
    /// Where it is written.
    pub origin: Origin,
}

/// One thing an event sets; its value is of the same number in [`crate::Function::Assignments`].
#[derive(Clone, Debug)]
pub struct Assignment {
    /// Where.
    pub target: Target,
    /// Whether a condition of an exit or of a `when` reads it, and its value is made of what events set, as a count is: it may be
    /// another one in each round of an instant.
    pub counts: bool,
    /// Where it is written.
    pub origin: Origin,
}

/// A condition and what it sets in motion.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// What happens.
    pub kind: ReactionKind,
    /// Its assignments.
    pub assignments: std::ops::Range<usize>,
    /// The condition as written.
    pub text: String,
    /// Where it is written.
    pub origin: Origin,
}

/// A mode that fixes a state (M3). Values follow the assignments in [`crate::Function::Assignments`].
#[derive(Clone, Debug)]
pub struct Pin {
    /// The automaton.
    pub automaton: usize,
    /// The mode.
    pub mode: usize,
    /// The state, by its position in the solver's vector.
    pub state: usize,
    /// Where it is written.
    pub origin: Origin,
}

/// A clocked part; its times are [`crate::Constant`]s.
#[derive(Clone, Debug)]
pub struct Clock {
    /// Its full name.
    pub name: String,
    /// Where it is written.
    pub origin: Origin,
}

/// A quantity as it was earlier: its value now is of the same number in [`crate::Function::Delayed`].
#[derive(Clone, Debug)]
pub struct Delay {
    /// By how much, in s, above 0: as declared; in the observed form parameters decide it
    /// ([`crate::Constant::Lateness`]).
    pub time_s: f64,
    /// Whether the continuous equations read it: a jump that arrives is an event.
    pub read: bool,
    /// Whether what is delayed changes at events alone: it is made of what is held, of discrete variables and of parameters.
    pub held: bool,
    /// Where it is written.
    pub origin: Origin,
}

/// A condition at the start, for one or more states.
#[derive(Clone, Debug)]
pub enum InitialCondition {
    /// States keep their start values, unless initial equations determine them.
    Fixed {
        /// Position of the first.
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
    /// Equations: as many values of [`crate::Function::Initial`].
    Equation {
        /// Number of them.
        len: usize,
        /// Where they are written.
        origin: Origin,
    },
    /// A start value that the other conditions have to meet: two values of [`crate::Function::Initial`], what the variable
    /// is and what it is to be, behind those of all equations.
    Check {
        /// The variable's name.
        name: String,
        /// Where it is declared.
        origin: Origin,
    },
}
