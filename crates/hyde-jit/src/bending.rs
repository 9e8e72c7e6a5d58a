//! Which equations bend: all others are linear as long as modes and relations stay, so they hold all along a linear flow.

use crate::routine::{Leaf, Routine, Slot};
use hyde_ir::dae::{Dae, Function, Wrt};
use hyde_ir::{Expr, Index, Range};
use std::collections::BTreeSet;

/// Rows of the residual that bend, rising: a derivative by an unknown or its rate is another elsewhere, or with another value
/// that events assign; or what is outside is read, which is time, record columns and delayed values.
pub(crate) fn bending_rows(dae: &Dae) -> Vec<usize> {
    let mut found = BTreeSet::new();
    let mut add = |range: Range, row: Index| {
        let rows = range.iter().map(|counter| usize::try_from(row.at(counter)));
        found.extend(rows.filter_map(Result::ok));
    };
    let outside = [Slot::Input];
    let anything = [Slot::Input, Slot::Unknown, Slot::Derivative, Slot::Memory];
    for partial in dae.partials(Function::Residual) {
        let by_outside = matches!(partial.wrt, Wrt::Time | Wrt::Delayed(_));
        let own = Routine::alone(dae, partial.range, partial.value);
        if by_outside || reads(dae, &own, &anything) {
            add(partial.range, partial.row);
        }
    }
    for (range, row, value) in hyde_analysis::rows(dae, Function::Residual) {
        if reads(dae, &Routine::alone(dae, range, value), &outside) {
            add(range, row);
        }
    }
    found.into_iter().collect()
}

/// Whether a routine reads time, or what lies in some slots; modes and truths of relations are no values of the memory.
fn reads(dae: &Dae, routine: &Routine, slots: &[Slot]) -> bool {
    let roots: Vec<_> = routine.steps.iter().map(|step| step.value).collect();
    dae.exprs.below(&roots).into_iter().any(|id| {
        let expr = dae.exprs[id];
        match routine.leaf(dae, expr) {
            Some(Leaf::Time) => true,
            Some(Leaf::Load(slot, _)) => {
                !matches!(expr, Expr::Relation(_)) && slots.contains(&slot)
            }
            Some(Leaf::Number(_) | Leaf::Counter | Leaf::IsMode(..)) | None => false,
        }
    })
}
