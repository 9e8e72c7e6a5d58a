//! `vary …`: one thing that varies, as written: alternatives, a list, or a range of literals.

use super::draft::{Choice, ChoiceOf, Varying, Written, path};
use crate::refusals::sweeps as refused;
use hyde_diag::Diagnostic;
use hyde_syntax::ast::{EffectUse, Expr, ExprKind, Unary, UnitText, Variation, Varied};
use hyde_units::NamedUnit;

/// Reads a variation.
pub(super) fn varying(variation: &Variation) -> Result<Varying, Diagnostic> {
    let target = &variation.target;
    let span = target.span;
    if let Some(per) = &variation.per {
        return Err(refused::per_label(per.span));
    }
    let list = || match &variation.values {
        Some(Expr {
            kind: ExprKind::Array(items, unit),
            ..
        }) if !items.is_empty() => Ok((items, unit.as_ref())),
        Some(other) => Err(refused::not_a_list(other.span)),
        None => Err(refused::varies_between_nothing(&path(target), span)),
    };
    match variation.what {
        Varied::Model => {
            let (items, _) = list()?;
            let options = items.iter().map(model_name).collect::<Result<_, _>>()?;
            Ok(choice("model".to_owned(), options, ChoiceOf::Model))
        }
        Varied::Stimulus => {
            let (items, _) = list()?;
            let options = items.iter().map(hyde_syntax::format_expression).collect();
            let what = ChoiceOf::Stimulus(target.clone(), items.clone());
            Ok(choice(format!("stimulus {}", path(target)), options, what))
        }
        Varied::Record => {
            let (items, _) = list()?;
            let options = items.iter().map(file_name).collect::<Result<_, _>>()?;
            Ok(choice(
                format!("record {}", path(target)),
                options,
                ChoiceOf::Record(path(target)),
            ))
        }
        Varied::Part => {
            if target.as_word() == Some("uncertain")
                && variation.values.is_none()
                && variation.within.is_none()
            {
                return Ok(Varying::Uncertain(span));
            }
            if let Some(range) = &variation.within {
                let unit = unit_of(&range.to).or_else(|| unit_of(&range.from));
                let (from, to) = (number(&range.from, unit)?, number(&range.to, unit)?);
                return Ok(Varying::Range(target.clone(), from, to));
            }
            let (items, unit) = list()?;
            if items
                .iter()
                .all(|item| matches!(item.kind, ExprKind::Reference(_) | ExprKind::Call(..)))
            {
                let options = items.iter().map(hyde_syntax::format_expression).collect();
                let what = ChoiceOf::Component(target.clone(), items.clone());
                return Ok(choice(path(target), options, what));
            }
            let values = items
                .iter()
                .map(|item| number(item, unit))
                .collect::<Result<_, _>>()?;
            Ok(Varying::List(target.clone(), values))
        }
    }
}

fn choice(name: String, options: Vec<String>, what: ChoiceOf) -> Varying {
    Varying::Choice(Choice {
        name,
        options,
        what,
    })
}

/// Without the effect, then with it.
pub(super) fn effect(used: &EffectUse) -> Choice {
    let sites: Vec<String> = used.sites.iter().map(path).collect();
    Choice {
        name: format!("effect {} on {}", used.effect.dotted(), sites.join(", ")),
        options: vec!["without".to_owned(), "with".to_owned()],
        what: ChoiceOf::Effect(used.clone()),
    }
}

fn model_name(expr: &Expr) -> Result<String, Diagnostic> {
    if let ExprKind::Reference(reference) = &expr.kind {
        return Ok(reference.dotted());
    }
    Err(refused::not_a_model(expr.span))
}

fn file_name(expr: &Expr) -> Result<String, Diagnostic> {
    if let ExprKind::String(text) = &expr.kind {
        return Ok(text.clone());
    }
    Err(refused::not_a_file(expr.span))
}

/// A literal, with a sign and a unit; `unit` stands behind the whole range or list.
fn number(expr: &Expr, unit: Option<&UnitText>) -> Result<Written, Diagnostic> {
    let (sign, inner) = if let ExprKind::Unary(Unary::Negative, inner) = &expr.kind {
        (-1.0, &**inner)
    } else {
        (1.0, expr)
    };
    if let ExprKind::Boolean(truth) = &expr.kind {
        return Ok(Written {
            value: f64::from(u8::from(*truth)),
            unit: None,
            truth: true,
            span: expr.span,
        });
    }
    let ExprKind::Number(value, own) = &inner.kind else {
        return Err(refused::not_a_number(expr.span));
    };
    let Some(text) = own.as_ref().or(unit) else {
        return Ok(Written {
            value: sign * value,
            unit: None,
            truth: false,
            span: expr.span,
        });
    };
    let unit = NamedUnit::parse(&text.text)
        .map_err(|error| refused::bad_unit(&error.to_string(), text.span))?;
    Ok(Written {
        value: unit.unit().to_si(sign * value),
        unit: Some(unit),
        truth: false,
        span: expr.span,
    })
}

fn unit_of(expr: &Expr) -> Option<&UnitText> {
    if let ExprKind::Unary(_, inner) = &expr.kind {
        return unit_of(inner);
    }
    if let ExprKind::Number(_, unit) = &expr.kind {
        unit.as_ref()
    } else {
        None
    }
}
