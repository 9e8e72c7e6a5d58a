//! Expressions to IR: names to what they stand for in scope, numbers to SI, every operation with its dimension.

use crate::dimension::Dim;
use crate::instance::{Counter, FieldPlace, InstanceId, Member, Scope, Setting, Typed};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::{BinaryOp, Expr as Ir, Id as _, Index, ParamId, UnaryOp, VarId, VariableKind};
use hyde_syntax::ast::{Binary, Expr, ExprKind, Reference, Unary, UnitText};
use hyde_units::{AngleExponent, Exponent, NamedUnit, UnitError};

/// What a name stands for.
pub(crate) enum Resolved {
    /// A variable; the element, if one is named.
    Variable(VarId, Option<Index>),
    /// A parameter; the element, if one is named.
    Parameter(ParamId, Option<Index>),
    Instance(InstanceId),
    Counter(Counter),
    Time,
    Pi,
    /// The coordinate of the domain the field expression is on.
    Coordinate,
}

impl<'a> Model<'a, '_> {
    /// Lowers an expression. What is wrong with it is reported, and something harmless takes its place.
    pub(crate) fn lower(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Typed {
        let span = expr.span;
        match &expr.kind {
            ExprKind::Number(value, unit) => self.number(*value, unit.as_ref(), span),
            ExprKind::Boolean(value) => {
                let id = self.flat.exprs.constant(f64::from(u8::from(*value)));
                Typed {
                    truth: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            ExprKind::String(_) => {
                self.report(
                    Diagnostic::error(Code::WrongType, "a text is no value").label(span, "a text"),
                );
                self.poison(span)
            }
            ExprKind::Reference(reference) => self.reference(reference, scope),
            ExprKind::Call(function, arguments) => self.call(function, arguments, scope, span),
            ExprKind::Unary(op, inner) => self.unary(*op, inner, scope, span),
            ExprKind::Binary(op, left, right) => self.binary(*op, left, right, scope, span),
            ExprKind::If(branches, otherwise) => {
                let mut value = self.lower(otherwise, scope);
                for (condition, branch) in branches.iter().rev() {
                    let condition = self.truth(condition, scope);
                    let branch = self.lower(branch, scope);
                    self.same_kind(&branch, &value);
                    self.agree(&branch, &value, "the branches have", scope.instance);
                    let id = self.flat.exprs.if_else(condition, branch.id, value.id);
                    let dim = sum_dim(&branch.dim, &value.dim);
                    value = Typed {
                        id,
                        dim,
                        bare: branch.bare && value.bare,
                        two_pi: false,
                        span,
                        truth: value.truth,
                    };
                }
                value
            }
            ExprKind::Array(..) => {
                self.report(
                    Diagnostic::error(Code::BadShape, "a list stands where one value is expected")
                        .label(span, "a list"),
                );
                self.poison(span)
            }
        }
    }

    /// Lowers an expression that must be a truth.
    pub(crate) fn truth(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> hyde_ir::ExprId {
        let typed = self.lower(expr, scope);
        if !typed.truth && typed.dim != Dim::Any {
            self.report(
                Diagnostic::error(Code::WrongType, "a condition is expected, this is a number")
                    .label(expr.span, "a number")
                    .help(format!(
                        "compare it: `{} > 0`",
                        hyde_syntax::format_expression(expr)
                    )),
            );
        }
        typed.id
    }

    /// Lowers an expression that must be a number.
    pub(crate) fn value(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Typed {
        let typed = self.lower(expr, scope);
        if typed.truth {
            self.report(
                Diagnostic::error(Code::WrongType, "a number is expected, this is a condition")
                    .label(expr.span, "true or false")
                    .help("write `if … then 1 else 0`"),
            );
        }
        typed
    }

    /// What a name stands for; reported if nothing.
    pub(crate) fn resolve(
        &mut self,
        reference: &'a Reference,
        scope: &Scope<'a>,
    ) -> Option<Resolved> {
        let first = reference.parts.first()?;
        let word = first.name.text.as_str();
        if reference.parts.len() == 1 && first.subscripts.is_empty() {
            if let Some((_, counter)) = scope.counters.iter().rev().find(|(name, _)| *name == word)
            {
                return Some(Resolved::Counter(*counter));
            }
            if let Some((_, var)) = scope.locals.iter().rev().find(|(name, _)| *name == word) {
                return Some(Resolved::Variable(*var, None));
            }
            if self.coordinate(scope) == Some(word) {
                return Some(Resolved::Coordinate);
            }
        }
        if scope.records
            && self
                .flat
                .experiment
                .records
                .iter()
                .any(|record| record == word)
        {
            return self.record_column(reference, scope);
        }
        let mut at = scope.instance;
        let mut member = loop {
            if let Some(member) = self.instances[at].members.get(word) {
                break member.clone();
            }
            match (self.instances[at].outer, word) {
                (Some(outer), _) => at = outer,
                (None, "time") => return Some(Resolved::Time),
                (None, "pi") => return Some(Resolved::Pi),
                (None, _) => {
                    self.unknown_name(scope, scope.instance, word, reference);
                    return None;
                }
            }
        };
        let mut parts = reference.parts.iter();
        let mut part = parts.next()?;
        loop {
            let subscript = match part.subscripts.as_slice() {
                [] => None,
                [subscript] => Some(subscript),
                [_, second, ..] => {
                    self.report(
                        Diagnostic::error(
                            Code::BadShape,
                            "arrays have one dimension in this version",
                        )
                        .label(second.span, "a second subscript"),
                    );
                    return None;
                }
            };
            let instance = match member {
                Member::Variable(var) => {
                    let variable = &self.flat.variables[var];
                    let (len, first) = (variable.len, variable.first);
                    let rest = parts.next();
                    let index = self.element(subscript, len, first, scope, reference)?;
                    return self
                        .last(rest, reference)
                        .then_some(Resolved::Variable(var, index));
                }
                Member::Parameter(param) => {
                    let len = self.flat.parameters[param].len;
                    let rest = parts.next();
                    let index = self.element(subscript, len, 1, scope, reference)?;
                    return self
                        .last(rest, reference)
                        .then_some(Resolved::Parameter(param, index));
                }
                Member::Domain(_) => {
                    self.report(
                        Diagnostic::error(
                            Code::FieldUse,
                            format!("`{}` is a domain, not a value", part.name.text),
                        )
                        .label(reference.span, "a domain"),
                    );
                    return None;
                }
                Member::Instance(instance) if subscript.is_none() => instance,
                Member::Instance(_) => {
                    self.not_an_array(reference);
                    return None;
                }
                Member::Instances(list) => self.one_of(&list, subscript, scope, reference)?,
            };
            let Some(next) = parts.next() else {
                return Some(Resolved::Instance(instance));
            };
            let word = next.name.text.as_str();
            let Some(inner) = self.instances[instance].members.get(word) else {
                self.unknown_name(scope, instance, word, reference);
                return None;
            };
            member = inner.clone();
            part = next;
        }
    }

    /// Subscripts affine in the counter: `stride*i + offset`, counted as written.
    pub(crate) fn affine(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Option<Index> {
        if !mentions_counter(expr, scope) {
            let value = self.structural_integer_in(scope, expr)?;
            return Some(Index::fixed(i32::try_from(value).unwrap_or(i32::MAX)));
        }
        match &expr.kind {
            ExprKind::Reference(_) => Some(Index {
                stride: 1,
                offset: 0,
            }),
            ExprKind::Unary(Unary::Negative, inner) => {
                let inner = self.affine(inner, scope)?;
                Some(Index {
                    stride: -inner.stride,
                    offset: -inner.offset,
                })
            }
            ExprKind::Binary(op @ (Binary::Add | Binary::Sub), a, b) => {
                let (a, b) = (self.affine(a, scope)?, self.affine(b, scope)?);
                let sign = if *op == Binary::Add { 1 } else { -1 };
                Some(Index {
                    stride: a.stride + sign * b.stride,
                    offset: a.offset + sign * b.offset,
                })
            }
            ExprKind::Binary(Binary::Mul, a, b) => {
                let (a, b) = (self.affine(a, scope)?, self.affine(b, scope)?);
                match (a.stride, b.stride) {
                    (0, _) => Some(Index {
                        stride: a.offset * b.stride,
                        offset: a.offset * b.offset,
                    }),
                    (_, 0) => Some(Index {
                        stride: b.offset * a.stride,
                        offset: b.offset * a.offset,
                    }),
                    _ => {
                        self.needs_unrolling = true;
                        None
                    }
                }
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..) => {
                self.needs_unrolling = true;
                None
            }
        }
    }

    /// The text of a unit that cannot be read, reported.
    pub(crate) fn bad_unit(&mut self, unit: &UnitText, error: &UnitError) {
        let start = unit.span.start as usize + error.at.start;
        let end = unit.span.start as usize + error.at.end.max(error.at.start + 1);
        let span = Span::new(
            unit.span.file,
            start,
            end.min(unit.span.end as usize).max(start),
        );
        let diagnostic = Diagnostic::error(Code::BadUnit, error.fact()).label(span, "in this unit");
        self.report(match error.help() {
            Some(help) => diagnostic.help(help),
            None => diagnostic,
        });
    }

    fn number(&mut self, value: f64, unit: Option<&UnitText>, span: Span) -> Typed {
        let Some(text) = unit else {
            let id = self.flat.exprs.constant(value);
            let dim = if value == 0.0 { Dim::Any } else { Dim::NUMBER };
            return Typed {
                bare: true,
                ..self.typed(id, dim, span)
            };
        };
        match NamedUnit::parse(&text.text) {
            Ok(unit) => {
                let unit = unit.unit();
                let id = self.flat.exprs.constant(unit.to_si(value));
                self.typed(id, Dim::known(unit.dimension), span)
            }
            Err(error) => {
                self.bad_unit(text, &error);
                self.poison(span)
            }
        }
    }

    fn reference(&mut self, reference: &'a Reference, scope: &Scope<'a>) -> Typed {
        let span = reference.span;
        let Some(resolved) = self.resolve(reference, scope) else {
            return self.poison(span);
        };
        match resolved {
            Resolved::Variable(var, index) => self.read(var, index, scope, span),
            Resolved::Parameter(param, index) => {
                let len = self.flat.parameters[param].len;
                let Some(index) = self.whole(index, len, scope, span) else {
                    return self.poison(span);
                };
                let notes = &self.parameters[param.index()];
                let (dim, truth) = (notes.dim.clone(), notes.boolean);
                let id = self.flat.exprs.add(Ir::Param(param, index));
                Typed {
                    truth,
                    ..self.typed(id, dim, span)
                }
            }
            Resolved::Counter(Counter::Symbolic) => {
                let id = self.flat.exprs.add(Ir::Counter);
                self.typed(id, Dim::NUMBER, span)
            }
            Resolved::Counter(Counter::Fixed(value)) => {
                let id = self.flat.exprs.constant(f64::from(value));
                self.typed(id, Dim::NUMBER, span)
            }
            Resolved::Time => {
                if scope.setting == Setting::Parameter {
                    self.not_constant("time", span);
                }
                let id = self.flat.exprs.add(Ir::Time);
                self.typed(id, Dim::known(hyde_units::Dimension::TIME), span)
            }
            Resolved::Pi => {
                let id = self.flat.exprs.constant(std::f64::consts::PI);
                Typed {
                    bare: true,
                    ..self.typed(id, Dim::neutral_number(), span)
                }
            }
            Resolved::Coordinate => self.coordinate_value(scope, span),
            Resolved::Instance(instance) => {
                let name = self.instances[instance].class.name.text.clone();
                self.report(
                    Diagnostic::error(
                        Code::WrongType,
                        format!(
                            "`{}` is a component ({name}), not a value",
                            reference.dotted()
                        ),
                    )
                    .label(span, "a component")
                    .help("name one of its variables: `motor.w`"),
                );
                self.poison(span)
            }
        }
    }

    /// A variable's value, with the borders of clocked parts checked.
    pub(crate) fn read(
        &mut self,
        var: VarId,
        index: Option<Index>,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        if scope.setting == Setting::Parameter {
            let name = self.flat.variables[var].name.clone();
            self.not_constant(&format!("`{name}`"), span);
            return self.poison(span);
        }
        if let (Some(field), None) = (self.notes(var).field, index) {
            return self.field_value(var, field, scope, span);
        }
        let len = self.flat.variables[var].len;
        let Some(index) = self.whole(index, len, scope, span) else {
            return self.poison(span);
        };
        self.check_border(var, scope, span);
        let id = self.flat.exprs.add(Ir::Var(var, index));
        let truth = self.flat.variables[var].boolean;
        Typed {
            truth,
            ..self.typed(id, self.dim(var), span)
        }
    }

    fn check_border(&mut self, var: VarId, scope: &Scope<'a>, span: Span) {
        let name = self.flat.variables[var].name.clone();
        match (self.flat.variables[var].kind, scope.setting) {
            (
                VariableKind::Clocked(_),
                Setting::Equation | Setting::Condition | Setting::Action,
            ) => self.report(
                Diagnostic::error(
                    Code::ClockBorder,
                    format!("`{name}` belongs to a clocked part"),
                )
                .label(span, "read by a continuous equation")
                .help(format!("hold it between ticks: `hold({name})`")),
            ),
            (
                VariableKind::Continuous
                | VariableKind::Discrete
                | VariableKind::Held(..)
                | VariableKind::Column(..),
                Setting::Clocked,
            ) => self.report(
                Diagnostic::error(Code::ClockBorder, format!("`{name}` is continuous"))
                    .label(span, "read in a clocked part")
                    .help(format!("read it at the tick: `sample({name})`")),
            ),
            _ => {}
        }
    }

    fn unary(&mut self, op: Unary, inner: &'a Expr, scope: &Scope<'a>, span: Span) -> Typed {
        match op {
            Unary::Not => {
                let condition = self.truth(inner, scope);
                let id = self.flat.exprs.unary(UnaryOp::Not, condition);
                Typed {
                    truth: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            Unary::Positive => Typed {
                span,
                ..self.value(inner, scope)
            },
            Unary::Negative => {
                let value = self.value(inner, scope);
                let id = self.flat.exprs.negative(value.id);
                Typed {
                    id,
                    span,
                    two_pi: false,
                    ..value
                }
            }
        }
    }

    fn binary(
        &mut self,
        op: Binary,
        left: &'a Expr,
        right: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        match op {
            Binary::And | Binary::Or => {
                let (a, b) = (self.truth(left, scope), self.truth(right, scope));
                let op = if op == Binary::And {
                    BinaryOp::And
                } else {
                    BinaryOp::Or
                };
                let id = self.flat.exprs.binary(op, a, b);
                Typed {
                    truth: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            Binary::Lt => self.comparison(BinaryOp::Lt, left, right, scope, span),
            Binary::Le => self.comparison(BinaryOp::Le, left, right, scope, span),
            Binary::Gt => self.comparison(BinaryOp::Gt, left, right, scope, span),
            Binary::Ge => self.comparison(BinaryOp::Ge, left, right, scope, span),
            Binary::Eq => self.comparison(BinaryOp::Eq, left, right, scope, span),
            Binary::Ne => self.comparison(BinaryOp::Ne, left, right, scope, span),
            Binary::Add | Binary::Sub => {
                let (a, b) = (self.value(left, scope), self.value(right, scope));
                let (ir, what) = if op == Binary::Add {
                    (BinaryOp::Add, "`+` adds")
                } else {
                    (BinaryOp::Sub, "`-` subtracts")
                };
                self.agree(&a, &b, what, scope.instance);
                let id = self.flat.exprs.binary(ir, a.id, b.id);
                Typed {
                    bare: a.bare && b.bare,
                    ..self.typed(id, sum_dim(&a.dim, &b.dim), span)
                }
            }
            Binary::Mul | Binary::Div => {
                let (a, b) = (self.value(left, scope), self.value(right, scope));
                self.doubtful_turns(&a, &b);
                let (ir, dim) = if op == Binary::Mul {
                    (BinaryOp::Mul, a.dim.multiply(&b.dim))
                } else {
                    (BinaryOp::Div, a.dim.divide(&b.dim))
                };
                let id = self.flat.exprs.binary(ir, a.id, b.id);
                let two_pi =
                    self.flat.exprs.is_constant(id, std::f64::consts::TAU) && a.bare && b.bare;
                Typed {
                    bare: a.bare && b.bare,
                    two_pi,
                    ..self.typed(id, dim, span)
                }
            }
            Binary::Pow => self.power(left, right, scope, span),
        }
    }

    fn comparison(
        &mut self,
        op: BinaryOp,
        left: &'a Expr,
        right: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let (a, b) = (self.lower(left, scope), self.lower(right, scope));
        self.same_kind(&a, &b);
        self.agree(&a, &b, "a comparison of", scope.instance);
        let continuous = matches!(scope.setting, Setting::Equation | Setting::Condition);
        if continuous
            && matches!(op, BinaryOp::Eq | BinaryOp::Ne)
            && (self.varies(a.id) || self.varies(b.id))
        {
            self.report(
                Diagnostic::error(Code::WrongType, "continuous values are hardly ever equal")
                    .label(span, "compares values that change continuously")
                    .help("compare with `<` or `>`"),
            );
        }
        let id = self.flat.exprs.binary(op, a.id, b.id);
        Typed {
            truth: true,
            ..self.typed(id, Dim::NUMBER, span)
        }
    }

    /// Whether an expression changes between events.
    fn varies(&self, id: hyde_ir::ExprId) -> bool {
        self.flat.exprs.any(id, |expr| match expr {
            Ir::Time | Ir::Der(..) => true,
            Ir::Var(var, _) => {
                let variable = &self.flat.variables[var];
                !variable.boolean
                    && matches!(
                        variable.kind,
                        VariableKind::Continuous | VariableKind::Column(..)
                    )
            }
            Ir::Const(_)
            | Ir::Counter
            | Ir::Param(..)
            | Ir::Pre(..)
            | Ir::Relation(_)
            | Ir::InMode(..)
            | Ir::Unary(..)
            | Ir::Binary(..)
            | Ir::If(..)
            | Ir::NoEvent(_) => false,
        })
    }

    fn power(&mut self, left: &'a Expr, right: &'a Expr, scope: &Scope<'a>, span: Span) -> Typed {
        let (a, b) = (self.value(left, scope), self.value(right, scope));
        let number = Typed {
            dim: Dim::NUMBER,
            ..b.clone()
        };
        self.agree(
            &b,
            &number,
            "an exponent is a pure number, not",
            scope.instance,
        );
        let id = self.flat.exprs.binary(BinaryOp::Pow, a.id, b.id);
        let exponent = self
            .flat
            .exprs
            .as_constant(b.id)
            .and_then(Exponent::from_f64);
        let dim = match exponent {
            Some(exponent) => a.dim.power(exponent),
            None => {
                let number = Typed {
                    dim: Dim::NUMBER,
                    ..a.clone()
                };
                self.agree(
                    &a,
                    &number,
                    "a power with a varying exponent has a pure number as its base, not",
                    scope.instance,
                );
                Some(Dim::NUMBER)
            }
        };
        let dim = dim.unwrap_or_else(|| {
            self.report(
                Diagnostic::error(
                    Code::UnitMismatch,
                    "a dimension to this power cannot be told exactly",
                )
                .label(span, "an exponent like 1/2 or 2/3 can"),
            );
            Dim::Any
        });
        Typed {
            bare: a.bare && b.bare,
            ..self.typed(id, dim, span)
        }
    }

    /// `2*pi` beside a quantity that is per angle already (U1).
    fn doubtful_turns(&mut self, a: &Typed, b: &Typed) {
        for (turn, other) in [(a, b), (b, a)] {
            let Some(dimension) = other.dim.as_known() else {
                continue;
            };
            let per_angle = matches!(dimension.angle(), AngleExponent::Known(e) if e.is_negative());
            if turn.two_pi && per_angle {
                self.report(
                    Diagnostic::warning(
                        Code::AngleMismatch,
                        "2*pi times a quantity that is per angle already",
                    )
                    .label(other.span, format!("this is {dimension}"))
                    .label(turn.span, "turns it once more")
                    .note("units like mm/rev are converted to m/rad as they are read")
                    .help("leave the `2*pi` out"),
                );
            }
        }
    }

    pub(crate) fn same_kind(&mut self, a: &Typed, b: &Typed) {
        if a.truth != b.truth && a.dim != Dim::Any && b.dim != Dim::Any {
            self.report(
                Diagnostic::error(Code::WrongType, "a truth and a number stand together")
                    .label(a.span, if a.truth { "true or false" } else { "a number" })
                    .label(b.span, if b.truth { "true or false" } else { "a number" }),
            );
        }
    }

    /// The element of a subscript, counted from 0; `Some(None)` where there is no subscript.
    fn element(
        &mut self,
        subscript: Option<&'a Expr>,
        len: Option<usize>,
        first: i32,
        scope: &Scope<'a>,
        reference: &Reference,
    ) -> Option<Option<Index>> {
        let Some(subscript) = subscript else {
            return Some(None);
        };
        let Some(len) = len else {
            self.not_an_array(reference);
            return None;
        };
        if len == 0 && self.diagnostics.has_errors() {
            return None; // Its length is the mistake.
        }
        let written = self.affine(subscript, scope)?;
        let index = Index {
            stride: written.stride,
            offset: written.offset - first,
        };
        let inside = usize::try_from(index.offset).is_ok_and(|at| at < len);
        if index.stride == 0 && !inside {
            let last = i64::from(first) + i64::try_from(len).unwrap_or(0) - 1;
            self.report(
                Diagnostic::error(
                    Code::BadShape,
                    format!("`{}` has elements {first} to {last}", reference.dotted()),
                )
                .label(subscript.span, format!("element {}", written.offset)),
            );
            return None;
        }
        Some(Some(index))
    }

    /// The element a whole array means in an array equation; an error where one value is expected.
    fn whole(
        &mut self,
        index: Option<Index>,
        len: Option<usize>,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<Index> {
        match (index, len, scope.elementwise) {
            (Some(index), ..) => Some(index),
            (None, None, _) => Some(Index::SCALAR),
            (None, Some(len), Some(expected)) if len == expected => Some(Index {
                stride: 1,
                offset: 0,
            }),
            (None, Some(len), Some(expected)) => {
                self.report(
                    Diagnostic::error(
                        Code::BadShape,
                        format!("an array of {len} stands beside arrays of {expected}"),
                    )
                    .label(span, format!("has {len} elements")),
                );
                None
            }
            (None, Some(len), None) => {
                self.report(
                    Diagnostic::error(
                        Code::BadShape,
                        "an array stands where one value is expected",
                    )
                    .label(span, format!("has {len} elements"))
                    .help("name an element, `x[1]`, or sum them, `sum(x)`"),
                );
                None
            }
        }
    }

    fn one_of(
        &mut self,
        list: &[InstanceId],
        subscript: Option<&'a Expr>,
        scope: &Scope<'a>,
        reference: &Reference,
    ) -> Option<InstanceId> {
        let Some(subscript) = subscript else {
            self.report(
                Diagnostic::error(
                    Code::BadShape,
                    format!(
                        "`{}` is an array of {} components",
                        reference.dotted(),
                        list.len()
                    ),
                )
                .label(reference.span, "which one?")
                .help(format!("name one: `{}[1]`", reference.dotted())),
            );
            return None;
        };
        if mentions_counter(subscript, scope) {
            self.needs_unrolling = true;
            return None;
        }
        let number = self.structural_integer_in(scope, subscript)?;
        let found = usize::try_from(number - 1)
            .ok()
            .and_then(|at| list.get(at))
            .copied();
        if found.is_none() {
            self.report(
                Diagnostic::error(
                    Code::BadShape,
                    format!("there are components 1 to {}", list.len()),
                )
                .label(subscript.span, format!("component {number}")),
            );
        }
        found
    }

    fn last(&mut self, rest: Option<&hyde_syntax::ast::Part>, reference: &Reference) -> bool {
        let Some(part) = rest else { return true };
        self.report(
            Diagnostic::error(
                Code::UnknownName,
                format!(
                    "`{}` has no `{}`: it is no component",
                    reference.dotted(),
                    part.name.text
                ),
            )
            .label(part.name.span, "nothing is below a value"),
        );
        false
    }

    fn not_an_array(&mut self, reference: &Reference) {
        self.report(
            Diagnostic::error(
                Code::BadShape,
                format!("`{}` is no array", reference.dotted()),
            )
            .label(reference.span, "has no elements"),
        );
    }

    pub(crate) fn not_constant(&mut self, what: &str, span: Span) {
        self.report(
            Diagnostic::error(Code::NotConstant, format!("{what} changes during the run"))
                .label(span, "only numbers and parameters may stand here"),
        );
    }

    /// The name of the coordinate where a field expression is being lowered.
    fn coordinate(&self, scope: &Scope<'a>) -> Option<&'a str> {
        match scope.place {
            FieldPlace::Nowhere => None,
            FieldPlace::Node(domain, _) | FieldPlace::Cell(domain, _) => {
                (self.domains[domain].instance == scope.instance)
                    .then(|| self.domains[domain].coordinate)
            }
        }
    }
}

/// The dimension of a sum: that of the side which has one; angle-neutral if a side is.
pub(crate) fn sum_dim(a: &Dim, b: &Dim) -> Dim {
    match (a, b) {
        (Dim::Any, other) | (other, Dim::Any) => other.clone(),
        (Dim::Of(..), Dim::Of(..)) => {
            let neutral = b
                .as_known()
                .is_some_and(|dimension| dimension.angle() == AngleExponent::Neutral);
            if neutral || a.as_known().is_none() {
                b.clone()
            } else {
                a.clone()
            }
        }
    }
}

fn is_symbolic_counter(reference: &Reference, scope: &Scope<'_>) -> bool {
    let Some(word) = reference.as_word() else {
        return false;
    };
    let counter = scope.counters.iter().rev().find(|(name, _)| *name == word);
    matches!(counter, Some((_, Counter::Symbolic)))
}

/// Whether an expression depends on the counter of a range equation.
pub(crate) fn mentions_counter(expr: &Expr, scope: &Scope<'_>) -> bool {
    expr.any(&|expr| {
        matches!(&expr.kind, ExprKind::Reference(reference) if is_symbolic_counter(reference, scope))
    })
}
