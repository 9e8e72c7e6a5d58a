//! Columns of records: read between rows, held, one row ahead, and their first value and mean; begin and end of a record.

use crate::dimension::Dim;
use crate::input::Input;
use crate::instance::{ParameterNotes, Scope, Setting};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::records as refused;
use hyde_diag::{Diagnostics, MadeBy, Span};
use hyde_ir::{
    Column, ColumnId, FlatModel, Interpolation, Parameter, Quantity, VarId, VariableKind,
};
use hyde_syntax::ast::Reference;
use hyde_units::{Dimension, NamedUnit, unit_in_name};
use std::collections::BTreeMap;

/// `record.column`, `.next`, `.first`, `.mean`; `record.begin` and `record.end`.
pub(crate) fn record_column<'a>(
    model: &mut Model<'a, '_>,
    reference: &'a Reference,
    scope: &Scope<'a>,
) -> Option<Resolved> {
    let record = reference.parts.first()?.name.text.clone();
    let (column, suffix) = match reference.parts.as_slice() {
        [_, column] => (column.name.text.as_str(), None),
        [_, column, suffix] => (column.name.text.as_str(), Some(suffix.name.text.as_str())),
        _ => {
            model.report(refused::which_column(&record, reference.span));
            return None;
        }
    };
    let header = model.input.records.get(&record);
    let among = |columns: &'_ [(String, Option<NamedUnit>)]| {
        let own = columns.iter().find(|(name, _)| name == column);
        own.map(|(_, unit)| unit.clone())
    };
    let sparse = header.filter(|_| scope.measured);
    let sparse = sparse.and_then(|header| among(&header.sparse));
    let known = header.and_then(|header| among(&header.columns));
    let known = known.or_else(|| sparse.clone());
    if known.is_none() && header.is_some() && suffix.is_none() && matches!(column, "begin" | "end")
    {
        let instant = record_instant(model, &record, column, reference.span);
        return Some(Resolved::Parameter(instant, None));
    }
    let unusable =
        header.and_then(|header| header.unusable.iter().find(|(name, ..)| name == column));
    if let Some((_, message, repair)) = unusable.filter(|_| sparse.is_none()) {
        model.report(refused::unusable_column(
            &record,
            reference.span,
            (message, repair),
        ));
        return None;
    }
    let Some(unit) = known else {
        let names: Vec<&str> = header
            .map(|header| {
                header
                    .columns
                    .iter()
                    .map(|(name, _)| name.as_str())
                    .collect()
            })
            .unwrap_or_default();
        let at = reference
            .parts
            .get(1)
            .map_or(reference.span, |part| part.name.span);
        model.report(refused::no_column((&record, column), at, &names));
        return None;
    };
    match suffix {
        None | Some("next") => {
            if scope.setting == Setting::Parameter {
                model.not_constant(&format!("`{record}.{column}`"), reference.span);
                return None;
            }
            let (_, linear, _) = column_of(
                model,
                &record,
                column,
                unit,
                suffix.is_some(),
                reference.span,
            );
            Some(Resolved::Variable(linear, None))
        }
        Some(value @ ("first" | "mean")) => Some(Resolved::Parameter(
            column_value(model, &record, column, value, unit, reference.span),
            None,
        )),
        Some(other) => {
            model.report(refused::no_part_of_column(other, reference.span));
            None
        }
    }
}

/// The column and its linear and held variables, made at first use.
pub(super) fn column_of(
    model: &mut Model<'_, '_>,
    record: &str,
    column: &str,
    unit: Option<NamedUnit>,
    next: bool,
    span: Span,
) -> (ColumnId, VarId, VarId) {
    let known =
        model.flat.columns.enumerate().find(|(_, known)| {
            known.record == record && known.column == column && known.next == next
        });
    if let Some((id, _)) = known {
        let (linear, held) = model.column_variables[&id];
        return (id, linear, held);
    }
    let id = model.flat.columns.push(Column {
        record: record.to_owned(),
        column: column.to_owned(),
        next,
        scale: (1.0, 0.0),
        noise: 0.0,
        ticks_s: None,
        drives: None,
    });
    let dim = match &unit {
        Some(unit) => Dim::known(unit.unit().dimension),
        None => Dim::unknown(model.dimensions.fresh()),
    };
    let name = format!("{record}.{column}{}", if next { ".next" } else { "" });
    let linear = VariableKind::Column(id, Interpolation::Linear);
    let held = VariableKind::Column(id, Interpolation::Held);
    let linear = model.add_variable(
        0,
        name.clone(),
        linear,
        dim.clone(),
        span,
        MadeBy::Experiment,
    );
    let held = model.add_variable(
        0,
        format!("held({name})"),
        held,
        dim,
        span,
        MadeBy::Experiment,
    );
    if let Some(unit) = unit {
        let quantity = Quantity {
            dimension: unit.unit().dimension,
            unit,
        };
        model.flat.variables[linear].quantity = quantity.clone();
        model.flat.variables[held].quantity = quantity;
    }
    model.column_variables.insert(id, (linear, held));
    (id, linear, held)
}

/// Refuses a column without a unit whose name ends with one that it is not taken in: `position_mm` as a length in m.
pub(crate) fn report_units_in_names(
    input: &Input<'_>,
    flat: &FlatModel,
    columns: &BTreeMap<ColumnId, (VarId, VarId)>,
    diagnostics: &mut Diagnostics,
) {
    for (id, column) in flat.columns.enumerate() {
        let header = input.records.get(&column.record);
        let own = header.and_then(|header| {
            header
                .columns
                .iter()
                .find(|(name, _)| *name == column.column)
        });
        let (Some((name, None)), Some((linear, _))) = (own, columns.get(&id)) else {
            continue;
        };
        let variable = &flat.variables[*linear];
        let Some(unit) = other_unit_in_name(name, variable.quantity.dimension) else {
            continue;
        };
        let record = &column.record;
        let taken = NamedUnit::usual(variable.quantity.dimension);
        let read = variable.origin.span;
        diagnostics.push(refused::unit_in_name((record, name), read, (&taken, &unit)));
    }
}

/// The first value of a column or its mean: a parameter that the run fills in.
fn column_value(
    model: &mut Model<'_, '_>,
    record: &str,
    column: &str,
    value: &str,
    unit: Option<NamedUnit>,
    span: Span,
) -> hyde_ir::ParamId {
    let name = format!("{record}.{column}.{value}");
    if let Some(&param) = model.column_values.get(&name) {
        return param;
    }
    let (_, linear, _) = column_of(model, record, column, unit, false, span);
    let dim = model.dim(linear);
    let quantity = model.flat.variables[linear].quantity.clone();
    recorded_parameter(model, record, name, (dim, quantity), span)
}

/// The time of the first row of a record, or of the last one.
fn record_instant(
    model: &mut Model<'_, '_>,
    record: &str,
    which: &str,
    span: Span,
) -> hyde_ir::ParamId {
    let name = format!("{record}.{which}");
    if let Some(&param) = model.column_values.get(&name) {
        return param;
    }
    let quantity = Quantity {
        dimension: Dimension::TIME,
        unit: NamedUnit::usual(Dimension::TIME),
    };
    let dim = Dim::known(Dimension::TIME);
    recorded_parameter(model, record, name, (dim, quantity), span)
}

/// A parameter that the run fills in from a record.
fn recorded_parameter(
    model: &mut Model<'_, '_>,
    record: &str,
    name: String,
    (dim, quantity): (Dim, Quantity),
    span: Span,
) -> hyde_ir::ParamId {
    let zero = model.flat.exprs.constant(0.0);
    model.parameters.push(ParameterNotes::made(dim));
    let origin = model.tree.origin(0, span).made_by(MadeBy::Experiment);
    let param = model.flat.parameters.push(Parameter {
        source: Some(format!("record {record}")),
        ..Parameter::new(name.clone(), zero, quantity, origin)
    });
    model.column_values.insert(name, param);
    param
}

/// The unit of that dimension that a name ends with, unless it is the one of SI.
fn other_unit_in_name(name: &str, dimension: Dimension) -> Option<NamedUnit> {
    let unit = unit_in_name(name)?;
    let own = unit.unit().dimension.agreement(dimension);
    (own == hyde_units::Agreement::Same && !unit.unit().is_si()).then_some(unit)
}
