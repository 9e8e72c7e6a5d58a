//! What happens at events: relations, automata, reactions, pins, clocks and held values.

use hyde_diag::Origin;
use hyde_ir::dae::{Firmness, Target};

/// What a relation is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelationUse {
    /// Its truth stands in equations: an event whenever it changes.
    Equation,
    /// It stands in an exit of a mode (automaton, mode): watched while the mode is on.
    Exit(usize, usize),
    /// It stands in a `when` condition.
    When,
    /// It stands in an `assert`.
    Assert,
}

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

/// The modes of a `modes` block.
#[derive(Clone, Debug)]
pub struct Automaton {
    /// Its full name.
    pub name: String,
    /// The names of its modes.
    pub modes: Vec<String>,
    /// Whether each mode relates speeds alone, as `w = 0` does: what it is between cannot slide.
    pub holds_speed: Vec<bool>,
    /// Position of the number of its mode in the memory.
    pub place: usize,
    /// Where it is written.
    pub origin: Origin,
}

/// One thing an event sets; its value is of the same number in [`crate::Function::Assignments`].
#[derive(Clone, Debug)]
pub struct Assignment {
    /// Where.
    pub target: Target,
    /// Where it is written.
    pub origin: Origin,
}

/// What happens when a condition becomes true.
#[derive(Clone, Debug)]
pub enum ReactionKind {
    /// An exit of a mode.
    Transition {
        /// The automaton.
        automaton: usize,
        /// The mode left.
        from: usize,
        /// The mode entered.
        to: usize,
        /// A jump of the state that the new mode fixes is meant.
        impact: bool,
    },
    /// A branch of a `when` clause; of the branches of one clause the first that becomes true reacts.
    When {
        /// Number of the clause.
        clause: usize,
    },
    /// The position in the memory that is 1 in the round of the iteration in which the condition became true.
    Edge(usize),
    /// A condition that must never hold: the message of an `assert`.
    Assert(String),
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

/// `hold(source)`: copied after the tick and the clock's delay.
#[derive(Clone, Debug)]
pub struct Hold {
    /// The clock of the source.
    pub clock: usize,
    /// Position of the source in the memory.
    pub source: usize,
    /// Position of the held value in the memory.
    pub target: usize,
    /// Number of values.
    pub len: usize,
    /// Whether the continuous equations read it: a change of it is an event (C3).
    pub read: bool,
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
