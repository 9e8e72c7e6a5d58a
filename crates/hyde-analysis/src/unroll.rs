//! Array equations that determine no whole array are unrolled into scalar ones, up to 64 elements, with a note (F3).

use crate::refusals::unmatched as refused;
use crate::system::{Equation, System};
use hyde_diag::Diagnostics;
use hyde_ir::{Expr, ExprId, Range, VarId};

/// Arrays larger than this are not unrolled.
const MAX_ELEMENTS: usize = 64;

/// Unrolls every equation that mentions one of the arrays; `None` if one is too large.
pub(crate) fn unroll(
    system: &mut System,
    arrays: &[VarId],
    diagnostics: &mut Diagnostics,
) -> Option<()> {
    for &array in arrays {
        let variable = &system.flat.variables[array];
        if variable.size() > MAX_ELEMENTS {
            let defining = system
                .equations
                .iter()
                .find(|equation| mentions(system, equation, &[array]));
            let declared = (variable.origin.span, variable.size());
            let reading = defining.map(|equation| equation.origin.span);
            diagnostics.push(refused::array_not_whole(
                &variable.name,
                declared,
                MAX_ELEMENTS,
                reading,
            ));
            return None;
        }
        system.notes.push(format!(
            "the equations of `{}` are unrolled element by element",
            variable.name
        ));
    }
    let mut unrolled = Vec::new();
    for equation in std::mem::take(&mut system.equations) {
        if equation.range == Range::SCALAR || !mentions(system, &equation, arrays) {
            unrolled.push(equation);
            continue;
        }
        for counter in equation.range.iter() {
            let (lhs, rhs) = (
                at(system, equation.lhs, counter),
                at(system, equation.rhs, counter),
            );
            unrolled.push(Equation {
                range: Range::SCALAR,
                lhs,
                rhs,
                origin: equation.origin.clone(),
                order: equation.order,
                constraint: equation.constraint,
            });
        }
    }
    system.equations = unrolled;
    Some(())
}

/// An expression at one value of its counter.
pub(crate) fn at(system: &mut System, id: ExprId, counter: i32) -> ExprId {
    system.flat.exprs.at_counter(id, counter)
}

fn mentions(system: &System, equation: &Equation, arrays: &[VarId]) -> bool {
    system.flat.exprs.below(&[equation.lhs, equation.rhs]).into_iter().any(|id| {
        matches!(system.flat.exprs[id], Expr::Var(var, _) | Expr::Der(var, _) if arrays.contains(&var))
    })
}
