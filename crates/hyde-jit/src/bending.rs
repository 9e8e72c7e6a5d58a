//! Which equations bend: all others are linear as long as modes and relations stay, so they hold all along a linear flow.

use crate::routine::{Leaf, Routine, Slot};
use hyde_ir::dae::{Dae, Function, Wrt};
use hyde_ir::{Expr, ExprId, Index, Range, VarId};
use std::collections::{BTreeSet, HashMap};

/// Rows of the residual that bend, rising: a derivative by an unknown or its rate is another elsewhere, or with another value
/// that events assign; or what is outside is read, which is time, record columns and delayed values.
pub(crate) fn bending_rows(dae: &Dae) -> Vec<usize> {
    let mut found = BTreeSet::new();
    let mut add = |range: Range, row: Index| {
        let rows = range.iter().map(|counter| usize::try_from(row.at(counter)));
        found.extend(rows.filter_map(Result::ok));
    };
    let values = Values::new(dae);
    for partial in dae.partials(Function::Residual) {
        let by_outside = matches!(partial.wrt, Wrt::Time | Wrt::Delayed(_));
        if by_outside || values.reads(partial.value).anything {
            add(partial.range, partial.row);
        }
    }
    for (range, row, value) in hyde_analysis::rows(dae, Function::Residual) {
        if values.reads(value).outside {
            add(range, row);
        }
    }
    found.into_iter().collect()
}

/// What a value reads, itself and through definitions. Modes and truths of relations are no values of the memory.
#[derive(Clone, Copy, Default)]
struct Reads {
    /// Time, record columns or delayed values.
    outside: bool,
    /// That, unknowns, their rates or the memory.
    anything: bool,
}

/// Definitions with what they read, each from those before it.
struct Values<'a> {
    dae: &'a Dae,
    routine: Routine,
    definitions: HashMap<VarId, Reads>,
}

impl<'a> Values<'a> {
    fn new(dae: &'a Dae) -> Self {
        let mut values = Self {
            dae,
            routine: Routine::plain("bending", Vec::new()),
            definitions: HashMap::new(),
        };
        for definition in &dae.definitions {
            let reads = values.reads(definition.value);
            let all = values.definitions.entry(definition.var).or_default();
            all.outside |= reads.outside;
            all.anything |= reads.anything;
        }
        values
    }

    fn reads(&self, value: ExprId) -> Reads {
        let mut found = Reads::default();
        for id in self.dae.exprs.below(&[value]) {
            let expr = self.dae.exprs[id];
            if let Expr::Var(var, _) = expr
                && let Some(reads) = self.definitions.get(&var)
            {
                found.outside |= reads.outside;
                found.anything |= reads.anything;
            }
            match self.routine.leaf(self.dae, expr) {
                Some(Leaf::Time) => found.outside = true,
                Some(Leaf::Load(slot, _)) if !matches!(expr, Expr::Relation(_)) => {
                    found.outside |= slot == Slot::Input;
                    found.anything |=
                        matches!(slot, Slot::Unknown | Slot::Derivative | Slot::Memory);
                }
                Some(Leaf::Load(..) | Leaf::Number(_) | Leaf::Counter | Leaf::IsMode(..))
                | None => {}
            }
        }
        found.anything |= found.outside;
        found
    }
}
