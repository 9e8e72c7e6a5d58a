//! Loops of rigid parts that are closed once more than they can be, in the words of the model.

use crate::matching::{Node, origin, sides};
use crate::refusals::conflicts as refused;
use crate::system::System;
use hyde_diag::{Diagnostic, MadeBy, Origin, Span};
use hyde_ir::Expr;

/// Constraints of which each follows from the others wherever they hold.
pub(crate) fn held_once_more(system: &System, constraints: Vec<Node>) -> Diagnostic {
    let mut parts: Vec<(String, Span)> = Vec::new();
    // What the top of the model says itself.
    let mut own: Vec<Span> = Vec::new();
    for node in constraints {
        let equation = origin(system, node);
        if system.component(&equation).is_none() && !own.contains(&equation.span) {
            own.push(equation.span);
        }
        for origin in named(system, node) {
            if let Some(part) = system.component(&origin)
                && !parts.contains(&part)
            {
                parts.push(part);
            }
        }
    }
    parts.sort_by_key(|(_, span)| span.start);
    refused::closed_once_more(&own, &parts)
}

/// Who has a part in an equation: itself, its variables, and the parameters that are its dimensions.
fn named(system: &System, node: Node) -> Vec<Origin> {
    let own = origin(system, node);
    let mut found = Vec::new();
    if !matches!(own.made_by, MadeBy::Connection | MadeBy::Unconnected) {
        found.push(own);
    }
    for (_, lhs, rhs) in sides(system, node) {
        for id in system.flat.exprs.below(&[lhs, rhs]) {
            match system.flat.exprs[id] {
                Expr::Var(var, _) => found.push(system.flat.variables[var].origin.clone()),
                Expr::Param(param, _) => found.push(system.flat.parameters[param].origin.clone()),
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)
                | Expr::Unary(..)
                | Expr::Binary(..)
                | Expr::If(..)
                | Expr::NoEvent(_) => {}
            }
        }
    }
    found
}
