//! [`Calls`]: the calls of functions that are being replaced, and what is known of earlier ones.

use crate::dimension::Dim;
use crate::instance::{FieldPlace, InstanceId, Setting, Typed};
use crate::turns::Turns;
use crate::zero::Zero;
use hyde_diag::Span;
use hyde_ir::ExprId;
use hyde_syntax::ast::Class;
use std::collections::HashMap;

/// The calls of functions that are being replaced, and what is known of earlier ones.
#[derive(Default)]
pub(crate) struct Calls<'a> {
    /// The functions, the outermost first.
    pub(super) within: Vec<&'a Class>,
    /// How many the outermost call has led to.
    pub(super) count: usize,
    /// Values of earlier calls.
    pub(super) known: HashMap<Called, Vec<(Call, Typed)>>,
}

/// The function that is called (the place of its name), from which instance, with which arguments.
pub(super) type Called = (Span, InstanceId, Vec<ExprId>);

/// What counts of an argument: dimension, truth, bare number, turns, zero point.
pub(super) type Argued = (Dim, bool, bool, Turns, Zero);

/// What beside its arguments' expressions the value of a call depends on.
#[derive(Clone, PartialEq)]
pub(super) struct Call {
    pub(super) setting: Setting,
    pub(super) place: FieldPlace,
    pub(super) records: bool,
    /// Of each argument dimension, truth, whether it is bare, its turns and its zero point; none that is not given.
    pub(super) arguments: Vec<Option<Argued>>,
}
