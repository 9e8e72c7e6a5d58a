//! The values that are allowed: whole numbers for an Integer, `min` and `max`, and asserts of parameters.
//!
//! Of a parameter they are checked here, with what the command line sets; of a variable they are asserts of the run.

use crate::bind::short;
use crate::instance::{Binding, Setting, Typed};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic};
use hyde_ir::flat::Assert;
use hyde_ir::{
    BinaryOp, Expr as Ir, ExprId, Id as _, Index, ParamId, UnaryOp, VarId, VariableKind,
};
use hyde_units::{Kind, format_value};

impl<'a> Model<'a, '_> {
    /// Lowers the bounds of parameters, and checks the value of each.
    pub(crate) fn check_parameters(&mut self) {
        for param in self.flat.parameters.ids().collect::<Vec<_>>() {
            let [min, max] = self.parameters[param.index()].bounds.clone();
            if min.is_some() || max.is_some() {
                let declared = self.declared_parameter(param);
                let [min, max] = [min, max].map(|bound| self.bound(&bound?, &declared));
                let allowed = &mut self.flat.parameters[param].allowed;
                (allowed.min, allowed.max) = (min, max);
            }
            self.check_value(param);
        }
    }

    fn declared_parameter(&mut self, param: ParamId) -> Typed {
        let id = self.flat.exprs.add(Ir::Param(param, Index::SCALAR));
        let span = self.flat.parameters[param].origin.span;
        self.typed(id, self.parameters[param.index()].dim.clone(), span)
    }

    /// A bound is made of numbers.
    fn bound(&mut self, bound: &Binding<'a>, declared: &Typed) -> Option<f64> {
        let value = self.bound_value(bound, Setting::Parameter);
        self.agree(
            declared,
            &value,
            "the quantity and its bound are",
            bound.scope,
        );
        let number = self.flat.exprs.evaluate(value.id, |_| Err(())).ok();
        if number.is_none() {
            self.report(
                Diagnostic::error(Code::NotConstant, "a bound is not a number")
                    .label(bound.span, "depends on a parameter")
                    .help("write a number, or state the condition: `assert(k < k_max, \"…\");`"),
            );
        }
        number
    }

    /// What the command line sets itself is checked there.
    fn check_value(&mut self, param: ParamId) {
        let parameter = &self.flat.parameters[param];
        let (allowed, unit) = (parameter.allowed, parameter.quantity.unit.clone());
        let (name, origin) = (parameter.name.clone(), parameter.origin.clone());
        let plain = allowed == hyde_units::Allowed::default() || allowed.kind == Kind::Boolean;
        if plain || parameter.found || self.input.settings.contains_key(&name) {
            return;
        }
        for value in parameter.value.clone() {
            let Some(value) = self.current_value(value) else {
                continue;
            };
            if let Some(refusal) = allowed.refusal(value, &unit) {
                let message = format!(
                    "`{name}` cannot be {}: {refusal}",
                    format_value(value, &unit)
                );
                let diagnostic = Diagnostic::error(Code::NotAllowed, message)
                    .label(origin.span, "its value is given here");
                self.report(match allowed.kind {
                    Kind::Integer => {
                        diagnostic.help("round it, `integer(x)`, or declare it `Real`")
                    }
                    Kind::Real | Kind::Boolean => diagnostic,
                });
                return;
            }
        }
    }

    /// Asserts of parameters alone hold for the values that these have, or there is no need for a run to tell.
    pub(crate) fn check_asserts(&mut self) {
        for number in 0..self.flat.asserts.len() {
            let condition = self.flat.asserts[number].condition;
            let below = self.flat.exprs.below(&[condition]);
            let open = below.iter().any(|id| match self.flat.exprs[*id] {
                Ir::Const(_) | Ir::Unary(..) | Ir::Binary(..) | Ir::If(..) | Ir::NoEvent(_) => {
                    false
                }
                Ir::Param(param, _) => {
                    let parameter = &self.flat.parameters[param];
                    parameter.found || self.column_values.contains_key(&parameter.name)
                }
                Ir::Var(..)
                | Ir::Time
                | Ir::Counter
                | Ir::Der(..)
                | Ir::Pre(..)
                | Ir::Relation(_)
                | Ir::InMode(..) => true,
            });
            if open
                || self
                    .current_value(condition)
                    .is_none_or(|truth| truth != 0.0)
            {
                continue;
            }
            let assert = &self.flat.asserts[number];
            let (message, origin) = (assert.message.clone(), assert.origin.span);
            self.report(
                Diagnostic::error(Code::AssertFailed, message)
                    .label(origin, "false for the values that its parameters have")
                    .help("give them other values: `hyde params FILE` lists them, with where each comes from"),
            );
        }
    }

    /// Bounds of variables: asserts, at the start and while the run goes on.
    pub(crate) fn bounded_variables(&mut self) {
        for var in self.flat.variables.ids().collect::<Vec<_>>() {
            let bounds = self.notes(var).bounds.clone();
            for (bound, word, op) in bounds
                .iter()
                .zip(["min", "max"])
                .zip([BinaryOp::Ge, BinaryOp::Le])
                .map(|((b, w), o)| (b, w, o))
            {
                if let Some(bound) = bound {
                    self.bounded(var, bound, word, op);
                }
            }
        }
    }

    fn bounded(&mut self, var: VarId, bound: &Binding<'a>, word: &str, op: BinaryOp) {
        let instance = self.notes(var).instance;
        let lhs = self.flat.exprs.add(Ir::Var(var, Index::SCALAR));
        let span = self.flat.variables[var].origin.span;
        let declared = self.typed(lhs, self.dim(var), span);
        let Some(limit) = self.bound(bound, &declared) else {
            return;
        };
        let variable = &self.flat.variables[var];
        let (name, unit) = (variable.name.clone(), variable.quantity.unit.clone());
        let elements = variable
            .len
            .map_or(1, |len| i32::try_from(len).unwrap_or(i32::MAX));
        let (array, first) = (variable.len.is_some(), variable.first);
        let side = if word == "min" { "below" } else { "above" };
        let limit_text = format_value(limit, &unit);
        for element in 0..elements {
            let index = if array {
                Index::fixed(element)
            } else {
                Index::SCALAR
            };
            let value = self.flat.exprs.add(Ir::Var(var, index));
            let limit = self.flat.exprs.constant(limit);
            let condition = self.flat.exprs.binary(op, value, limit);
            let element = if array {
                format!("[{}]", element + first)
            } else {
                String::new()
            };
            self.flat.asserts.push(Assert {
                condition,
                message: format!("`{name}{element}` is {side} its `{word}`, {limit_text}"),
                origin: self.tree.origin(instance, bound.span),
            });
        }
    }

    /// An Integer gets a whole number.
    pub(crate) fn check_whole(&mut self, target: &Typed, value: &Typed) {
        let Ir::Var(var, _) = self.flat.exprs[target.id] else {
            return;
        };
        if !self.notes(var).integer || self.is_whole(value.id) {
            return;
        }
        let name = short(&self.flat.variables[var].name).to_owned();
        self.report(
            Diagnostic::error(Code::NotAllowed, format!("`{name}` is an Integer, and its value may not be an integer"))
                .label(value.span, "may have a fraction")
                .help(format!("round it where values are sampled or set, `integer(…)`, or declare `{name}` as `Real`")),
        );
    }

    /// Whether an expression has whole values alone.
    fn is_whole(&self, root: ExprId) -> bool {
        let mut known: std::collections::BTreeMap<ExprId, bool> = std::collections::BTreeMap::new();
        for id in self.flat.exprs.below(&[root]) {
            let of = |part: ExprId| known.get(&part).copied().unwrap_or(false);
            let whole = match self.flat.exprs[id] {
                Ir::Const(_) => self
                    .flat
                    .exprs
                    .as_constant(id)
                    .is_some_and(|value| value.fract() == 0.0),
                Ir::Counter | Ir::Relation(_) | Ir::InMode(..) => true,
                Ir::Param(param, _) => self.flat.parameters[param].allowed.kind != Kind::Real,
                Ir::Var(var, _) | Ir::Pre(var, _) => self.is_whole_variable(var),
                Ir::Unary(UnaryOp::Floor | UnaryOp::Ceil | UnaryOp::Not, _) => true,
                Ir::Unary(UnaryOp::Neg | UnaryOp::Abs, a) => of(a),
                Ir::Binary(
                    BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Min | BinaryOp::Max,
                    a,
                    b,
                ) => of(a) && of(b),
                Ir::Binary(op, a, b) => {
                    let rounds =
                        matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo | BinaryOp::Pow);
                    op.is_comparison()
                        || matches!(op, BinaryOp::And | BinaryOp::Or)
                        || rounds && of(a) && of(b)
                }
                Ir::If(_, a, b) => of(a) && of(b),
                Ir::NoEvent(a) => of(a),
                Ir::Time | Ir::Der(..) | Ir::Unary(..) => false,
            };
            known.insert(id, whole);
        }
        known.get(&root).copied().unwrap_or(false)
    }

    fn is_whole_variable(&self, var: VarId) -> bool {
        if let VariableKind::Held(_, source) = self.flat.variables[var].kind {
            return self.is_whole_variable(source);
        }
        self.notes(var).integer || self.flat.variables[var].boolean
    }
}
