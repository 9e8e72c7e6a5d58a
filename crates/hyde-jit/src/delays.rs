//! The delayed quantities of a program: how late, whether equations read them, and whether they change at events alone.

use hyde_ir::dae::Dae;
use hyde_ir::flat;
use hyde_ir::{Expr, ExprId, VariableKind};
use hyde_program::Delay;

/// The delays of a DAE, one an element.
pub(crate) fn delays(dae: &Dae) -> Vec<Delay> {
    let below = dae.exprs.below(&dae.equation_values());
    let reads = |delay: &flat::Delay| {
        let of = |id: &ExprId| matches!(dae.exprs[*id], Expr::Var(var, _) if var == delay.var);
        below.iter().any(of)
    };
    let each = dae.delays.iter().flat_map(|delay| {
        let (read, held) = (reads(delay), is_held(dae, delay.value));
        delay.range.iter().map(move |_| Delay {
            time_s: delay.time_s,
            read,
            held,
            origin: delay.origin.clone(),
        })
    });
    each.collect()
}

/// Whether an expression changes at events alone.
fn is_held(dae: &Dae, value: ExprId) -> bool {
    let below = dae.exprs.below(&[value]);
    below.into_iter().all(|id| match dae.exprs[id] {
        Expr::Time | Expr::Der(..) | Expr::NoEvent(_) => false,
        Expr::Var(var, _) => match dae.variables[var].kind {
            VariableKind::Discrete | VariableKind::Clocked(_) | VariableKind::Held(..) => true,
            VariableKind::Continuous => {
                let own = dae.definitions.iter().filter(|own| own.var == var);
                let mut values = own.map(|own| own.value).peekable();
                values.peek().is_some() && values.all(|value| is_held(dae, value))
            }
            VariableKind::Column(..) | VariableKind::Delayed(_) | VariableKind::Reduction(_) => {
                false
            }
        },
        Expr::Const(_)
        | Expr::Counter
        | Expr::Param(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::InMode(..)
        | Expr::Unary(..)
        | Expr::Binary(..)
        | Expr::If(..) => true,
    })
}
