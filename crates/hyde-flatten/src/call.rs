//! Calls: the functions of the language, each with what it demands of its arguments.

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::lower::{Resolved, sum_dim};
use crate::model::Model;
use crate::names::nearest;
use hyde_diag::{Code, Diagnostic, MadeBy, Span};
use hyde_ir::flat::{ClockedEquation, Equation, Reduction, ReductionKind};
use hyde_ir::{
    BinaryOp, ClockId, Expr as Ir, ExprId, Id as _, Index, Range, UnaryOp, VarId, VariableKind,
};
use hyde_syntax::ast::{Argument, Expr, ExprKind, Reference};
use hyde_units::{Dimension, Exponent};

/// Functions of one pure number.
const OF_NUMBER: [(&str, UnaryOp); 9] = [
    ("exp", UnaryOp::Exp),
    ("log", UnaryOp::Log),
    ("log10", UnaryOp::Log10),
    ("sinh", UnaryOp::Sinh),
    ("cosh", UnaryOp::Cosh),
    ("tanh", UnaryOp::Tanh),
    ("asin", UnaryOp::Asin),
    ("acos", UnaryOp::Acos),
    ("atan", UnaryOp::Atan),
];
/// Functions of an angle.
const OF_ANGLE: [(&str, UnaryOp); 3] = [
    ("sin", UnaryOp::Sin),
    ("cos", UnaryOp::Cos),
    ("tan", UnaryOp::Tan),
];

/// Every function name, for near misses.
const ALL: [&str; 43] = [
    "der", "pre", "sample", "hold", "interval", "abs", "sign", "sqrt", "exp", "log", "log10",
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "min", "max",
    "floor", "ceil", "mod", "floor_to", "round_to", "clamp", "noEvent", "smooth", "pder",
    "partial", "sum", "chirp", "rms", "mean", "first", "last", "lowpass", "slope", "held",
    "integer",
];

/// How a function is called, for the repair of a call with the wrong arguments.
fn usage(name: &str) -> Option<&'static str> {
    Some(match name {
        "der" | "abs" | "sign" | "sqrt" | "exp" | "log" | "log10" | "sin" | "cos" | "tan"
        | "asin" | "acos" | "atan" | "sinh" | "cosh" | "tanh" | "floor" | "ceil" | "integer"
        | "noEvent" | "sum" => return None,
        "pre" => "pre(x)",
        "sample" => "sample(x)",
        "hold" => "hold(u)",
        "held" => "held(file.column)",
        "interval" => "interval()",
        "smooth" => "smooth(order, expression)",
        "mod" => "mod(x, period)",
        "floor_to" => "floor_to(x, step)",
        "round_to" => "round_to(x, step)",
        "min" => "min(a, b)",
        "max" => "max(a, b)",
        "clamp" => "clamp(x, low, high)",
        "atan2" => "atan2(y, x)",
        "chirp" => "chirp(time, from, to, duration)",
        "pder" => "pder(field, x)",
        "partial" => "partial(expression, variable)",
        _ => return None,
    })
}

impl<'a> Model<'a, '_> {
    /// Lowers `function(arguments)`.
    pub(crate) fn call(
        &mut self,
        function: &'a Reference,
        arguments: &'a [Argument],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let Some(name) = function.as_word() else {
            return self.method(function, arguments, scope, span);
        };
        if let Some(argument) = arguments.iter().find(|argument| argument.name.is_some()) {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` takes no named arguments"),
                )
                .label(argument.value.span, "named")
                .help("give the arguments in their order, without names"),
            );
            return self.poison(span);
        }
        let args: Vec<&'a Expr> = arguments.iter().map(|argument| &argument.value).collect();
        if let Some((_, op)) = OF_NUMBER.iter().find(|(known, _)| *known == name) {
            let Some([a]) = self.exactly(name, &args, span) else {
                return self.poison(span);
            };
            let a = self.value(a, scope);
            let number = Typed {
                dim: Dim::NUMBER,
                ..a.clone()
            };
            self.agree(
                &a,
                &number,
                "the function takes a pure number, this relates",
                scope.instance,
            );
            let id = self.flat.exprs.unary(*op, a.id);
            let angle = matches!(op, UnaryOp::Asin | UnaryOp::Acos | UnaryOp::Atan);
            let dim = if angle {
                Dim::neutral_number()
            } else {
                Dim::NUMBER
            };
            return self.typed(id, dim, span);
        }
        if let Some((_, op)) = OF_ANGLE.iter().find(|(known, _)| *known == name) {
            let Some([a]) = self.exactly(name, &args, span) else {
                return self.poison(span);
            };
            let a = self.value(a, scope);
            if !a.bare {
                let angle = Typed {
                    dim: Dim::known(Dimension::ANGLE),
                    ..a.clone()
                };
                self.agree(
                    &a,
                    &angle,
                    "the function takes an angle, this relates",
                    scope.instance,
                );
            }
            let id = self.flat.exprs.unary(*op, a.id);
            return self.typed(id, Dim::NUMBER, span);
        }
        match name {
            "der" => self.der(&args, scope, span),
            "pre" => self.pre(&args, scope, span),
            "sample" => self.sample(&args, scope, span),
            "hold" => self.hold(&args, scope, span),
            "held" => self.held_column(&args, scope, span),
            "interval" => self.interval(&args, scope, span),
            "noEvent" => match self.exactly(name, &args, span) {
                Some([a]) => self.without_events(a, scope, span),
                None => self.poison(span),
            },
            "smooth" => match self.exactly(name, &args, span) {
                Some([_, a]) => self.without_events(a, scope, span),
                None => self.poison(span),
            },
            "abs" | "sign" | "sqrt" => self.of_value(name, &args, scope, span),
            "floor" | "ceil" | "integer" | "mod" | "floor_to" | "round_to" => {
                self.quantiser(name, &args, scope, span)
            }
            "min" | "max" if args.len() == 2 => self.extremum(name == "min", &args, scope, span),
            "max" | "min" | "rms" | "mean" | "first" | "last" => {
                self.reduction(name, &args, scope, span)
            }
            "clamp" => self.clamp(&args, scope, span),
            "atan2" => match self.exactly(name, &args, span) {
                Some([a, b]) => {
                    let (a, b) = (self.value(a, scope), self.value(b, scope));
                    self.agree(&a, &b, "`atan2` compares", scope.instance);
                    let id = self.flat.exprs.binary(BinaryOp::Atan2, a.id, b.id);
                    self.typed(id, Dim::neutral_number(), span)
                }
                None => self.poison(span),
            },
            "sum" => self.sum(&args, scope, span),
            "chirp" => self.chirp(&args, scope, span),
            "pder" => self.pder(&args, scope, span),
            "partial" => self.partial(&args, scope, span),
            _ => {
                let diagnostic = Diagnostic::error(
                    Code::UnknownFunction,
                    format!("no function is called `{name}`"),
                )
                .label(function.span, "not known");
                let near = nearest(name, ALL.iter().copied());
                self.report(match near {
                    Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                    None => diagnostic,
                });
                self.poison(span)
            }
        }
    }

    /// `th.at(x)`
    fn method(
        &mut self,
        function: &'a Reference,
        arguments: &'a [Argument],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let last = function
            .parts
            .last()
            .map_or("", |part| part.name.text.as_str());
        if let ("at", [argument]) = (last, arguments) {
            return self.field_at(function, &argument.value, scope, span);
        }
        self.report(
            Diagnostic::error(
                Code::UnknownFunction,
                format!("no function is called `{}`", function.dotted()),
            )
            .label(function.span, "not known")
            .help("a field is read at a place with `field.at(x)`"),
        );
        self.poison(span)
    }

    /// `der(e)`: of a variable its derivative, of an expression the derivative by the chain rule.
    fn der(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("der", args, span) else {
            return self.poison(span);
        };
        if matches!(scope.setting, Setting::Clocked | Setting::Parameter) {
            self.report(
                Diagnostic::error(Code::ClockBorder, "no derivative exists here")
                    .label(
                        span,
                        if scope.setting == Setting::Clocked {
                            "in a clocked part"
                        } else {
                            "of a parameter"
                        },
                    )
                    .help("in a clocked part take a difference: `(x - pre(x))/interval()`"),
            );
            return self.poison(span);
        }
        let inner = self.value(a, scope);
        let dim = inner.dim.divide(&Dim::known(Dimension::TIME));
        let id = self.time_derivative(inner.id, span);
        self.typed(id, dim, span)
    }

    pub(crate) fn time_derivative(&mut self, id: ExprId, span: Span) -> ExprId {
        let mut second = false;
        let variables = &self.flat.variables;
        let arena = &mut self.flat.exprs;
        let result = arena.tangent(id, |arena, leaf| match leaf {
            Ir::Var(var, index) => match variables[var].kind {
                VariableKind::Continuous | VariableKind::Column(..) => {
                    Some(arena.add(Ir::Der(var, index)))
                }
                VariableKind::Discrete
                | VariableKind::Clocked(_)
                | VariableKind::Held(..)
                | VariableKind::Reduction(_) => None,
            },
            Ir::Time => Some(arena.constant(1.0)),
            Ir::Der(..) => {
                second = true;
                None
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
            | Ir::NoEvent(_) => None,
        });
        if second {
            self.report(
                Diagnostic::error(Code::BadArguments, "the derivative of a derivative")
                    .label(span, "needs a name for the first derivative")
                    .help("declare it: `Velocity v = der(s);` and write `der(v)`"),
            );
        }
        result
    }

    /// `pre(x)`: in a clocked part the value at the last tick, in an event the value before it.
    fn pre(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("pre", args, span) else {
            return self.poison(span);
        };
        let ExprKind::Reference(reference) = &a.kind else {
            self.report(
                Diagnostic::error(Code::BadArguments, "`pre` takes a variable")
                    .label(a.span, "an expression"),
            );
            return self.poison(span);
        };
        let inner = self.value(a, &scope.with(Setting::Report));
        let Ir::Var(var, index) = self.flat.exprs[inner.id] else {
            return self.poison(span);
        };
        let allowed = match (self.flat.variables[var].kind, scope.setting) {
            (VariableKind::Clocked(clock), Setting::Clocked) => {
                Some(clock) == self.instances[scope.instance].clock
            }
            (VariableKind::Discrete, Setting::Action | Setting::Condition | Setting::Equation) => {
                true
            }
            (VariableKind::Continuous, Setting::Action) => true,
            _ => false,
        };
        if !allowed {
            self.report(
                Diagnostic::error(Code::ClockBorder, format!("`pre({})` has no meaning here", reference.dotted()))
                    .label(span, "there is no value before")
                    .help("`pre` takes a variable of the same clocked part, or a discrete one at an event"),
            );
        }
        let id = self.flat.exprs.add(Ir::Pre(var, index));
        self.typed(id, inner.dim, span)
    }

    /// `sample(e)`: a continuous expression read at the tick.
    fn sample(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("sample", args, span) else {
            return self.poison(span);
        };
        if scope.setting != Setting::Clocked {
            self.report(
                Diagnostic::error(Code::ClockBorder, "`sample` outside a clocked part")
                    .label(span, "there is no clock here")
                    .help("`sample` brings a continuous value into `clocked … end`"),
            );
            return self.poison(span);
        }
        let inner = self.lower(a, &scope.with(Setting::Report));
        if let Some(clock) = self.clocks_of(inner.id).first().copied() {
            let name = self.flat.clocks[clock].name.clone();
            self.report(
                Diagnostic::error(
                    Code::ClockBorder,
                    format!("what is sampled belongs to the clocked part `{name}`"),
                )
                .label(a.span, "clocked already")
                .help("read it without `sample`"),
            );
        }
        Typed {
            span,
            bare: false,
            two_pi: false,
            ..inner
        }
    }

    /// `hold(e)`: a clocked value between its ticks.
    fn hold(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("hold", args, span) else {
            return self.poison(span);
        };
        if matches!(scope.setting, Setting::Clocked | Setting::Parameter) {
            self.report(
                Diagnostic::error(Code::ClockBorder, "`hold` inside a clocked part")
                    .label(span, "nothing to hold here")
                    .help("read the variable of the other clocked part directly"),
            );
            return self.poison(span);
        }
        let inner = self.value(a, &scope.with(Setting::Clocked));
        let clocks = self.clocks_of(inner.id);
        let [clock] = clocks.as_slice() else {
            self.report(
                Diagnostic::error(
                    Code::ClockBorder,
                    "`hold` takes a value of one clocked part",
                )
                .label(a.span, format!("belongs to {}", clocks.len()))
                .help("hold each value apart"),
            );
            return self.poison(span);
        };
        let clock = *clock;
        let source = if let Ir::Var(var, Index::SCALAR) = self.flat.exprs[inner.id]
            && self.flat.variables[var].len.is_none()
        {
            var
        } else {
            self.clocked_part_of(clock, a, &inner, scope, span)
        };
        let held = match self.held.get(&(clock, source)) {
            Some(&held) => held,
            None => {
                let name = format!("hold({})", self.flat.variables[source].name);
                let kind = VariableKind::Held(clock, source);
                let held = self.add_variable(
                    scope.instance,
                    name,
                    kind,
                    inner.dim.clone(),
                    span,
                    MadeBy::Source,
                );
                self.held.insert((clock, source), held);
                held
            }
        };
        let id = self.flat.exprs.var(held);
        self.typed(id, inner.dim, span)
    }

    /// A clocked variable for an expression that is held.
    fn clocked_part_of(
        &mut self,
        clock: ClockId,
        written: &Expr,
        value: &Typed,
        scope: &Scope<'a>,
        span: Span,
    ) -> VarId {
        let name = format!(
            "{}.({})",
            self.flat.clocks[clock].name,
            hyde_syntax::format_expression(written)
        );
        let kind = VariableKind::Clocked(clock);
        let var = self.add_variable(
            scope.instance,
            name,
            kind,
            value.dim.clone(),
            span,
            MadeBy::Source,
        );
        let lhs = self.flat.exprs.var(var);
        let origin = self.origin(scope.instance, span);
        let equation = Equation {
            range: Range::SCALAR,
            lhs,
            rhs: value.id,
            origin,
        };
        self.flat
            .clocked_equations
            .push(ClockedEquation { clock, equation });
        var
    }

    /// The clocks of the variables in an expression, each once.
    pub(crate) fn clocks_of(&self, id: ExprId) -> Vec<ClockId> {
        let mut clocks = Vec::new();
        for id in self.flat.exprs.below(&[id]) {
            if let Ir::Var(var, _) | Ir::Pre(var, _) = self.flat.exprs[id]
                && let VariableKind::Clocked(clock) = self.flat.variables[var].kind
                && !clocks.contains(&clock)
            {
                clocks.push(clock);
            }
        }
        clocks
    }

    /// `held(file.r)`: a record's column held between rows, where it would be read linearly.
    fn held_column(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("held", args, span) else {
            return self.poison(span);
        };
        let inner = self.value(a, scope);
        if let Ir::Var(var, _) = self.flat.exprs[inner.id]
            && let VariableKind::Column(column, _) = self.flat.variables[var].kind
            && let Some((_, held)) = self.column_variables.get(&column)
        {
            let id = self.flat.exprs.var(*held);
            return self.typed(id, inner.dim, span);
        }
        self.report(
            Diagnostic::error(Code::BadArguments, "`held` takes a column of a record")
                .label(a.span, "no column")
                .help("a clocked value is held with `hold`"),
        );
        self.poison(span)
    }

    /// `interval()`: the period of the clocked part.
    fn interval(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([]) = self.exactly("interval", args, span) else {
            return self.poison(span);
        };
        match self.instances[scope.instance].clock {
            Some(clock) if scope.setting == Setting::Clocked => {
                let id = self.flat.clocks[clock].period;
                self.typed(id, Dim::known(Dimension::TIME), span)
            }
            _ => {
                self.report(
                    Diagnostic::error(Code::ClockBorder, "`interval()` outside a clocked part")
                        .label(span, "there is no clock here"),
                );
                self.poison(span)
            }
        }
    }

    fn of_value(&mut self, name: &str, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly(name, args, span) else {
            return self.poison(span);
        };
        let a = self.value(a, scope);
        let arena = &mut self.flat.exprs;
        let zero = arena.constant(0.0);
        let (id, dim) = match name {
            "sqrt" => (
                arena.unary(UnaryOp::Sqrt, a.id),
                a.dim.power(Exponent::HALF).unwrap_or(Dim::Any),
            ),
            "sign" => {
                let (one, minus) = (arena.constant(1.0), arena.constant(-1.0));
                let above = arena.binary(BinaryOp::Gt, a.id, zero);
                let below = arena.binary(BinaryOp::Lt, a.id, zero);
                let rest = arena.if_else(below, minus, zero);
                (arena.if_else(above, one, rest), Dim::NUMBER)
            }
            // An event where the argument changes its sign: the derivative jumps there.
            _ if scope.setting == Setting::Equation => {
                let below = arena.binary(BinaryOp::Lt, a.id, zero);
                let negative = arena.negative(a.id);
                (arena.if_else(below, negative, a.id), a.dim.clone())
            }
            _ => (arena.unary(UnaryOp::Abs, a.id), a.dim.clone()),
        };
        self.typed(id, dim, span)
    }

    /// Rounding, allowed where values are sampled or measured (C5).
    fn quantiser(&mut self, name: &str, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        if matches!(scope.setting, Setting::Equation | Setting::Condition) {
            self.report(
                Diagnostic::error(Code::QuantiserOnContinuous, format!("`{name}` on a continuous value"))
                    .label(span, "every step of it would be an event, thousands a second")
                    .help(format!("quantise where it is read: `{name}(sample(…), …)` in a clocked part, or in `measured`")),
            );
        }
        let operands = if matches!(name, "floor" | "ceil" | "integer") {
            let one = self.exactly(name, args, span);
            one.map(|[a]| (self.value(a, scope), self.number_one(span)))
        } else {
            let two = self.exactly(name, args, span);
            two.map(|[a, b]| (self.value(a, scope), self.value(b, scope)))
        };
        let Some((a, b)) = operands else {
            return self.poison(span);
        };
        self.agree(&a, &b, "the step and the value are", scope.instance);
        let arena = &mut self.flat.exprs;
        let id = match name {
            "floor" | "integer" => arena.unary(UnaryOp::Floor, a.id),
            "ceil" => arena.unary(UnaryOp::Ceil, a.id),
            "floor_to" => arena.binary(BinaryOp::FloorTo, a.id, b.id),
            "round_to" => arena.binary(BinaryOp::RoundTo, a.id, b.id),
            _ => {
                let quotient = arena.over(a.id, b.id);
                let whole = arena.unary(UnaryOp::Floor, quotient);
                let part = arena.times(whole, b.id);
                arena.minus(a.id, part)
            }
        };
        self.typed(id, a.dim, span)
    }

    fn without_events(&mut self, a: &'a Expr, scope: &Scope<'a>, span: Span) -> Typed {
        let a = self.lower(a, scope);
        Typed {
            id: self.flat.exprs.no_event(a.id),
            span,
            ..a
        }
    }

    fn number_one(&mut self, span: Span) -> Typed {
        let id = self.flat.exprs.constant(1.0);
        Typed {
            bare: true,
            ..self.typed(id, Dim::NUMBER, span)
        }
    }

    fn extremum(&mut self, least: bool, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a, b]) = self.exactly(if least { "min" } else { "max" }, args, span) else {
            return self.poison(span);
        };
        let (a, b) = (self.value(a, scope), self.value(b, scope));
        self.agree(
            &a,
            &b,
            if least {
                "`min` compares"
            } else {
                "`max` compares"
            },
            scope.instance,
        );
        let id = self.choose(least, a.id, b.id, scope.setting);
        self.typed(id, sum_dim(&a.dim, &b.dim), span)
    }

    /// The lesser or greater of two; in a continuous equation the change from one to the other is an event.
    fn choose(&mut self, least: bool, a: ExprId, b: ExprId, setting: Setting) -> ExprId {
        let arena = &mut self.flat.exprs;
        if setting == Setting::Equation {
            let second = arena.binary(if least { BinaryOp::Lt } else { BinaryOp::Gt }, b, a);
            return arena.if_else(second, b, a);
        }
        arena.binary(if least { BinaryOp::Min } else { BinaryOp::Max }, a, b)
    }

    fn clamp(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([x, low, high]) = self.exactly("clamp", args, span) else {
            return self.poison(span);
        };
        let (x, low, high) = (
            self.value(x, scope),
            self.value(low, scope),
            self.value(high, scope),
        );
        self.agree(&x, &low, "`clamp` compares", scope.instance);
        self.agree(&x, &high, "`clamp` compares", scope.instance);
        let below = self.choose(false, x.id, low.id, scope.setting);
        let id = self.choose(true, below, high.id, scope.setting);
        self.typed(id, sum_dim(&x.dim, &low.dim), span)
    }

    fn sum(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("sum", args, span) else {
            return self.poison(span);
        };
        let Some(len) = self.array_length(a, scope) else {
            self.report(
                Diagnostic::error(Code::BadShape, "`sum` takes an array")
                    .label(a.span, "one value"),
            );
            return self.poison(span);
        };
        if len > 64 {
            self.report(
                Diagnostic::error(
                    Code::NotYet,
                    "`sum` over more than 64 elements in this version",
                )
                .label(a.span, format!("has {len} elements")),
            );
            return self.poison(span);
        }
        let inner = self.value(
            a,
            &Scope {
                elementwise: Some(len),
                ..scope.clone()
            },
        );
        let mut total = self.flat.exprs.constant(0.0);
        for element in 0..len {
            let term = self.element_of(inner.id, element);
            total = self.flat.exprs.plus(total, term);
        }
        self.typed(total, inner.dim, span)
    }

    /// An array expression at one value of its counter.
    pub(crate) fn element_of(&mut self, id: ExprId, element: usize) -> ExprId {
        let at = i32::try_from(element).unwrap_or(i32::MAX);
        self.flat.exprs.at_counter(id, at)
    }

    /// `chirp(t, f0, f1, T)`: a sine whose frequency rises from f0 to f1 within T, `sin(2 pi (f0 t + (f1 - f0)/(2 T) t^2))`.
    fn chirp(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([t, from, to, over]) = self.exactly("chirp", args, span) else {
            return self.poison(span);
        };
        let (t, from) = (self.value(t, scope), self.value(from, scope));
        let (to, over) = (self.value(to, scope), self.value(over, scope));
        let time = Typed {
            dim: Dim::known(Dimension::TIME),
            ..t.clone()
        };
        self.agree(
            &t,
            &time,
            "a chirp runs over time, this relates",
            scope.instance,
        );
        self.agree(
            &over,
            &time,
            "a chirp lasts a time, this relates",
            scope.instance,
        );
        self.agree(&from, &to, "the two frequencies are", scope.instance);
        let rate = Typed {
            dim: Dim::NUMBER.divide(&time.dim),
            ..from.clone()
        };
        self.agree(
            &from,
            &rate,
            "a chirp starts at a frequency, this relates",
            scope.instance,
        );
        let arena = &mut self.flat.exprs;
        let rise = arena.minus(to.id, from.id);
        let twice = arena.plus(over.id, over.id);
        let slope = arena.over(rise, twice);
        let square = arena.times(t.id, t.id);
        let (linear, bent) = (arena.times(from.id, t.id), arena.times(slope, square));
        let turns = arena.plus(linear, bent);
        let tau = arena.constant(std::f64::consts::TAU);
        let angle = arena.times(tau, turns);
        let id = arena.unary(UnaryOp::Sin, angle);
        self.typed(id, Dim::NUMBER, span)
    }

    /// `partial(e, v)`: the derivative of e by the variable v; variables with a declared value count as that value.
    fn partial(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([e, by]) = self.exactly("partial", args, span) else {
            return self.poison(span);
        };
        let ExprKind::Reference(name) = &by.kind else {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    "the second argument of `partial` is a variable",
                )
                .label(by.span, "an expression"),
            );
            return self.poison(span);
        };
        let Some(Resolved::Variable(var, index)) = self.resolve(name, scope) else {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    "the second argument of `partial` is a variable",
                )
                .label(by.span, "no variable"),
            );
            return self.poison(span);
        };
        let index = index.unwrap_or_default();
        let value = self.value(e, scope);
        let expanded = self.expand_bindings(value.id, var, 0);
        let one = self.flat.exprs.constant(1.0);
        let id = self.flat.exprs.tangent(expanded, |_, leaf| {
            (leaf == Ir::Var(var, index)).then_some(one)
        });
        let dim = value.dim.divide(&self.dim(var));
        self.typed(id, dim, span)
    }

    /// Variables with a declared value replaced by it, down to `keep`.
    fn expand_bindings(&mut self, id: ExprId, keep: VarId, depth: usize) -> ExprId {
        let mut memo = std::collections::HashMap::new();
        for inner in self.flat.exprs.below(&[id]) {
            let Ir::Var(var, Index::SCALAR) = self.flat.exprs[inner] else {
                continue;
            };
            let notes = &self.variables[var.index()];
            let Some(binding) = notes.binding else {
                continue;
            };
            if var == keep || depth > 40 || self.flat.variables[var].len.is_some() {
                continue;
            }
            let scope = binding.scope_for(Setting::Equation);
            let value = self.value(binding.expr, &scope);
            let value = self.expand_bindings(value.id, keep, depth + 1);
            memo.insert(inner, value);
        }
        self.flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
    }

    /// A reduction of a signal over the run, in a measure or expectation.
    fn reduction(&mut self, name: &str, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly(name, args, span) else {
            return self.poison(span);
        };
        if scope.setting != Setting::Measure {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` of one value has a meaning over a whole run only"),
                )
                .label(span, "not in a measure or expectation")
                .help("write it in `measure` or `expect`"),
            );
            return self.poison(span);
        }
        let kind = match name {
            "max" => ReductionKind::Max,
            "min" => ReductionKind::Min,
            "rms" => ReductionKind::Rms,
            "mean" => ReductionKind::Mean,
            "first" => ReductionKind::First,
            _ => ReductionKind::Last,
        };
        let inner = self.value(a, &scope.with(Setting::Report));
        let number = self.flat.experiment.reductions.len();
        let text = format!("{name}({})", hyde_syntax::format_expression(a));
        let var = self.add_variable(
            scope.instance,
            text,
            VariableKind::Reduction(number),
            inner.dim.clone(),
            span,
            MadeBy::Experiment,
        );
        self.flat.experiment.reductions.push(Reduction {
            kind,
            value: inner.id,
            var,
        });
        let id = self.flat.exprs.var(var);
        self.typed(id, inner.dim, span)
    }

    /// The arguments, if there are as many as the function takes.
    pub(crate) fn exactly<const N: usize>(
        &mut self,
        name: &str,
        args: &[&'a Expr],
        span: Span,
    ) -> Option<[&'a Expr; N]> {
        let found = <[&'a Expr; N]>::try_from(args).ok();
        if found.is_none() {
            let plural = if N == 1 { "" } else { "s" };
            let diagnostic = Diagnostic::error(
                Code::BadArguments,
                format!("`{name}` takes {N} argument{plural}, not {}", args.len()),
            )
            .label(span, "called here");
            self.report(match usage(name) {
                Some(usage) => diagnostic.help(format!("write `{usage}`")),
                None => diagnostic,
            });
        }
        found
    }
}
