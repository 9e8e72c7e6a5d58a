//! Measures and expectations.

use crate::dimension::Dim;
use crate::instance::{Scope, Typed};
use crate::instantiate::type_unit;
use crate::model::Model;
use crate::zero::Zero;
use hyde_diag::MadeBy;
use hyde_ir::Quantity;
use hyde_ir::flat::Measure;
use hyde_syntax::ast;
use hyde_units::{Dimension, NamedUnit};

/// A measure of an experiment or a model; expectations behind it may use its name.
pub(crate) fn add_measure<'a>(
    model: &mut Model<'a, '_>,
    measure: &'a ast::Measure,
    scope: &Scope<'a>,
) {
    let typed = model.lower(&measure.value, scope);
    let file = model.tree[scope.instance].file;
    let mut unit = None;
    match model.names.quantity(file, &measure.type_name) {
        Some(crate::names::TypeName::Quantity(file, item)) => {
            let difference = typed.zero == Zero::Difference;
            let own_zero = |unit: &NamedUnit| unit.unit().is_absolute();
            unit = type_unit(model, file, item).filter(|unit| !(difference && own_zero(unit)));
            if let Some(unit) = &unit {
                let declared = Typed {
                    dim: Dim::known(unit.unit().dimension),
                    span: measure.name.span,
                    ..typed.clone()
                };
                model.agree(
                    &declared,
                    &typed,
                    "the measure and its value are",
                    scope.instance,
                );
            }
        }
        Some(_) => {}
        None => {
            let diagnostic = model.names.unknown_quantity(file, &measure.type_name);
            model.report(diagnostic);
        }
    }
    if let Some(asked) = &measure.unit {
        match NamedUnit::parse(&asked.text) {
            Ok(asked) => {
                let shown = Typed {
                    dim: Dim::known(asked.unit().dimension),
                    span: measure.name.span,
                    ..typed.clone()
                };
                model.agree(
                    &shown,
                    &typed,
                    "the unit asked for and the value are",
                    scope.instance,
                );
                unit = Some(asked);
            }
            Err(error) => model.bad_unit(asked, &error),
        }
    }
    if scope.instance == 0 {
        model
            .measured_numbers
            .push((&measure.name.text, typed.clone()));
    }
    push_measure(model, measure.name.text.clone(), typed, false, unit);
}

pub(super) fn push_measure(
    model: &mut Model<'_, '_>,
    name: String,
    typed: Typed,
    expectation: bool,
    unit: Option<NamedUnit>,
) {
    let dimension = model
        .dimensions
        .resolve(&typed.dim)
        .as_known()
        .unwrap_or(Dimension::DIMENSIONLESS);
    let quantity = match unit {
        Some(unit) => Quantity {
            dimension: unit.unit().dimension,
            unit,
        },
        None => Quantity::usual(dimension),
    };
    let origin = model.tree.origin(0, typed.span).made_by(MadeBy::Experiment);
    model.flat.experiment.measures.push(Measure {
        name,
        value: typed.id,
        expectation,
        quantity,
        origin,
    });
}
