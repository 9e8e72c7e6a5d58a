//! `if`: a branch chosen here, or one equation with the branches inside.
//!
//! ```text
//! if n > 3 then x = a; else x = b; end if;     n a parameter: one of the two, and n is structural
//! if s > 0 then x = a; else x = b; end if;     x = if s > 0 then a else b
//! if s > 0 then x = a; else y = b; end if;     0 = if s > 0 then a - x else b - y
//! ```

use super::kind::lower_equation;
use crate::instance::Scope;
use crate::model::Model;
use crate::refusals::equations as refused;
use hyde_diag::Span;
use hyde_ir::flat::Equation;
use hyde_ir::{Expr as Ir, ExprId, FlatModel};
use hyde_syntax::ast::{self, Expr};

pub(super) fn if_equation<'a>(
    model: &mut Model<'a, '_>,
    branches: &'a [(Expr, Vec<ast::Equation>)],
    otherwise: &'a [ast::Equation],
    scope: &Scope<'a>,
    span: Span,
) -> Vec<Equation> {
    let conditions: Vec<ExprId> = branches
        .iter()
        .map(|(condition, _)| model.truth(condition, scope))
        .collect();
    let parametric = conditions.iter().all(|&id| {
        !model.flat.exprs.any(id, |e| {
            matches!(
                e,
                Ir::Var(..) | Ir::Der(..) | Ir::Pre(..) | Ir::Time | Ir::Counter
            )
        })
    });
    if parametric {
        for (&condition, (_, list)) in conditions.iter().zip(branches) {
            if model.evaluate(condition).is_some_and(|value| value != 0.0) {
                return list
                    .iter()
                    .flat_map(|equation| lower_equation(model, equation, scope))
                    .collect();
            }
        }
        return otherwise
            .iter()
            .flat_map(|equation| lower_equation(model, equation, scope))
            .collect();
    }
    let mut lists: Vec<Vec<Equation>> = Vec::new();
    for list in branches
        .iter()
        .map(|(_, list)| list.as_slice())
        .chain([otherwise])
    {
        lists.push(
            list.iter()
                .flat_map(|equation| lower_equation(model, equation, scope))
                .collect(),
        );
    }
    let counts: Vec<usize> = lists.iter().map(Vec::len).collect();
    if counts.iter().any(|count| *count != counts[0]) {
        let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
        model.report(refused::branches_differ(span, &counts));
        return Vec::new();
    }
    (0..counts[0])
        .map(|at| merged(&mut model.flat, &conditions, &lists, at))
        .collect()
}

/// The equations at one position of all branches as one.
fn merged(
    flat: &mut FlatModel,
    conditions: &[ExprId],
    lists: &[Vec<Equation>],
    at: usize,
) -> Equation {
    let equations: Vec<&Equation> = lists.iter().map(|list| &list[at]).collect();
    let first = equations[0];
    let same_left = equations.iter().all(|equation| equation.lhs == first.lhs);
    let arena = &mut flat.exprs;
    let side = |arena: &mut hyde_ir::ExprArena, equation: &Equation| {
        if same_left {
            equation.rhs
        } else {
            arena.minus(equation.rhs, equation.lhs)
        }
    };
    let mut value = equations
        .last()
        .map_or(first.rhs, |equation| side(arena, equation));
    for (&condition, equation) in conditions.iter().zip(&equations).rev() {
        let branch = side(arena, equation);
        value = arena.if_else(condition, branch, value);
    }
    let lhs = if same_left {
        first.lhs
    } else {
        arena.constant(0.0)
    };
    Equation {
        range: first.range,
        lhs,
        rhs: value,
        origin: first.origin.clone(),
    }
}
