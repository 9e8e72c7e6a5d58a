//! Calls: the functions of the language, each with what it demands of its arguments.

mod calls;
mod chirp;
mod clock;
pub(crate) mod delay;
mod derivative;
mod edge;
mod extremum;
mod function;
mod quantiser;
mod reduction;
mod sum;
mod table;

pub(crate) use calls::Calls;
pub(crate) use clock::clocks_of;

use crate::dimension::Dim;
use crate::instance::{Member, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use crate::zero::Zero;
use hyde_diag::Span;
use hyde_ir::{BinaryOp, UnaryOp};
use hyde_syntax::ast::{Argument, Expr, Reference};
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

/// The names of the functions of the language.
pub const FUNCTIONS: [&str; 50] = [
    "der",
    "pre",
    "sample",
    "hold",
    "interval",
    "delay",
    "edge",
    "abs",
    "sign",
    "sqrt",
    "exp",
    "log",
    "log10",
    "sin",
    "cos",
    "tan",
    "asin",
    "acos",
    "atan",
    "atan2",
    "sinh",
    "cosh",
    "tanh",
    "min",
    "max",
    "floor",
    "ceil",
    "mod",
    "floor_to",
    "round_to",
    "clamp",
    "noEvent",
    "smooth",
    "pder",
    "integral",
    "partial",
    "sum",
    "chirp",
    "rms",
    "mean",
    "first",
    "last",
    "settling",
    "resonance",
    "lowpass",
    "slope",
    "held",
    "integer",
    "table",
    "smooth_table",
];

/// How a function of the language is called; nothing of those with one plain argument.
#[must_use]
pub fn usage(name: &str) -> Option<&'static str> {
    Some(match name {
        "der" => "der(x)",
        "abs" => "abs(x)",
        "sign" => "sign(x)",
        "sqrt" => "sqrt(x)",
        "exp" => "exp(x)",
        "log" => "log(x)",
        "log10" => "log10(x)",
        "sin" => "sin(x)",
        "cos" => "cos(x)",
        "tan" => "tan(x)",
        "asin" => "asin(x)",
        "acos" => "acos(x)",
        "atan" => "atan(x)",
        "sinh" => "sinh(x)",
        "cosh" => "cosh(x)",
        "tanh" => "tanh(x)",
        "floor" => "floor(x)",
        "ceil" => "ceil(x)",
        "integer" => "integer(x)",
        "noEvent" => "noEvent(x)",
        "sum" => "sum(x)",
        "pre" => "pre(x)",
        "sample" => "sample(x)",
        "hold" => "hold(u)",
        "held" => "held(file.column)",
        "interval" => "interval()",
        "delay" => "delay(u, T)",
        "edge" => "edge(b)",
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
        "integral" => "integral(expression, domain)",
        "settling" => "settling(error, band)",
        "partial" => "partial(expression, variable)",
        "table" => "table(x, {0, 1, 2}, {0, 1, 4})",
        "smooth_table" => "smooth_table(x, {0, 1, 2}, {0, 1, 4})",
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
        if !FUNCTIONS.contains(&name)
            && let Some(found) = self.function_named(function)
        {
            return self.function(found, arguments, scope, span);
        }
        if let Some(argument) = arguments.iter().find(|argument| argument.name.is_some()) {
            self.report(refused::named_argument(name, argument.value.span));
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
                &number,
                &a,
                "the function takes a pure number, found",
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
                // The sine of a number is one: only its dimension counts.
                let angle = Typed {
                    dim: Dim::known(Dimension::ANGLE.composed()),
                    ..a.clone()
                };
                if let Some(doubt) = self.sides().sine_of_turns(name, &a) {
                    self.report(doubt);
                }
                self.agree(
                    &angle,
                    &a,
                    "the function takes an angle, found",
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
            "delay" => self.delay(&args, scope, span),
            "edge" => self.edge(&args, scope, span),
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
            "min" | "max" if args.len() == 2 && !self.is_condition(args[1], scope) => {
                self.extremum(name == "min", &args, scope, span)
            }
            "max" | "min" | "rms" | "mean" | "first" | "last" | "settling" | "resonance" => {
                self.reduction(name, &args, scope, span)
            }
            "integral"
                if scope.setting == Setting::Measure
                    && args
                        .get(1)
                        .is_none_or(|second| self.is_condition(second, scope)) =>
            {
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
            "table" | "smooth_table" => self.table(name, &args, scope, span),
            "chirp" => self.chirp(&args, scope, span),
            "pder" => self.pder(&args, scope, span),
            "partial" => self.partial(&args, scope, span),
            "integral" => {
                self.report(crate::refusals::fields::integral_outside_account(span));
                self.poison(span)
            }
            _ => {
                let other = hyde_syntax::instead_of_function(name).map(str::to_owned);
                let instead = self.instead_of_call(name, scope).or(other);
                self.report(refused::unknown_function(function, instead, &FUNCTIONS));
                self.poison(span)
            }
        }
    }

    /// What to write for a name that is called as a function and is none: an element, or a column of a record.
    fn instead_of_call(&self, name: &str, scope: &Scope<'a>) -> Option<String> {
        if self.input.records.contains_key(name) {
            return Some(format!("a column of the record is written `{name}.column`"));
        }
        match self.tree[scope.instance].members.get(name)? {
            Member::Variable(_) | Member::Parameter(_) | Member::Instances(_) => Some(format!(
                "`{name}` is not a function: an element of an array is written `{name}[1]`, a product `{name}*(…)`"
            )),
            Member::Instance(_) | Member::Domain(_) => None,
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
        if let Some(found) = self.function_named(function) {
            return self.function(found, arguments, scope, span);
        }
        let alone = FUNCTIONS
            .contains(&last)
            .then(|| format!("functions have their name alone: `{last}(…)`"));
        let help = hyde_syntax::instead_of(&function.dotted()).or(alone);
        let help =
            help.unwrap_or_else(|| "a field is read at a place with `field.at(x)`".to_owned());
        self.report(refused::unknown_method(function, &help));
        self.poison(span)
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
                a.dim
                    .power(Exponent::HALF)
                    .map_or(Dim::Any, |dim| dim.composed()),
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
        Typed {
            zero: if name == "abs" { a.zero } else { Zero::Open },
            ..self.typed(id, dim, span)
        }
    }

    fn without_events(&mut self, a: &'a Expr, scope: &Scope<'a>, span: Span) -> Typed {
        let a = self.lower(a, scope);
        Typed {
            id: self.flat.exprs.no_event(a.id),
            span,
            ..a
        }
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
            // Of two values, or of one signal over a run, or over a part of it.
            let takes = match name {
                "min" | "max" | "rms" | "mean" | "first" | "last" => "1 or 2".to_owned(),
                _ => N.to_string(),
            };
            let numbers = (takes, args.len());
            self.report(refused::number_of_arguments(
                name,
                numbers,
                span,
                usage(name),
            ));
        }
        found
    }
}
