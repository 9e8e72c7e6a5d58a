//! The dimension and printed unit of a declared type.

use crate::dimension::Dim;
use crate::model::Model;
use crate::names::{FileIndex, TypeName};
use crate::refusals::instantiate as refused;
use hyde_ir::Quantity;
use hyde_syntax::ast::{self, Expr, ExprKind};
use hyde_units::NamedUnit;

/// The dimension and printed unit of a declared type; `Real` takes those of a literal it is bound to.
pub(crate) fn quantity<'a>(
    model: &mut Model<'a, '_>,
    kind: TypeName<'a>,
    binding: Option<&'a Expr>,
) -> (Dim, Quantity) {
    let written = binding
        .and_then(literal_unit)
        .and_then(|unit| NamedUnit::parse(&unit.text).ok());
    let (dim, unit) = match kind {
        TypeName::Integer | TypeName::Boolean => return (Dim::NUMBER, Quantity::number()),
        TypeName::Real => match &written {
            Some(unit) => (Dim::known(unit.unit().dimension), None),
            None => (Dim::unknown(model.dimensions.fresh()), None),
        },
        TypeName::Quantity(file_of_type, item) => {
            let unit = type_unit(model, file_of_type, item);
            let dim = unit
                .as_ref()
                .map_or(Dim::NUMBER, |unit| Dim::known(unit.unit().dimension));
            (dim, unit)
        }
    };
    let same = |unit: &NamedUnit| dim.as_known() == Some(unit.unit().dimension);
    let quantity = match (written.filter(same), unit) {
        (Some(unit), _) | (None, Some(unit)) => Quantity {
            dimension: unit.unit().dimension,
            unit,
        },
        (None, None) => Quantity::number(),
    };
    (dim, quantity)
}

/// Which quantities a value with a unit may be: "a value in kg.m2 is a `MomentOfInertia`".
pub(super) fn quantities_of(
    model: &mut Model<'_, '_>,
    file: FileIndex,
    value: &Expr,
) -> Option<String> {
    let unit = literal_unit(value)?;
    let dimension = NamedUnit::parse(&unit.text).ok()?.unit().dimension;
    let mut names = Vec::new();
    for (file, item) in model.names.quantities(file) {
        let own = type_unit(model, file, item);
        if own.is_some_and(|own| own.unit().dimension == dimension) {
            names.push(format!("`{}`", item.name.text));
        }
    }
    (!names.is_empty()).then(|| {
        format!(
            "a value in {} is declared as {}",
            unit.text,
            names.join(" or ")
        )
    })
}

/// The unit of a type: its own, or that of the type it is made of.
pub(crate) fn type_unit<'a>(
    model: &mut Model<'a, '_>,
    mut file: FileIndex,
    mut item: &'a ast::TypeItem,
) -> Option<NamedUnit> {
    let mut seen: Vec<&ast::TypeItem> = Vec::new();
    loop {
        if let Some(unit) = &item.unit {
            return match NamedUnit::parse(&unit.text) {
                Ok(unit) => Some(unit),
                Err(error) => {
                    model.bad_unit(unit, &error);
                    None
                }
            };
        }
        seen.push(item);
        match model.names.quantity(file, &item.base) {
            Some(TypeName::Quantity(_, base))
                if seen.iter().any(|known| std::ptr::eq(*known, base)) =>
            {
                let own = |item: &&ast::TypeItem| (item.name.span, item.base.dotted());
                let circle: Vec<_> = seen.iter().map(own).collect();
                model.report(refused::type_of_itself(&base.name.text, &circle));
                return None;
            }
            Some(TypeName::Quantity(next, base)) => (file, item) = (next, base),
            Some(TypeName::Real | TypeName::Integer | TypeName::Boolean) => return None,
            None => {
                let diagnostic = model.names.unknown(file, &item.base);
                model.report(diagnostic);
                return None;
            }
        }
    }
}

/// The unit of a literal, possibly negative.
pub(crate) fn literal_unit(expr: &Expr) -> Option<&ast::UnitText> {
    match &expr.kind {
        ExprKind::Number(_, unit) => unit.as_ref(),
        ExprKind::Unary(_, inner) => literal_unit(inner),
        ExprKind::Array(items, unit) => unit
            .as_ref()
            .or_else(|| items.first().and_then(literal_unit)),
        ExprKind::Comprehension(list) => list.unit.as_ref().or_else(|| literal_unit(&list.value)),
        ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Slice(..) => None,
    }
}
