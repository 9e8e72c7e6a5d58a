//! The functions of a DAE and their derivatives.

use crate::id::ExprId;
use crate::{Index, Range};

/// With respect to what a function is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Wrt {
    /// An unknown: element at a value of the counter, in the solver's vector.
    Unknown(Index),
    /// The derivative of an unknown.
    Derivative(Index),
    /// A parameter: its position at a value of the counter.
    Parameter(Index),
    /// A value in the memory: its position at a value of the counter.
    Memory(Index),
    /// A delayed value: its number at a value of the counter.
    Delayed(Index),
    /// Time.
    Time,
}

/// Derivatives of a range of rows of a function.
#[derive(Clone, Debug)]
pub struct Partial {
    /// Values of the counter.
    pub range: Range,
    /// Row at a value of the counter.
    pub row: Index,
    /// With respect to what.
    pub wrt: Wrt,
    /// The derivative.
    pub value: ExprId,
}

/// The functions of a program that have derivatives (S2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function {
    /// `F`, one value an unknown.
    Residual,
    /// Root functions, one a relation.
    Roots,
    /// What events assign, then the values of the pins.
    Assignments,
    /// Reported quantities.
    Outputs,
    /// Conditions at the start that are equations.
    Initial,
    /// What is delayed, as it is now.
    Delayed,
    /// Arguments of the sines in root functions, which tell how many times these may turn in a step. They have no derivatives.
    Angles,
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Residual,
        Self::Roots,
        Self::Assignments,
        Self::Outputs,
        Self::Initial,
        Self::Delayed,
        Self::Angles,
    ];
}
