//! Clocked parts: what a tick assigns, and what is held of it.

use crate::id::{ExprId, VarId};
use crate::{Index, Range};
use hyde_diag::Origin;

/// One assignment of a tick.
#[derive(Clone, Debug)]
pub struct ClockedAssignment {
    /// The clocked variable.
    pub var: VarId,
    /// Values of the counter.
    pub range: Range,
    /// Its element at a value of the counter.
    pub index: Index,
    /// Its new value; `Pre` is the value at the last tick.
    pub value: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// A clocked partition, sorted.
#[derive(Clone, Debug)]
pub struct Tick {
    /// Its full name.
    pub name: String,
    /// Period in s, of parameters alone.
    pub period: ExprId,
    /// From the tick to the change of held values, in s.
    pub delay: ExprId,
    /// First tick in s.
    pub phase: ExprId,
    /// In the order of computation.
    pub assignments: Vec<ClockedAssignment>,
    /// Where it is written.
    pub origin: Origin,
}

/// `hold(source)`: copied after the tick and the clock's delay.
#[derive(Clone, Debug)]
pub struct Hold {
    /// Number of the clock of the source.
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
