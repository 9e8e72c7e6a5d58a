//! `for`: one equation over a range, or unrolled.
//!
//! ```text
//! for i in 2:n-1 loop der(x[i]) = x[i+1] - x[i]; end for;     one equation with a counter from 2 to n-1
//! for i in 1:2 loop connect(m[i].b, m[i+1].a); end for;       connect(m[1].b, m[2].a); connect(m[2].b, m[3].a);
//! ```

use crate::bind::short;
use crate::instance::{Counter, Scope};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::flat::Equation;
use hyde_ir::{Expr as Ir, Range};
use hyde_syntax::ast::{self, EquationKind, Expr};

/// Loops that cannot stay a range are unrolled up to this many turns.
const MAX_UNROLLED: usize = 10_000;

impl<'a> Model<'a, '_> {
    pub(super) fn for_equation(
        &mut self,
        counter: &'a ast::Name,
        first: &'a Expr,
        last: &'a Expr,
        body: &'a [ast::Equation],
        scope: &Scope<'a>,
    ) -> Vec<Equation> {
        let (Some(first), Some(last)) = (
            self.structural_integer_in(scope, first),
            self.structural_integer_in(scope, last),
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
            let list: Vec<Equation> = body
                .iter()
                .flat_map(|equation| self.equation(equation, &inner))
                .collect();
            if !std::mem::take(&mut self.needs_unrolling) {
                return list
                    .into_iter()
                    .filter_map(|equation| self.in_bounds(Equation { range, ..equation }))
                    .collect();
            }
        }
        if !self.can_unroll(range.len(), counter.span) {
            return Vec::new();
        }
        let mut list = Vec::new();
        for value in range.iter() {
            let mut inner = scope.clone();
            inner.counters.push((name, Counter::Fixed(value)));
            for equation in body {
                list.extend(self.equation(equation, &inner));
            }
        }
        list
    }

    /// Whether so many elements are not too many to have an equation each; reported if they are.
    pub(crate) fn can_unroll(&mut self, turns: usize, span: Span) -> bool {
        if turns > MAX_UNROLLED {
            self.report(
                Diagnostic::error(
                    Code::ArrayEquation,
                    format!("a loop over components of {turns} turns"),
                )
                .label(span, format!("unrolled at most {MAX_UNROLLED} times"))
                .help("use arrays of variables in one component: their equations are not unrolled"),
            );
        }
        turns <= MAX_UNROLLED
    }

    /// An array equation whose elements all exist; reported if not.
    fn in_bounds(&mut self, equation: Equation) -> Option<Equation> {
        for id in self.flat.exprs.below(&[equation.lhs, equation.rhs]) {
            let (len, index, name, base) = match self.flat.exprs[id] {
                Ir::Var(var, index) | Ir::Der(var, index) | Ir::Pre(var, index) => {
                    let variable = &self.flat.variables[var];
                    (variable.size(), index, &variable.name, variable.first)
                }
                Ir::Param(param, index) => {
                    let parameter = &self.flat.parameters[param];
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
                let message = format!("`{}` has no element {}", short(name), at + base);
                self.report(
                    Diagnostic::error(Code::BadShape, message)
                        .label(
                            equation.origin.span,
                            format!("reached for a counter of {counter}"),
                        )
                        .help(format!(
                            "the array has {len} elements: change the bounds of the loop"
                        )),
                );
                return None;
            }
        }
        Some(equation)
    }
}
