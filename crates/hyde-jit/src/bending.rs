//! Which equations bend: all others are linear as long as modes and relations stay, so they hold all along a linear flow.

use hyde_ir::dae::{Dae, Function, Space, Wrt};
use hyde_ir::{Expr, ExprId, Index, Range};
use std::collections::BTreeSet;

/// Rows of the residual that bend, rising: a derivative by an unknown or its rate is another elsewhere, or with another value
/// that events assign; or what is outside is read, which is time, record columns and delayed values.
pub(crate) fn bending_rows(dae: &Dae) -> Vec<usize> {
    let mut found = BTreeSet::new();
    let mut add = |range: Range, row: Index| {
        let rows = range.iter().map(|counter| usize::try_from(row.at(counter)));
        found.extend(rows.filter_map(Result::ok));
    };
    for partial in dae.partials(Function::Residual) {
        let outside = matches!(partial.wrt, Wrt::Time | Wrt::Delayed(_));
        if outside || reads(dae, partial.value, |space| space != Space::Parameter) {
            add(partial.range, partial.row);
        }
    }
    for (range, row, value) in hyde_analysis::rows(dae, Function::Residual) {
        if reads(dae, value, |space| space == Space::Input) {
            add(range, row);
        }
    }
    found.into_iter().collect()
}

/// Whether an expression reads time, or a variable of some spaces, through explicit variables too.
fn reads(dae: &Dae, root: ExprId, wanted: impl Fn(Space) -> bool) -> bool {
    let (mut pending, mut known) = (vec![root], BTreeSet::new());
    while let Some(root) = pending.pop() {
        for id in dae.exprs.below(&[root]) {
            let var = match dae.exprs[id] {
                Expr::Time => return true,
                Expr::Var(var, _) | Expr::Der(var, _) | Expr::Pre(var, _) => var,
                Expr::Const(_)
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Relation(_)
                | Expr::InMode(..)
                | Expr::Unary(..)
                | Expr::Binary(..)
                | Expr::If(..)
                | Expr::NoEvent(_) => continue,
            };
            match dae.place(var).map(|place| place.space) {
                Some(Space::Work) if known.insert(var) => {
                    let own = dae.definitions.iter().filter(|d| d.var == var);
                    pending.extend(own.map(|definition| definition.value));
                }
                Some(Space::Work) => {}
                Some(space) if wanted(space) => return true,
                Some(_) | None => {}
            }
        }
    }
    false
}
