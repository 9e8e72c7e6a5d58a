//! What comes from outside or from the past has no derivative.

use crate::refusals::states as refused;
use crate::system::System;
use hyde_diag::Diagnostics;
use hyde_ir::{Expr, VariableKind};

/// Reports every equation that needs the derivative of a recorded column or of a delayed value.
pub(super) fn refuse(system: &System, diagnostics: &mut Diagnostics) {
    for equation in &system.equations {
        for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
            let Expr::Der(var, _) = system.flat.exprs[id] else {
                continue;
            };
            let name = &system.flat.variables[var].name;
            let span = equation.origin.span;
            diagnostics.push(match system.flat.variables[var].kind {
                VariableKind::Column(..) => refused::derivative_of_column(name, span),
                VariableKind::Delayed(delay) => {
                    let delay = system.flat.delays[delay].origin.span;
                    refused::derivative_of_delayed(name, span, delay)
                }
                VariableKind::Continuous
                | VariableKind::Discrete
                | VariableKind::Clocked(_)
                | VariableKind::Held(..)
                | VariableKind::Reduction(_) => continue,
            });
        }
    }
}
