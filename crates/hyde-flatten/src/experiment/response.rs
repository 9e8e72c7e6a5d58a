//! Measured frequency responses: `measured response(file.i, file.phi) = response(i, motor.phi)`, or the columns of a
//! record over frequency on the left.

use super::bode::{driven_input, shown_quantity};
use super::measured::recorded;
use super::time::agree_time;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::records as refused;
use hyde_diag::{Diagnostics, MadeBy};
use hyde_ir::flat::{Bode, MeasuredResponse, Preparation, RecordedResponse, ScaledColumn};
use hyde_ir::{FlatModel, VarId};
use hyde_syntax::ast::{Channel, ExperimentItem, Expr, ExprKind};
use hyde_units::Dimension;

/// Whether a channel compares frequency responses.
pub(super) fn is_response(channel: &Channel) -> bool {
    call(&channel.value).is_some_and(|(name, _)| name == "response")
}

fn call(expr: &Expr) -> Option<(&str, Vec<&Expr>)> {
    let ExprKind::Call(function, arguments) = &expr.kind else {
        return None;
    };
    let values = arguments.iter().map(|argument| &argument.value);
    Some((function.as_word()?, values.collect()))
}

/// The channels whose right side is `response(u, y)`. Stands behind what `bode` says: a response from u to y that is asked
/// for already is the one compared.
pub(super) fn measured_responses<'a>(
    model: &mut Model<'a, '_>,
    items: &'a [ExperimentItem],
    root: InstanceId,
) {
    for item in items {
        if let ExperimentItem::Measured(channels) = item {
            for channel in channels.iter().filter(|channel| is_response(channel)) {
                measured_response(model, channel, root);
            }
        }
    }
    report_over_frequency(model);
}

fn measured_response<'a>(model: &mut Model<'a, '_>, channel: &'a Channel, root: InstanceId) {
    let Some((input, name, value)) = of_model(model, &channel.value, root) else {
        return;
    };
    let Some((source, dim)) = recorded_response(model, &channel.signal, root) else {
        return;
    };
    let over = model.dim(input.0);
    let computed = model.typed(value.id, value.dim.divide(&over), channel.value.span);
    let left = model.typed(value.id, dim.clone(), channel.signal.span);
    model.agree(&left, &computed, "the record and the model are", root);
    let deviation = match &channel.noise {
        Some(noise) => {
            let Some((column, of_noise)) = scaled_column(model, noise, root) else {
                return;
            };
            let noise = model.typed(value.id, of_noise, noise.span);
            model.agree(&noise, &computed, "the noise and the response are", root);
            Some(column)
        }
        None => None,
    };
    let place = place_of_response(model, input, &name, &value, root);
    let origin = model
        .tree
        .origin(root, channel.signal.span)
        .made_by(MadeBy::Experiment);
    model
        .flat
        .experiment
        .measured_responses
        .push(MeasuredResponse {
            name: channel.doc.clone().unwrap_or(name),
            source,
            deviation,
            place,
            origin,
        });
}

/// `response(u, y)`: the input, and the output with its name.
fn of_model<'a>(
    model: &mut Model<'a, '_>,
    expr: &'a Expr,
    root: InstanceId,
) -> Option<((VarId, usize), String, Typed)> {
    let scope = Scope::new(root, Setting::Report);
    let (_, arguments) = call(expr)?;
    let [input, output] = arguments.as_slice() else {
        model.report(refused::response_takes_two(expr.span));
        return None;
    };
    let driven = match &input.kind {
        ExprKind::Reference(reference) => driven_input(model, reference, &scope),
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => None,
    };
    let Some(driven) = driven else {
        let name = hyde_syntax::format_expression(input);
        model.report(crate::refusals::experiment::response_of_no_input(
            &name, input.span,
        ));
        return None;
    };
    let value = model.value(output, &scope);
    Some((driven, hyde_syntax::format_expression(output), value))
}

/// The left side, with its dimension.
fn recorded_response<'a>(
    model: &mut Model<'a, '_>,
    expr: &'a Expr,
    root: InstanceId,
) -> Option<(RecordedResponse, Dim)> {
    let known = call(expr);
    let parts = known
        .as_ref()
        .map(|(name, arguments)| (*name, &arguments[..]));
    match parts {
        Some(("complex", [re, im])) => {
            let (a, dim) = scaled_column(model, re, root)?;
            let (b, other) = scaled_column(model, im, root)?;
            same(model, &dim, re, &other, im, root);
            one_record(&model.flat, model.diagnostics, &a, &b, expr)?;
            Some((RecordedResponse::Complex(a, b), dim))
        }
        Some(("polar", [gain, phase])) => {
            let (a, dim) = scaled_column(model, gain, root)?;
            let (b, angle) = scaled_column(model, phase, root)?;
            same(
                model,
                &Dim::known(Dimension::ANGLE),
                phase,
                &angle,
                phase,
                root,
            );
            one_record(&model.flat, model.diagnostics, &a, &b, expr)?;
            Some((RecordedResponse::Polar(a, b), dim))
        }
        Some(("response", [input, output, rest @ ..])) if rest.len() <= 1 => {
            let (u, below) = scaled_column(model, input, root)?;
            let (y, above) = scaled_column(model, output, root)?;
            one_record(&model.flat, model.diagnostics, &u, &y, expr)?;
            let period = match rest.first() {
                Some(period) => {
                    let scope = Scope::new(root, Setting::Parameter);
                    let typed = model.value(period, &scope);
                    agree_time(model, &typed, "a period is a time, found", root);
                    Some(model.structural_number(&scope, period)?)
                }
                None => None,
            };
            let dim = above.divide(&below);
            Some((RecordedResponse::Periodic(u, y, period), dim))
        }
        _ => {
            model.report(refused::not_a_response(expr.span));
            None
        }
    }
}

fn same(model: &mut Model<'_, '_>, a: &Dim, at: &Expr, b: &Dim, other: &Expr, root: InstanceId) {
    let zero = model.flat.exprs.constant(0.0);
    let a = model.typed(zero, a.clone(), at.span);
    let b = model.typed(zero, b.clone(), other.span);
    model.agree(&a, &b, "the parts of a response are", root);
}

fn one_record(
    flat: &FlatModel,
    diagnostics: &mut Diagnostics,
    a: &ScaledColumn,
    b: &ScaledColumn,
    expr: &Expr,
) -> Option<()> {
    let record = |column: &ScaledColumn| flat.columns[column.column].record.clone();
    let (first, second) = (record(a), record(b));
    if first == second {
        return Some(());
    }
    diagnostics.push(refused::two_records(expr.span, &first, &second));
    None
}

/// A column, perhaps times a factor.
fn scaled_column<'a>(
    model: &mut Model<'a, '_>,
    expr: &'a Expr,
    root: InstanceId,
) -> Option<(ScaledColumn, Dim)> {
    let mut steps = Vec::new();
    let (column, dim) = recorded(model, expr, root, false, &mut steps)?;
    let mut scale = 1.0;
    for step in steps {
        match step {
            Preparation::Scale(factor) => scale *= factor,
            Preparation::Lowpass(_) | Preparation::Slope => {
                model.report(refused::filtered_response(expr.span));
                return None;
            }
        }
    }
    Some((ScaledColumn { column, scale }, dim))
}

/// Columns over frequency that are read over time.
fn report_over_frequency(model: &mut Model<'_, '_>) {
    let responses = &model.flat.experiment.measured_responses;
    let of_response = |id| {
        responses.iter().any(|measured| {
            let own = match &measured.source {
                RecordedResponse::Complex(a, b) | RecordedResponse::Polar(a, b) => [a, b],
                RecordedResponse::Periodic(..) => return false,
            };
            let mut all = own.into_iter().chain(&measured.deviation);
            all.any(|scaled| scaled.column == id)
        })
    };
    let over_frequency = |record: &String| {
        let header = model.input.records.get(record);
        let first = header.and_then(|header| header.columns.first());
        let unit = first.and_then(|(_, unit)| unit.as_ref());
        unit.is_some_and(|unit| unit.unit().dimension == Dimension::FREQUENCY)
    };
    let wrong: Vec<_> = model
        .flat
        .columns
        .enumerate()
        .filter(|(id, column)| over_frequency(&column.record) && !of_response(*id))
        .map(|(id, column)| {
            let (linear, _) = model.column_variables[&id];
            let span = model.flat.variables[linear].origin.span;
            (format!("{}.{}", column.record, column.column), span)
        })
        .collect();
    for (name, span) in wrong {
        model.report(refused::over_frequency(&name, span));
    }
}

/// The response from that input to that value: what `bode` asks for, or one asked for by this.
fn place_of_response(
    model: &mut Model<'_, '_>,
    input: (VarId, usize),
    name: &str,
    value: &Typed,
    root: InstanceId,
) -> (usize, usize) {
    let bodes = &model.flat.experiment.bodes;
    for (number, bode) in bodes
        .iter()
        .enumerate()
        .filter(|(_, bode)| bode.input == input)
    {
        let output = bode.outputs.iter().position(|(_, id, _)| *id == value.id);
        if let Some(output) = output {
            return (number, output);
        }
    }
    let output = (name.to_owned(), value.id, shown_quantity(model, value));
    let bodes = &mut model.flat.experiment.bodes;
    let own = |bode: &Bode| bode.input == input && bode.band.is_none();
    if let Some(number) = bodes.iter().position(own) {
        bodes[number].outputs.push(output);
        return (number, bodes[number].outputs.len() - 1);
    }
    // It is linearised where and in the modes in which that input is looked at elsewhere.
    let other = bodes.iter().find(|bode| bode.input == input);
    let (at, modes) = other.map_or_else(Default::default, |bode| (bode.at, bode.modes.clone()));
    let origin = model
        .tree
        .origin(root, value.span)
        .made_by(MadeBy::Experiment);
    model.flat.experiment.bodes.push(Bode {
        input,
        outputs: vec![output],
        band: None,
        stepped: None,
        at,
        modes,
        origin,
    });
    (model.flat.experiment.bodes.len() - 1, 0)
}
