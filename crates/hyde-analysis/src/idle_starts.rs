//! Start values set from outside that nothing reads: of variables that follow from others at every time, a start is not even
//! a guess.
//!
//! ```text
//! Velocity w = 2*v;      --set 'w.start=10 [m/s]'      warned of
//! ```

use crate::refusals::states as refused;
use hyde_diag::Diagnostics;
use hyde_ir::dae::{Dae, InitialCondition};
use hyde_ir::{Expr, ExprId, ParamId};
use std::collections::BTreeMap;

/// Warns of each.
pub(crate) fn warn(dae: &Dae, settings: &BTreeMap<String, f64>, diagnostics: &mut Diagnostics) {
    let conditions = dae.initial.iter().filter_map(|condition| match condition {
        InitialCondition::Equation { value, .. } => Some(*value),
        // What was found in its place is told.
        InitialCondition::Check { start, .. } => Some(*start),
        InitialCondition::Fixed { .. } => None,
    });
    let starts = dae.starts.iter().map(|start| start.value);
    let read: Vec<ExprId> = starts.chain(conditions).collect();
    let reads = |parameter: ParamId, value: ExprId| {
        let is_it = |expr: Expr| matches!(expr, Expr::Param(own, _) if own == parameter);
        dae.exprs.any(value, is_it)
    };
    for name in settings.keys() {
        let Some(variable) = name.strip_suffix(".start") else {
            continue;
        };
        let mut all = dae.parameters.enumerate();
        let Some((id, parameter)) = all.find(|(_, parameter)| parameter.name == *name) else {
            continue;
        };
        if !read.iter().any(|&value| reads(id, value)) {
            let here = parameter.origin.span;
            diagnostics.push(refused::idle_start(name, variable, here));
        }
    }
}
