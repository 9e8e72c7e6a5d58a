//! Equations: residuals of the implicit part, definitions of the explicit one.

use crate::id::{ExprId, UnknownId, VarId};
use crate::{Index, Range};
use hyde_diag::Origin;

/// `0 = value`, for every value of the counter; the rows are those of the unknown it is matched to.
#[derive(Clone, Debug)]
pub struct Residual {
    /// The block of unknowns.
    pub unknown: UnknownId,
    /// Values of the counter.
    pub range: Range,
    /// Row of a value of the counter (stride 1 or -1).
    pub row: Index,
    /// The residual.
    pub value: ExprId,
    /// The equations it is made of: one, or one a mode.
    pub origins: Vec<Origin>,
}

/// `variable[index] = value`: an explicit variable, in terms of `y, y', z, u, p` and earlier definitions.
#[derive(Clone, Debug)]
pub struct Definition {
    /// The variable.
    pub var: VarId,
    /// Values of the counter.
    pub range: Range,
    /// Element of the variable at a value of the counter (stride 1 or -1; a scalar has stride 0).
    pub index: Index,
    /// Its value.
    pub value: ExprId,
    /// Whether it is a derivative of another definition, which only derivatives read.
    pub slope: bool,
    /// The equation it comes from.
    pub origin: Origin,
}
