//! Measured channels: a prepared column beside what the model has for it.

use super::late::{moved, undelay};
use super::observed::{observed, period};
use crate::dimension::Dim;
use crate::input::Form;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::model::call::clocks_of;
use crate::model::lower::Resolved;
use crate::refusals::records as refused;
use hyde_diag::MadeBy;
use hyde_ir::flat::{Measured, Preparation};
use hyde_ir::{ColumnId, Quantity, VariableKind};
use hyde_syntax::ast::{self, Channel, Expr, ExprKind};
use hyde_units::Dimension;

/// `measured column = e ~ noise`.
pub(super) fn measured<'a>(model: &mut Model<'a, '_>, channel: &'a Channel, root: InstanceId) {
    let mut preparation = Vec::new();
    let Some((column, mut dim)) = recorded(model, &channel.signal, root, true, &mut preparation)
    else {
        return;
    };
    let scope = Scope {
        records: true,
        ..Scope::new(root, Setting::Report)
    };
    let first_delay = model.flat.delays.len();
    let value = model.value(&channel.value, &scope);
    let left = model.typed(value.id, dim.clone(), channel.signal.span);
    model.agree(&left, &value, "the record and the model are", root);
    let noise = channel.noise.as_ref().map(|noise| {
        let typed = model.width(noise, &scope.with(Setting::Parameter));
        model.agree(&typed, &value, "the noise and the value are", root);
        typed.id
    });
    if dim.as_known().is_none() {
        dim = value.dim.clone();
    }
    let dimension = model.dimension_until_now(&dim);
    let dimension = dimension.unwrap_or(Dimension::DIMENSIONLESS);
    let written = &model.flat.variables[model.column_variables[&column].0].quantity;
    let quantity = if preparation.is_empty() && written.dimension == dimension {
        written.clone()
    } else {
        Quantity::usual(dimension)
    };
    let period = period(&mut model.flat, value.id);
    let (id, rounding) = match model.input.form {
        Form::Run => (value.id, None),
        Form::Observed => observed(&mut model.flat, value.id),
        // What a clock has counted is what the axis itself knows; a scale's noise comes before its rounding.
        Form::Recorded if !clocks_of(&model.flat, value.id).is_empty() => (value.id, None),
        Form::Recorded => observed(&mut model.flat, value.id),
    };
    let early = match model.input.form {
        Form::Observed => undelay(&mut model.flat, &mut model.delayed, id, first_delay),
        Form::Run | Form::Recorded => None,
    };
    let id = match &early {
        Some(early) if !early.by.is_empty() => {
            let slope = model.time_derivative(id, channel.value.span);
            moved(&mut model.flat.exprs, id, slope, early)
        }
        Some(_) | None => id,
    };
    let late = early.map(|early| (early.by_s, early.by));
    let clocked = !clocks_of(&model.flat, id).is_empty();
    let signal = hyde_syntax::format_expression(&channel.signal);
    let name = match (&channel.doc, signal.split_once('.')) {
        (Some(doc), _) => doc.clone(),
        (None, Some((_, column))) if preparation.is_empty() => column.to_owned(),
        (None, _) => signal,
    };
    let origin = model
        .tree
        .origin(root, channel.signal.span)
        .made_by(MadeBy::Experiment);
    model.flat.experiment.measured.push(Measured {
        name,
        column,
        preparation,
        value: id,
        clocked,
        noise,
        rounding,
        period,
        late,
        quantity,
        origin,
    });
}

/// The recorded signal of a channel: a column, low-passed, differentiated or scaled; where it is compared only, readings of
/// it may be missing.
pub(super) fn recorded<'a>(
    model: &mut Model<'a, '_>,
    expr: &'a Expr,
    root: InstanceId,
    compared: bool,
    steps: &mut Vec<Preparation>,
) -> Option<(ColumnId, Dim)> {
    let scope = Scope {
        records: true,
        measured: compared,
        ..Scope::new(root, Setting::Report)
    };
    match &expr.kind {
        ExprKind::Reference(reference) => {
            if let Some(Resolved::Variable(var, None)) = model.resolve(reference, &scope) {
                if let VariableKind::Column(column, _) = model.flat.variables[var].kind {
                    return Some((column, model.dim(var)));
                }
                model.report(refused::not_a_column(reference, expr.span));
            }
            None
        }
        ExprKind::Call(function, arguments) => match (function.as_word(), arguments.as_slice()) {
            (Some("lowpass"), [inner, corner]) => {
                let found = recorded(model, &inner.value, root, compared, steps)?;
                let parameter = scope.with(Setting::Parameter);
                let corner_typed = model.value(&corner.value, &parameter);
                let rate = Typed {
                    dim: Dim::NUMBER.divide(&Dim::known(Dimension::TIME)),
                    ..corner_typed.clone()
                };
                model.agree(&rate, &corner_typed, "a corner is a frequency, found", root);
                let corner = model.structural_number(&parameter, &corner.value)?;
                steps.push(Preparation::Lowpass(corner));
                Some(found)
            }
            (Some("slope"), [inner]) => {
                let (column, dim) = recorded(model, &inner.value, root, compared, steps)?;
                steps.push(Preparation::Slope);
                Some((column, dim.divide(&Dim::known(Dimension::TIME))))
            }
            _ => {
                model.report(refused::unknown_preparation(expr.span));
                None
            }
        },
        ExprKind::Unary(ast::Unary::Negative, inner) => {
            let found = recorded(model, inner, root, compared, steps)?;
            steps.push(Preparation::Scale(-1.0));
            Some(found)
        }
        ExprKind::Binary(ast::Binary::Mul, factor, inner) => {
            let parameter = scope.with(Setting::Parameter);
            let typed = model.value(factor, &parameter);
            let number = model.structural_number(&parameter, factor)?;
            let (column, dim) = recorded(model, inner, root, compared, steps)?;
            steps.push(Preparation::Scale(number));
            Some((column, typed.dim.multiply(&dim)))
        }
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => {
            model.report(refused::measures_no_column(expr.span));
            None
        }
    }
}
