//! Equations of the model's sections: equalities, `for`, `if`, `when`, `assert`, in the scope of their instance.
//!
//! A `for` equation stays one equation over a range where every subscript is affine in its counter and names an element
//! of an array; otherwise (components, products of counters) it is unrolled. An `if` whose condition is made of
//! parameters alone chooses its branch here and makes them structural; any other becomes one equation with the
//! branches inside.

mod branch;
mod event;
mod range;

use crate::instance::{Counter, Elementwise, InstanceId, Position, Scope, Setting};
use crate::model::Model;
use crate::zero;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::Range;
use hyde_ir::flat::{Assert, ClockedEquation, Equation};
use hyde_syntax::ast::{self, Element, EquationKind, Expr, ExprKind};

impl<'a> Model<'a, '_> {
    /// Lowers the equations, modes and events of every instance.
    pub(crate) fn lower_equations(&mut self) {
        for id in self.tree.ids() {
            let clock = self.clock_of(id);
            let setting = if clock.is_some() {
                Setting::Clocked
            } else {
                Setting::Equation
            };
            let scope = Scope::new(id, setting);
            for (_, element) in self.tree[id].elements.clone() {
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
                    Element::Measure(measure) if self.tree[id].parent.is_none() => {
                        self.measure(measure, id)
                    }
                    Element::Measure(_)
                    | Element::Account(..)
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
        for id in self.tree.ids() {
            for (_, element) in self.tree[id].elements.clone() {
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
            } => self.equality(lhs, rhs, scope, span),
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
                let origin = self.tree.origin(scope.instance, span);
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
                        .help("write it in `when … then`, or after an exit of a mode"),
                );
                Vec::new()
            }
        }
    }

    /// `lhs = rhs`, of scalars or of whole arrays: one equation over a range, or one an element where lists or components
    /// are among them.
    fn equality(
        &mut self,
        lhs: &'a Expr,
        rhs: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Vec<Equation> {
        let len = self.array_length(lhs, scope);
        let Some(len) = len.or_else(|| self.array_length(rhs, scope)) else {
            let equation = self.one_equality((lhs, rhs), Range::SCALAR, scope, span);
            return equation.into_iter().collect();
        };
        let in_loop = self.needs_unrolling;
        let range = Range {
            first: 0,
            last: i32::try_from(len).unwrap_or(i32::MAX) - 1,
        };
        let counted = scope.elements(Elementwise::Range(len));
        let counts = |(_, counter): &(_, Counter)| matches!(counter, Counter::Symbolic);
        if scope.counters.iter().any(counts) {
            // One counter an equation: the loop around it is unrolled.
            self.needs_unrolling = true;
            return Vec::new();
        }
        let whole = self.one_equality((lhs, rhs), range, &counted, span);
        if !std::mem::replace(&mut self.needs_unrolling, in_loop) {
            return whole.into_iter().collect();
        }
        if !self.can_unroll(len, span) {
            return Vec::new();
        }
        let one = |at| scope.elements(Elementwise::One(Position { at, of: len }));
        (0..len)
            .filter_map(|at| self.one_equality((lhs, rhs), Range::SCALAR, &one(at), span))
            .collect()
    }

    fn one_equality(
        &mut self,
        (lhs, rhs): (&'a Expr, &'a Expr),
        range: Range,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<Equation> {
        let (left, right) = (self.lower(lhs, scope), self.lower(rhs, scope));
        self.same_kind(&left, &right);
        if matches!(lhs.kind, ExprKind::Reference(_)) {
            self.check_whole(&left, &right);
            zero::show_difference(&mut self.flat, &mut self.variables, (&left, &right));
        }
        self.agree(&left, &right, "`=` equates", scope.instance);
        let origin = self.tree.origin(scope.instance, span);
        (!self.needs_unrolling).then_some(Equation {
            range,
            lhs: left.id,
            rhs: right.id,
            origin,
        })
    }

    /// A measure declared in the model itself.
    fn measure(&mut self, measure: &'a ast::Measure, id: InstanceId) {
        let scope = Scope::new(id, Setting::Measure);
        self.add_measure(measure, &scope);
    }
}
