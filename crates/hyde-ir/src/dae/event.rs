//! What happens at events: automata, reactions, assignments, and states that modes fix.

use crate::id::{AutomatonId, ExprId};
use hyde_diag::Origin;

/// The modes of an automaton.
#[derive(Clone, Debug)]
pub struct Automaton {
    /// Its full name.
    pub name: String,
    /// The names of its modes.
    pub modes: Vec<String>,
    /// Whether each mode relates speeds alone, as `w = 0` does: what it is between cannot slide.
    pub holds_speed: Vec<bool>,
    /// Number of the first mode.
    pub initial: usize,
    /// Position of its mode in the memory.
    pub place: usize,
    /// Where it is written.
    pub origin: Origin,
}

/// Where an event writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A state, by its position in the solver's vector.
    State(usize),
    /// A position in the memory.
    Memory(usize),
}

impl Target {
    /// Writes a value to the solver's vector or to the memory.
    pub fn set(self, value: f64, y: &mut [f64], memory: &mut [f64]) {
        match self {
            Self::State(position) => y[position] = value,
            Self::Memory(position) => memory[position] = value,
        }
    }
}

/// One thing an event sets.
#[derive(Clone, Debug)]
pub struct Assignment {
    /// Where.
    pub target: Target,
    /// To what, from the values before the event.
    pub value: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// What happens when a condition becomes true.
#[derive(Clone, Debug)]
pub enum ReactionKind {
    /// An exit of a mode.
    Transition {
        /// Number of the automaton.
        automaton: usize,
        /// Number of the mode left.
        from: usize,
        /// Number of the mode entered.
        to: usize,
        /// A jump of the state that the new mode fixes is meant.
        impact: bool,
    },
    /// A branch of a `when` clause; of the branches of one clause the first that becomes true reacts.
    When {
        /// Number of the clause.
        clause: usize,
    },
    /// `edge(condition)`: the position in the memory that is 1 in the round of the iteration in which the condition became
    /// true.
    Edge(usize),
    /// A condition that must never hold: the message of an `assert`.
    Assert(String),
}

/// A condition over truths and what it sets in motion.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// The condition.
    pub condition: ExprId,
    /// What happens.
    pub kind: ReactionKind,
    /// Its assignments: a range of [`Dae::assignments`](super::Dae::assignments).
    pub assignments: std::ops::Range<usize>,
    /// As written.
    pub text: String,
    /// Where it is written.
    pub origin: Origin,
}

/// A mode that fixes a state (M3).
#[derive(Clone, Debug)]
pub struct Pin {
    /// The automaton.
    pub automaton: AutomatonId,
    /// Number of the mode.
    pub mode: usize,
    /// Position of the state in the solver's vector.
    pub state: usize,
    /// What it is fixed to.
    pub value: ExprId,
    /// Where it is written.
    pub origin: Origin,
}
