//! [`Replay`]: a variable whose equation a recorded column takes the place of.

use crate::instance::InstanceId;
use hyde_ir::{ExprId, VarId};
use hyde_syntax::ast::Drive;

/// `replay x = column;` with the variable that it is about.
#[derive(Clone, Copy)]
pub(crate) struct Replay<'a> {
    pub(super) drive: &'a Drive,
    pub(super) var: VarId,
    pub(super) root: InstanceId,
    pub(super) used: bool,
    /// What the variable is without its effects: what its column is recorded of.
    pub(super) value: Option<ExprId>,
    /// What has taken its place.
    pub(super) recorded: Option<ExprId>,
}
