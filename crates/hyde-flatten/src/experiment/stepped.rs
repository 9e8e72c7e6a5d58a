//! `by stepped(…)` of a frequency response: one run a frequency.
//!
//! The frequency is asked for from outside, as the parameter `INPUT.frequency`. Where it is set, the input is a sine of
//! that frequency and of the amplitude `INPUT.amplitude`, in place of its stimulus. It begins gently: over the first half
//! of the time to settle the amplitude rises from nothing.

use super::outer::outer_parameter;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::experiment as refused;
use hyde_diag::MadeBy;
use hyde_ir::flat::{Equation, Stepped};
use hyde_ir::{BinaryOp, Expr as Ir, ExprId, Quantity, Range, UnaryOp, VarId};
use hyde_syntax::ast::{self, Argument, ExperimentItem, Expr};
use hyde_units::Dimension;

const OPTIONS: [&str; 6] = ["amplitude", "points", "settle", "periods", "keep", "level"];

/// Whether a stepped sine drives this input now.
pub(super) fn is_stepped(model: &Model<'_, '_>, input: &str) -> bool {
    let asked = model.input.settings.contains_key(&frequency_of(input));
    let experiment = model.input.experiment;
    let experiment = experiment.and_then(|name| model.names.own_experiment(name));
    let bode = |item: &ExperimentItem| matches!(item, ExperimentItem::Bode(bode) if bode.steps.is_some() && bode.input.as_word() == Some(input));
    asked && experiment.is_some_and(|experiment| experiment.items.iter().any(bode))
}

/// What `by stepped(…)` says; drives the input where a frequency is set.
pub(super) fn stepped<'a>(
    model: &mut Model<'a, '_>,
    (input, _): (VarId, usize),
    method: &ast::Name,
    arguments: &'a [Argument],
    outputs: &[&str],
    root: InstanceId,
) -> Option<Stepped> {
    if method.text != "stepped" {
        model.report(refused::unknown_steps(method));
        return None;
    }
    if model.flat.variables[input].len.is_some() {
        model.report(refused::steps_of_an_element(method.span));
        return None;
    }
    for argument in arguments {
        let name = argument.name.as_ref();
        if !name.is_some_and(|name| OPTIONS.contains(&name.text.as_str())) {
            let span = name.map_or(argument.value.span, |name| name.span);
            model.report(refused::unknown_option_of_steps(span, &OPTIONS));
            return None;
        }
    }
    let given = |name: &str| {
        let mut arguments = arguments.iter();
        let found = arguments.find(|a| a.name.as_ref().is_some_and(|n| n.text == name));
        found.map(|argument| &argument.value)
    };
    let Some(amplitude) = given("amplitude") else {
        model.report(refused::no_amplitude(method.span));
        return None;
    };
    let dim = model.dim(input);
    let amplitude = number_like(
        model,
        amplitude,
        &dim,
        "the input and its amplitude are",
        root,
    );
    let or =
        |model: &mut Model<'a, '_>, name: &str, dimension: &Dim, default: f64| match given(name) {
            Some(expr) => number_like(model, expr, dimension, "a stepped sine relates", root),
            None => model.flat.exprs.constant(default),
        };
    let points = or(model, "points", &Dim::NUMBER, 20.0);
    let settle = or(model, "settle", &Dim::known(Dimension::TIME), 0.2);
    let periods = or(model, "periods", &Dim::NUMBER, 5.0);
    let keep = match (given("keep"), given("level")) {
        (None, None) => None,
        (Some(output), Some(level)) => Some(kept(model, output, level, outputs, root)?),
        (Some(alone), None) | (None, Some(alone)) => {
            model.report(refused::keep_without_level(alone.span));
            return None;
        }
    };
    sine(model, input, amplitude, settle, root);
    Some(Stepped {
        amplitude,
        points,
        settle,
        periods,
        keep,
    })
}

/// The response that is kept, by its number, and at which level.
fn kept<'a>(
    model: &mut Model<'a, '_>,
    output: &'a Expr,
    level: &'a Expr,
    outputs: &[&str],
    root: InstanceId,
) -> Option<(usize, ExprId)> {
    let text = hyde_syntax::format_expression(output);
    let Some(number) = outputs.iter().position(|known| *known == text) else {
        model.report(refused::keeps_no_response(&text, output.span, outputs));
        return None;
    };
    let kept = model.value(output, &Scope::new(root, Setting::Report));
    let level = model.value(level, &Scope::new(root, Setting::Parameter));
    model.agree(&kept, &level, "what is kept and its level are", root);
    Some((number, level.id))
}

/// Drives the input by a sine if a frequency is set from outside.
fn sine(
    model: &mut Model<'_, '_>,
    input: VarId,
    amplitude: ExprId,
    settle: ExprId,
    root: InstanceId,
) {
    let variable = &model.flat.variables[input];
    let name = variable.name.clone();
    if !is_stepped(model, &name) {
        return;
    }
    let origin = variable.origin.clone().made_by(MadeBy::Experiment);
    let quantity = variable.quantity.clone();
    let rate = Dimension::DIMENSIONLESS.divide(Dimension::TIME);
    let frequency = Dim::NUMBER.divide(&Dim::known(Dimension::TIME));
    let hz = model.flat.exprs.constant(0.0);
    let frequency = outer_parameter(
        model,
        frequency_of(&name),
        frequency,
        Quantity::usual(rate),
        hz,
        &origin,
    );
    let of_input = model.dim(input);
    let amplitude = outer_parameter(
        model,
        format!("{name}.amplitude"),
        of_input,
        quantity,
        amplitude,
        &origin,
    );
    let arena = &mut model.flat.exprs;
    let time = arena.add(Ir::Time);
    let turns = arena.times(frequency, time);
    let tau = arena.constant(std::f64::consts::TAU);
    let angle = arena.times(tau, turns);
    let sine = arena.unary(UnaryOp::Sin, angle);
    let half = arena.constant(0.5);
    let rise = arena.times(half, settle);
    // Without a time to settle it rises at once.
    let least = arena.constant(1e-9);
    let rise = arena.binary(BinaryOp::Max, rise, least);
    let risen = arena.binary(BinaryOp::Div, time, rise);
    let whole = arena.constant(1.0);
    let risen = arena.binary(BinaryOp::Min, risen, whole);
    let amplitude = arena.times(amplitude, risen);
    let rhs = arena.times(amplitude, sine);
    let lhs = arena.var(input);
    let origin = model
        .tree
        .origin(root, origin.span)
        .made_by(MadeBy::Experiment);
    model.flat.equations.push(Equation {
        range: Range::SCALAR,
        lhs,
        rhs,
        origin,
    });
}

/// An expression of parameters in a given dimension.
fn number_like<'a>(
    model: &mut Model<'a, '_>,
    expr: &'a Expr,
    dim: &Dim,
    what: &'static str,
    root: InstanceId,
) -> ExprId {
    let value = model.value(expr, &Scope::new(root, Setting::Parameter));
    let declared = Typed {
        dim: dim.clone(),
        ..value.clone()
    };
    model.agree(&declared, &value, what, root);
    value.id
}

/// The parameter by which a frequency is asked for.
fn frequency_of(input: &str) -> String {
    format!("{input}.frequency")
}
