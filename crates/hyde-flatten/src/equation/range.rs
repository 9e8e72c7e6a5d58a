//! `for`: one equation over a range, or unrolled.
//!
//! ```text
//! for i in 2:n-1 loop der(x[i]) = x[i+1] - x[i]; end for;     one equation with a counter from 2 to n-1
//! for i in 1:2 loop connect(m[i].b, m[i+1].a); end for;       connect(m[1].b, m[2].a); connect(m[2].b, m[3].a);
//! ```

use super::kind::lower_equation;
use super::unroll::can_unroll;
use crate::instance::{Counter, Scope};
use crate::model::Model;
use crate::refusals::equations as refused;
use crate::words::short;
use hyde_diag::Diagnostics;
use hyde_ir::flat::Equation;
use hyde_ir::{Expr as Ir, FlatModel, Range};
use hyde_syntax::ast::{self, EquationKind, Expr};

pub(super) fn for_equation<'a>(
    model: &mut Model<'a, '_>,
    counter: &'a ast::Name,
    first: &'a Expr,
    last: &'a Expr,
    body: &'a [ast::Equation],
    scope: &Scope<'a>,
) -> Vec<Equation> {
    let (Some(first), Some(last)) = (
        model.structural_integer_in(scope, first),
        model.structural_integer_in(scope, last),
    ) else {
        return Vec::new();
    };
    if last < first {
        return Vec::new();
    }
    let name = counter.text.as_str();
    let range = Range {
        first: i32::try_from(first).unwrap_or(0),
        last: i32::try_from(last).unwrap_or(0),
    };
    let plain = body
        .iter()
        .all(|e| matches!(&e.kind, EquationKind::Equality { place: None, .. }));
    let outermost = !scope
        .counters
        .iter()
        .any(|(_, counter)| matches!(counter, Counter::Symbolic));
    if plain && outermost && range.len() > 1 && scope.elementwise.is_none() {
        let mut inner = scope.clone();
        inner.counters.push((name, Counter::Symbolic));
        let list = model.together(|model| {
            let each = |equation| lower_equation(model, equation, &inner);
            body.iter().flat_map(each).collect::<Vec<Equation>>()
        });
        if let Some(list) = list {
            return list
                .into_iter()
                .filter_map(|equation| {
                    in_bounds(
                        &model.flat,
                        model.diagnostics,
                        Equation { range, ..equation },
                    )
                })
                .collect();
        }
    }
    if !can_unroll(model.diagnostics, range.len(), counter.span) {
        return Vec::new();
    }
    let mut list = Vec::new();
    for value in range.iter() {
        let mut inner = scope.clone();
        inner.counters.push((name, Counter::Fixed(value)));
        for equation in body {
            list.extend(lower_equation(model, equation, &inner));
        }
    }
    list
}

/// An array equation whose elements all exist; reported if not.
fn in_bounds(
    flat: &FlatModel,
    diagnostics: &mut Diagnostics,
    equation: Equation,
) -> Option<Equation> {
    for id in flat.exprs.below(&[equation.lhs, equation.rhs]) {
        let (len, index, name, base) = match flat.exprs[id] {
            Ir::Var(var, index) | Ir::Der(var, index) | Ir::Pre(var, index) => {
                let variable = &flat.variables[var];
                (variable.size(), index, &variable.name, variable.first)
            }
            Ir::Param(param, index) => {
                let parameter = &flat.parameters[param];
                (parameter.size(), index, &parameter.name, 1)
            }
            Ir::Const(_)
            | Ir::Time
            | Ir::Counter
            | Ir::Relation(_)
            | Ir::InMode(..)
            | Ir::Unary(..)
            | Ir::Binary(..)
            | Ir::If(..)
            | Ir::NoEvent(_) => continue,
        };
        for counter in [equation.range.first, equation.range.last] {
            let at = index.at(counter);
            if usize::try_from(at).is_ok_and(|at| at < len) {
                continue;
            }
            let element = (short(name), at + base);
            diagnostics.push(refused::no_element(
                element,
                len,
                (equation.origin.span, counter),
            ));
            return None;
        }
    }
    Some(equation)
}
