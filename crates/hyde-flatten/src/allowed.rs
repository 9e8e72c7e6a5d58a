//! The values that are allowed: whole numbers for an Integer, `min` and `max`, and asserts of parameters.
//!
//! Of a parameter they are checked here, with what the command line sets; of a variable they are asserts of the run.

use crate::instance::{Binding, Setting, Typed};
use crate::model::Model;
use crate::refusals::allowed as refused;
use crate::words::short;
use hyde_ir::flat::Assert;
use hyde_ir::{
    BinaryOp, Expr as Ir, ExprId, Id as _, Index, ParamId, UnaryOp, VarId, VariableKind,
};
use hyde_units::{Kind, format_value};

/// Lowers the bounds of parameters, and checks the value of each.
pub(crate) fn check_parameters(model: &mut Model<'_, '_>) {
    for param in model.flat.parameters.ids().collect::<Vec<_>>() {
        let [min, max] = model.parameters[param.index()].bounds.clone();
        if min.is_some() || max.is_some() {
            let declared = declared_parameter(model, param);
            let [min, max] = [min, max].map(|bound| value_of_bound(model, &bound?, &declared));
            let allowed = &mut model.flat.parameters[param].allowed;
            (allowed.min, allowed.max) = (min, max);
        }
        check_value(model, param);
    }
}

fn declared_parameter(model: &mut Model<'_, '_>, param: ParamId) -> Typed {
    let id = model.flat.exprs.add(Ir::Param(param, Index::SCALAR));
    let span = model.flat.parameters[param].origin.span;
    model.typed(id, model.parameters[param.index()].dim.clone(), span)
}

/// A bound is made of numbers.
fn value_of_bound<'a>(
    model: &mut Model<'a, '_>,
    bound: &Binding<'a>,
    declared: &Typed,
) -> Option<f64> {
    let value = model.bound_value(bound, Setting::Parameter);
    model.agree(
        declared,
        &value,
        "the quantity and its bound are",
        bound.scope,
    );
    let number = model.flat.exprs.evaluate(value.id, |_| Err(())).ok();
    if number.is_none() {
        model.report(refused::bound_not_a_number(bound.span));
    }
    number
}

/// What the command line sets itself is checked there.
fn check_value(model: &mut Model<'_, '_>, param: ParamId) {
    let parameter = &model.flat.parameters[param];
    let (allowed, unit) = (parameter.allowed, parameter.quantity.unit.clone());
    let (name, origin) = (parameter.name.clone(), parameter.origin.clone());
    let plain = allowed == hyde_units::Allowed::default() || allowed.kind == Kind::Boolean;
    if plain || parameter.found || model.input.settings.contains_key(&name) {
        return;
    }
    let (elements, values) = ((0_i32..).take(parameter.size()), parameter.value.clone());
    let each: Vec<ExprId> = match values[..] {
        [all] => elements
            .map(|element| model.flat.exprs.at_counter(all, element))
            .collect(),
        _ => values,
    };
    for value in each {
        let Some(value) = model.current_value(value) else {
            continue;
        };
        if let Some(refusal) = allowed.refusal(value, &unit) {
            let value = format_value(value, &unit);
            model.report(refused::value_not_allowed(
                &name,
                &value,
                &refusal,
                allowed.kind,
                origin.span,
            ));
            return;
        }
    }
}

/// Asserts of parameters alone hold for the values that these have, or there is no need for a run to tell.
pub(crate) fn check_asserts(model: &mut Model<'_, '_>) {
    for number in 0..model.flat.asserts.len() {
        let condition = model.flat.asserts[number].condition;
        let below = model.flat.exprs.below(&[condition]);
        let open = below.iter().any(|id| match model.flat.exprs[*id] {
            Ir::Const(_) | Ir::Unary(..) | Ir::Binary(..) | Ir::If(..) | Ir::NoEvent(_) => false,
            Ir::Param(param, _) => {
                let parameter = &model.flat.parameters[param];
                parameter.found || model.column_values.contains_key(&parameter.name)
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
            || model
                .current_value(condition)
                .is_none_or(|truth| truth != 0.0)
        {
            continue;
        }
        let assert = &model.flat.asserts[number];
        let (message, origin) = (assert.message.clone(), assert.origin.span);
        model.report(refused::assert_false(&message, origin));
    }
}

/// Bounds of variables: asserts, at the start and while the run goes on.
pub(crate) fn bounded_variables(model: &mut Model<'_, '_>) {
    for var in model.flat.variables.ids().collect::<Vec<_>>() {
        let bounds = model.notes(var).bounds.clone();
        for (bound, word, op) in bounds
            .iter()
            .zip(["min", "max"])
            .zip([BinaryOp::Ge, BinaryOp::Le])
            .map(|((b, w), o)| (b, w, o))
        {
            if let Some(bound) = bound {
                bounded(model, var, bound, word, op);
            }
        }
    }
}

fn bounded<'a>(
    model: &mut Model<'a, '_>,
    var: VarId,
    bound: &Binding<'a>,
    word: &str,
    op: BinaryOp,
) {
    let instance = model.notes(var).instance;
    let lhs = model.flat.exprs.add(Ir::Var(var, Index::SCALAR));
    let span = model.flat.variables[var].origin.span;
    let declared = model.typed(lhs, model.dim(var), span);
    let Some(limit) = value_of_bound(model, bound, &declared) else {
        return;
    };
    let variable = &model.flat.variables[var];
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
        let value = model.flat.exprs.add(Ir::Var(var, index));
        let limit = model.flat.exprs.constant(limit);
        let condition = model.flat.exprs.binary(op, value, limit);
        let element = if array {
            format!("[{}]", element + first)
        } else {
            String::new()
        };
        model.flat.asserts.push(Assert {
            condition,
            message: format!("`{name}{element}` is {side} its `{word}`, {limit_text}"),
            origin: model.tree.origin(instance, bound.span),
        });
    }
}

/// An Integer gets a whole number.
pub(crate) fn check_whole(model: &mut Model<'_, '_>, target: &Typed, value: &Typed) {
    let Ir::Var(var, _) = model.flat.exprs[target.id] else {
        return;
    };
    if !model.notes(var).integer || is_whole(model, value.id) {
        return;
    }
    let name = short(&model.flat.variables[var].name).to_owned();
    model.report(refused::maybe_no_integer(&name, value.span));
}

/// Whether an expression has whole values alone.
fn is_whole(model: &Model<'_, '_>, root: ExprId) -> bool {
    let mut known: std::collections::BTreeMap<ExprId, bool> = std::collections::BTreeMap::new();
    for id in model.flat.exprs.below(&[root]) {
        let of = |part: ExprId| known.get(&part).copied().unwrap_or(false);
        let whole = match model.flat.exprs[id] {
            Ir::Const(_) => model
                .flat
                .exprs
                .as_constant(id)
                .is_some_and(|value| value.fract() == 0.0),
            Ir::Counter | Ir::Relation(_) | Ir::InMode(..) => true,
            Ir::Param(param, _) => model.flat.parameters[param].allowed.kind != Kind::Real,
            Ir::Var(var, _) | Ir::Pre(var, _) => is_whole_variable(model, var),
            Ir::Unary(UnaryOp::Floor | UnaryOp::Ceil | UnaryOp::Not, _) => true,
            Ir::Unary(UnaryOp::Neg | UnaryOp::Abs, a) => of(a),
            Ir::Binary(
                BinaryOp::Add | BinaryOp::Sub | BinaryOp::Mul | BinaryOp::Min | BinaryOp::Max,
                a,
                b,
            ) => of(a) && of(b),
            Ir::Binary(op, a, b) => {
                let rounds = matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo | BinaryOp::Pow);
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

fn is_whole_variable(model: &Model<'_, '_>, var: VarId) -> bool {
    if let VariableKind::Held(_, source) = model.flat.variables[var].kind {
        return is_whole_variable(model, source);
    }
    model.notes(var).integer || model.flat.variables[var].boolean
}
