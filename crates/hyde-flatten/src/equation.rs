//! Equations of the model's sections: equalities, `for`, `if`, `when`, `assert`, in the scope of their instance.
//!
//! A `for` equation stays one equation over a range where every subscript is affine in its counter and names an element
//! of an array; otherwise (components, products of counters) it is unrolled. An `if` whose condition is made of
//! parameters alone chooses its branch here and makes them structural; any other becomes one equation with the
//! branches inside.

use crate::bind::short;
use crate::instance::{Counter, InstanceId, Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::flat::{Action, Assert, ClockedEquation, Equation, When};
use hyde_ir::{Expr as Ir, ExprId, Index, Range, VariableKind};
use hyde_syntax::ast::{self, Element, EquationKind, Expr, ExprKind};

/// Loops that cannot stay a range are unrolled up to this many turns.
const MAX_UNROLLED: i64 = 10_000;

impl<'a> Model<'a, '_> {
    /// Lowers the equations, modes and events of every instance.
    pub(crate) fn lower_equations(&mut self) {
        for id in 0..self.instances.len() {
            let clock = self.instances[id].clock;
            let setting = if clock.is_some() {
                Setting::Clocked
            } else {
                Setting::Equation
            };
            let scope = Scope::new(id, setting);
            for (_, element) in self.instances[id].elements.clone() {
                match element {
                    Element::Equation(equation) | Element::Add(equation) => {
                        let list = self.equation(equation, &scope);
                        match clock {
                            Some(clock) => {
                                let list = list
                                    .into_iter()
                                    .map(|equation| ClockedEquation { clock, equation });
                                self.flat.clocked_equations.extend(list);
                            }
                            None => self.flat.equations.extend(list),
                        }
                    }
                    Element::InitialEquation(equation) => {
                        let list = self.equation(equation, &scope);
                        self.flat.initial_equations.extend(list);
                    }
                    Element::Modes(modes) => self.modes(modes, id),
                    Element::Measure(measure) if self.instances[id].parent.is_none() => {
                        self.measure(measure, id)
                    }
                    Element::Measure(_)
                    | Element::Extends(..)
                    | Element::Declaration(_)
                    | Element::Domain(_)
                    | Element::Discretize(_)
                    | Element::Clocked(_)
                    | Element::Wrap(..)
                    | Element::Replace(..)
                    | Element::Signature(_)
                    | Element::Confounds(_) => {}
                }
            }
        }
    }

    /// Finds the end fluxes that field equations need, before anything reads them.
    pub(crate) fn make_traces_of_equations(&mut self) {
        for id in 0..self.instances.len() {
            for (_, element) in self.instances[id].elements.clone() {
                if let Element::Equation(ast::Equation {
                    kind:
                        EquationKind::Equality {
                            lhs,
                            rhs,
                            place: Some(place),
                        },
                    span,
                }) = element
                    && place.end.is_none()
                {
                    self.traces_of(lhs, rhs, place, &Scope::new(id, Setting::Equation), *span);
                }
            }
        }
    }

    /// Lowers an equation or what stands among equations; connections, events and asserts go where they belong.
    pub(crate) fn equation(
        &mut self,
        equation: &'a ast::Equation,
        scope: &Scope<'a>,
    ) -> Vec<Equation> {
        let span = equation.span;
        match &equation.kind {
            EquationKind::Equality {
                lhs,
                rhs,
                place: Some(place),
            } => {
                self.field_equation(lhs, rhs, place, scope, span);
                Vec::new()
            }
            EquationKind::Equality {
                lhs,
                rhs,
                place: None,
            } => self.equality(lhs, rhs, scope, span).into_iter().collect(),
            EquationKind::Connect(sides) => {
                self.connection(sides, scope, span);
                Vec::new()
            }
            EquationKind::For {
                counter,
                first,
                last,
                equations,
            } => self.for_equation(counter, first, last, equations, scope),
            EquationKind::If {
                branches,
                otherwise,
            } => self.if_equation(branches, otherwise, scope, span),
            EquationKind::When(branches) => {
                self.when(branches, scope, span);
                Vec::new()
            }
            EquationKind::Assert(condition, message) => {
                let condition = self.truth(condition, &scope.with(Setting::Condition));
                let origin = self.origin(scope.instance, span);
                self.flat.asserts.push(Assert {
                    condition,
                    message: message.clone(),
                    origin,
                });
                Vec::new()
            }
            EquationKind::Reinit(state, _) => {
                self.report(
                    Diagnostic::error(Code::Misplaced, "`reinit` outside an event")
                        .label(state.span, "when?")
                        .help("write it in `when … then`, or behind an exit of a mode"),
                );
                Vec::new()
            }
        }
    }

    /// `lhs = rhs`, of scalars or of whole arrays.
    fn equality(
        &mut self,
        lhs: &'a Expr,
        rhs: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<Equation> {
        let len = self
            .array_length(lhs, scope)
            .or_else(|| self.array_length(rhs, scope));
        let (range, scope) = match len {
            Some(len) => {
                let last = i32::try_from(len).unwrap_or(i32::MAX) - 1;
                (
                    Range { first: 0, last },
                    Scope {
                        elementwise: Some(len),
                        ..scope.clone()
                    },
                )
            }
            None => (Range::SCALAR, scope.clone()),
        };
        let (left, right) = (self.lower(lhs, &scope), self.lower(rhs, &scope));
        self.same_kind(&left, &right);
        self.agree(&left, &right, "`=` equates", scope.instance);
        if self.needs_unrolling {
            return None;
        }
        let origin = self.origin(scope.instance, span);
        Some(Equation {
            range,
            lhs: left.id,
            rhs: right.id,
            origin,
        })
    }

    fn for_equation(
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
        if last - first >= MAX_UNROLLED {
            self.report(
                Diagnostic::error(
                    Code::ArrayEquation,
                    format!("a loop over components of {} turns", last - first + 1),
                )
                .label(
                    counter.span,
                    format!("unrolled at most {MAX_UNROLLED} times"),
                )
                .help("use arrays of variables in one component: their equations are not unrolled"),
            );
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

    fn if_equation(
        &mut self,
        branches: &'a [(Expr, Vec<ast::Equation>)],
        otherwise: &'a [ast::Equation],
        scope: &Scope<'a>,
        span: Span,
    ) -> Vec<Equation> {
        let conditions: Vec<ExprId> = branches
            .iter()
            .map(|(condition, _)| self.truth(condition, scope))
            .collect();
        let parametric = conditions.iter().all(|&id| {
            !self.flat.exprs.any(id, |e| {
                matches!(
                    e,
                    Ir::Var(..) | Ir::Der(..) | Ir::Pre(..) | Ir::Time | Ir::Counter
                )
            })
        });
        if parametric {
            for (&condition, (_, list)) in conditions.iter().zip(branches) {
                if self.evaluate(condition).is_some_and(|value| value != 0.0) {
                    return list
                        .iter()
                        .flat_map(|equation| self.equation(equation, scope))
                        .collect();
                }
            }
            return otherwise
                .iter()
                .flat_map(|equation| self.equation(equation, scope))
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
                    .flat_map(|equation| self.equation(equation, scope))
                    .collect(),
            );
        }
        let counts: Vec<usize> = lists.iter().map(Vec::len).collect();
        if counts.iter().any(|count| *count != counts[0]) {
            let counts: Vec<String> = counts.iter().map(usize::to_string).collect();
            self.report(
                Diagnostic::error(
                    Code::ModeEquations,
                    "the branches have different numbers of equations",
                )
                .label(span, format!("{} equations", counts.join(", ")))
                .help("every branch, `else` too, determines the same variables"),
            );
            return Vec::new();
        }
        (0..counts[0])
            .map(|at| self.merged(&conditions, &lists, at))
            .collect()
    }

    /// The equations at one position of all branches as one.
    fn merged(&mut self, conditions: &[ExprId], lists: &[Vec<Equation>], at: usize) -> Equation {
        let equations: Vec<&Equation> = lists.iter().map(|list| &list[at]).collect();
        let first = equations[0];
        let same_left = equations.iter().all(|equation| equation.lhs == first.lhs);
        let arena = &mut self.flat.exprs;
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

    fn when(&mut self, branches: &'a [(Expr, Vec<ast::Equation>)], scope: &Scope<'a>, span: Span) {
        if scope.setting == Setting::Clocked {
            self.report(
                Diagnostic::error(Code::ClockBorder, "`when` inside a clocked part")
                    .label(span, "everything here happens at the tick")
                    .help("write `x = if … then … else pre(x);`"),
            );
            return;
        }
        let mut list = Vec::new();
        for (condition, equations) in branches {
            let condition = self.truth(condition, &scope.with(Setting::Condition));
            let actions = equations
                .iter()
                .filter_map(|equation| self.action(equation, scope))
                .collect();
            list.push((condition, actions));
        }
        let origin = self.origin(scope.instance, span);
        self.flat.whens.push(When {
            branches: list,
            origin,
        });
    }

    /// What an event sets: `reinit(x, e)`, or `d = e` of a discrete variable.
    pub(crate) fn action(
        &mut self,
        equation: &'a ast::Equation,
        scope: &Scope<'a>,
    ) -> Option<Action> {
        let at_event = scope.with(Setting::Action);
        let (target, value, reinit) = match &equation.kind {
            EquationKind::Reinit(state, value) => (state, value, true),
            EquationKind::Equality {
                lhs:
                    Expr {
                        kind: ExprKind::Reference(name),
                        ..
                    },
                rhs,
                place: None,
            } => (name, rhs, false),
            EquationKind::Equality { .. }
            | EquationKind::Connect(_)
            | EquationKind::For { .. }
            | EquationKind::If { .. }
            | EquationKind::When(_)
            | EquationKind::Assert(..) => {
                self.report(
                    Diagnostic::error(Code::Misplaced, "an event sets variables one by one")
                        .label(equation.span, "neither `reinit(x, e)` nor `d = e`"),
                );
                return None;
            }
        };
        let Some(Resolved::Variable(var, index)) = self.resolve(target, scope) else {
            self.report(
                Diagnostic::error(Code::WrongType, "no variable to set")
                    .label(target.span, "not a variable"),
            );
            return None;
        };
        let index = index.unwrap_or(Index::SCALAR);
        let value = self.lower(value, &at_event);
        let lhs = self.flat.exprs.add(Ir::Var(var, index));
        let declared = Typed {
            truth: self.flat.variables[var].boolean,
            ..self.typed(lhs, self.dim(var), target.span)
        };
        self.same_kind(&declared, &value);
        self.agree(
            &declared,
            &value,
            "the variable and its new value are",
            scope.instance,
        );
        let kind = self.flat.variables[var].kind;
        match (reinit, kind) {
            (true, VariableKind::Continuous) => Some(Action::Reinit(var, index, value.id)),
            (false, VariableKind::Discrete) => Some(Action::Assign(var, index, value.id)),
            (true, _) => {
                self.report(
                    Diagnostic::error(
                        Code::WrongType,
                        format!("`{}` is no state", target.dotted()),
                    )
                    .label(target.span, "only a state can be reinitialised")
                    .help("set a discrete variable with `=`"),
                );
                None
            }
            (false, _) => {
                self.report(
                    Diagnostic::error(
                        Code::WrongType,
                        format!("`{}` is continuous", target.dotted()),
                    )
                    .label(target.span, "an event cannot equate it")
                    .help("let a state jump with `reinit(x, e)`"),
                );
                None
            }
        }
    }

    /// A measure declared in the model itself.
    fn measure(&mut self, measure: &'a ast::Measure, id: InstanceId) {
        let scope = Scope::new(id, Setting::Measure);
        self.add_measure(measure, &scope);
    }
}
