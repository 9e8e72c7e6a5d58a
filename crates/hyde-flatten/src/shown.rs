//! The quantity that a name is shown in.

use hyde_ir::{Expr, ExprId, FlatModel, Quantity};

/// What a mere name means and is shown in: that of a variable or a parameter.
pub(crate) fn quantity_of(flat: &FlatModel, id: ExprId) -> Option<&Quantity> {
    if let Expr::Var(var, _) = flat.exprs[id] {
        return Some(&flat.variables[var].quantity);
    }
    if let Expr::Param(param, _) = flat.exprs[id] {
        return Some(&flat.parameters[param].quantity);
    }
    None
}
