//! What comes from outside or from the past has no derivative.

use crate::system::System;
use hyde_diag::{Code, Diagnostic, Diagnostics};
use hyde_ir::{Expr, VariableKind};

/// Reports every equation that needs the derivative of a recorded column or of a delayed value.
pub(super) fn refuse(system: &System, diagnostics: &mut Diagnostics) {
    for equation in &system.equations {
        for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
            let Expr::Der(var, _) = system.flat.exprs[id] else {
                continue;
            };
            let name = &system.flat.variables[var].name;
            let (what, help) = match system.flat.variables[var].kind {
                VariableKind::Column(..) => (
                    format!("the recorded column `{name}`"),
                    "drive the model by a force or through a spring, or give the velocity as a stimulus too",
                ),
                VariableKind::Delayed(_) => (
                    format!("`{name}`"),
                    "drive the model by a force or through a spring: what is delayed may jump, and has no derivative there",
                ),
                VariableKind::Continuous
                | VariableKind::Discrete
                | VariableKind::Clocked(_)
                | VariableKind::Held(..)
                | VariableKind::Reduction(_) => continue,
            };
            let mut diagnostic = Diagnostic::error(
                Code::Constrained,
                format!("the derivative of {what} is needed"),
            )
            .label(equation.origin.span, "by this equation");
            if let VariableKind::Delayed(delay) = system.flat.variables[var].kind {
                let span = system.flat.delays[delay].origin.span;
                diagnostic = diagnostic.label(span, "delayed here");
            }
            diagnostics.push(diagnostic.help(help));
        }
    }
}
