//! Measures and expectations.

use crate::dimension::Dim;
use crate::instance::{Scope, Typed};
use crate::instantiate::type_unit;
use crate::model::Model;
use crate::refusals::dimensions as refused;
use crate::zero::Zero;
use hyde_diag::MadeBy;
use hyde_ir::Quantity;
use hyde_ir::flat::Measure;
use hyde_syntax::ast;
use hyde_units::{Dimension, NamedUnit, significant};

/// A measure of an experiment or a model; expectations behind it may use its name.
pub(crate) fn add_measure<'a>(
    model: &mut Model<'a, '_>,
    measure: &'a ast::Measure,
    scope: &Scope<'a>,
) {
    let typed = model.lower(&measure.value, scope);
    let file = model.tree[scope.instance].file;
    let mut unit = None;
    let difference = typed.zero == Zero::Difference;
    let own_zero = |unit: &NamedUnit| unit.unit().is_absolute();
    match model.names.quantity(file, &measure.type_name) {
        Some(crate::names::TypeName::Quantity(file, item)) => {
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
                if typed.zero == Zero::Perhaps && own_zero(&asked) {
                    let zero = significant(asked.unit().from_si(0.0), 5);
                    let shown = format!("{zero} {}", asked.text());
                    let plain = asked.unit().dimension.usual_unit();
                    let here = measure.value.span;
                    model.report(refused::difference_with_zero(here, &shown, &plain));
                }
                // A difference of temperatures is shown in K.
                let shown = Some(asked).filter(|unit| !(difference && own_zero(unit)));
                unit = shown.or_else(|| Some(NamedUnit::usual(typed.dim.as_known()?)));
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
    let dimension = model.dimension_until_now(&typed.dim);
    let dimension = dimension.unwrap_or(Dimension::DIMENSIONLESS);
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
