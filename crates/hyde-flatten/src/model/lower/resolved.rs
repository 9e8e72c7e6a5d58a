//! [`Resolved`]: what a name stands for.

use crate::instance::{Counter, InstanceId, Typed};
use hyde_ir::{Index, ParamId, VarId};

/// What a name stands for.
pub(crate) enum Resolved {
    /// A variable; the element, if one is named.
    Variable(VarId, Option<Index>),
    /// A parameter; the element, if one is named.
    Parameter(ParamId, Option<Index>),
    Instance(InstanceId),
    Counter(Counter),
    Time,
    Pi,
    /// The coordinate of the domain the field expression is on.
    Coordinate,
    /// An input or variable of a function, or a measure.
    Value(Typed),
}
