//! Which modes hold a speed: `w = 0`, `a.v = b.v`. A linearised model leaves them, for the axis that it is of moves.

use hyde_ir::flat::Mode;
use hyde_ir::{Expr, ExprArena, IdVec, VarId, Variable, VariableKind};
use hyde_units::Dimension;

/// Whether a mode has an equation between speeds alone. What changes at events only, parameters and the time may stand in it.
pub(crate) fn holds_speed(
    arena: &ExprArena,
    variables: &IdVec<VarId, Variable>,
    mode: &Mode,
) -> bool {
    mode.equations.iter().any(|equation| {
        let mut speeds = arena
            .below(&[equation.lhs, equation.rhs])
            .into_iter()
            .filter_map(|id| is_speed(variables, arena[id]));
        let first = speeds.next();
        first == Some(true) && speeds.all(|speed| speed)
    })
}

/// Whether a variable or a derivative is a speed or an angular speed; `None` of all else.
fn is_speed(variables: &IdVec<VarId, Variable>, expr: Expr) -> Option<bool> {
    let (var, _, derivative) = expr.access()?;
    let variable = &variables[var];
    if matches!(
        variable.kind,
        VariableKind::Discrete | VariableKind::Held(..)
    ) {
        return None;
    }
    let dimension = variable.quantity.dimension;
    let place = match derivative {
        true => dimension,
        false => dimension.multiply(Dimension::TIME),
    };
    Some(place.is_dimensionless() || place.divide(Dimension::LENGTH).is_dimensionless())
}
