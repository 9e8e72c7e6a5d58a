//! What a shape declares of its constants and outputs in parentheses, and the ranges behind `in`.

use super::draft::{Draft, READ_IN};
use crate::instance::Typed;
use crate::law_roles::{Refusal, wrong};
use crate::model::Model;
use crate::refusals::laws as refused;
use hyde_ir::{ExprId, Id as _, LawStep};
use hyde_syntax::ast::{Change, Declarator, Expr};

/// The first step of a search, of the logarithm, where none is declared.
const RATIO: f64 = 0.3;
/// The values that a fit may take, as parts of the value it begins with, where none are declared.
const LIMITS: [f64; 2] = [0.2, 5.0];

/// Reads the range of a constant, its first step, and the values that a fit may take.
pub(super) fn constant_of_shape<'a>(
    model: &mut Model<'a, '_>,
    draft: &mut Draft<'a>,
    number: usize,
) -> Result<(), Refusal> {
    let declarator = draft.declared[number];
    let name = declarator.name.text.as_str();
    let own = draft.names.iter().find(|(known, _)| *known == name);
    let Some(own) = own.map(|(_, typed)| typed.clone()) else {
        return Err(None);
    };
    let Some(range) = &declarator.within else {
        return Err(wrong(refused::constant_without_range(&declarator.name)));
    };
    let range = [&range.from, &range.to].map(|bound| like(model, draft, bound, &own));
    let arena = &mut model.flat.exprs;
    let ratio = arena.constant(RATIO);
    let mut limits = LIMITS.map(|part| {
        let part = arena.constant(part);
        arena.times(part, own.id)
    });
    let mut step = LawStep::Ratio(ratio);
    for (word, value, change) in attributes(declarator, &["ratio", "step", "min", "max"])? {
        let number = pure_number(model, draft);
        match word {
            "ratio" => step = LawStep::Ratio(like(model, draft, value, &number)),
            "step" => {
                step = LawStep::Added(like(model, draft, value, &own));
                limits = range;
            }
            "min" => limits[0] = like(model, draft, value, &own),
            "max" => limits[1] = like(model, draft, value, &own),
            _ => return Err(unknown(change, &[])),
        }
    }
    let constant = &mut draft.shape.constants[number];
    (constant.range, constant.step, constant.limits) = (range, step, limits);
    Ok(())
}

/// Reads what the first output says of products with other shapes.
pub(super) fn attributes_of_output<'a>(
    model: &mut Model<'a, '_>,
    draft: &mut Draft<'a>,
    declarator: &'a Declarator,
) -> Result<(), Refusal> {
    for (word, value, change) in attributes(declarator, &["cost", "few"])? {
        let number = pure_number(model, draft);
        let id = like(model, draft, value, &number);
        let count = model.flat.exprs.as_constant(id);
        let Some(count) = count.filter(|count| count.fract() == 0.0 && *count >= 0.0) else {
            return Err(wrong(refused::not_a_count(word, change.target.span)));
        };
        match word {
            "cost" => draft.shape.cost = count as u32,
            _ => draft.shape.few = Some(count as usize),
        }
    }
    Ok(())
}

/// A value with the dimension of another one.
fn like<'a>(
    model: &mut Model<'a, '_>,
    draft: &Draft<'a>,
    value: &'a Expr,
    declared: &Typed,
) -> ExprId {
    let typed = model.lower(value, &draft.scope());
    model.agree(declared, &typed, "the constant and the value are", READ_IN);
    typed.id
}

fn pure_number<'a>(model: &Model<'a, '_>, draft: &Draft<'a>) -> Typed {
    let span = draft.class.name.span;
    model.typed(ExprId::from_index(0), crate::dimension::Dim::NUMBER, span)
}

/// What stands in parentheses behind a name: each word with its value.
fn attributes<'a>(
    declarator: &'a Declarator,
    known: &[&'static str],
) -> Result<Vec<(&'static str, &'a Expr, &'a Change)>, Refusal> {
    let mut found = Vec::new();
    for change in &declarator.changes {
        let word = change.target.as_word();
        let own = known.iter().find(|own| Some(**own) == word);
        match (own, &change.value) {
            (Some(word), Some(value)) => found.push((*word, value, change)),
            _ => return Err(unknown(change, known)),
        }
    }
    Ok(found)
}

fn unknown(change: &Change, known: &[&str]) -> Refusal {
    wrong(refused::unknown_attribute(&change.target, known))
}
