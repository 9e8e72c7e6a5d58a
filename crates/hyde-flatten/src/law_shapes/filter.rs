//! The filters of a shape: `tau*der(late) = v - late;`.

use super::draft::{Draft, READ_IN};
use super::text::text_in_shape;
use crate::law_roles::{Refusal, wrong};
use crate::model::Model;
use crate::refusals::laws as refused;
use hyde_syntax::ast::{Binary, EquationKind, Expr, ExprKind};
use hyde_units::Dimension;

/// Reads the equations of a shape, one for each of its states.
pub(super) fn filters<'a>(model: &mut Model<'a, '_>, draft: &mut Draft<'a>) -> Result<(), Refusal> {
    let mut read = vec![false; draft.shape.states.len()];
    for equation in draft.equations.clone() {
        let Some((time_constant, name, input)) = filter(&equation.kind) else {
            return Err(wrong(refused::not_a_filter(equation.span)));
        };
        let states = draft.shape.states.iter();
        let Some(number) = states.clone().position(|state| state.name == name) else {
            let known: Vec<&str> = states.map(|state| state.name.as_str()).collect();
            return Err(wrong(refused::filters_nothing(name, equation.span, &known)));
        };
        let scope = draft.scope();
        let [first, second] = [time_constant, input].map(|value| model.lower(value, &scope));
        let state = draft.names.iter().find(|(known, _)| *known == name);
        if let Some((_, state)) = state {
            model.agree(state, &second, "the filter and its input are", READ_IN);
        }
        let time = crate::dimension::Dim::known(Dimension::TIME);
        let time = model.typed(first.id, time, first.span);
        model.agree(&time, &first, "a time constant is", READ_IN);
        let time_constant = text_in_shape(model, draft, time_constant, first.id)?;
        let input = text_in_shape(model, draft, input, second.id)?;
        let state = &mut draft.shape.states[number];
        (state.time_constant, state.input) = (time_constant, input);
        read[number] = true;
    }
    let mut states = draft.shape.states.iter().zip(read);
    match states.find(|(_, read)| !read) {
        None => Ok(()),
        Some((state, _)) => Err(wrong(refused::no_value_in_shape(
            &state.name,
            draft.class.name.span,
        ))),
    }
}

/// The time constant of a filter, the name of its state, and its input.
fn filter(equation: &EquationKind) -> Option<(&Expr, &str, &Expr)> {
    if let EquationKind::Equality { lhs, rhs, .. } = equation
        && let ExprKind::Binary(Binary::Mul, time_constant, rate) = &lhs.kind
        && let ExprKind::Call(function, arguments) = &rate.kind
        && let (Some("der"), [only]) = (function.as_word(), arguments.as_slice())
        && let ExprKind::Binary(Binary::Sub, input, state) = &rhs.kind
        && let ExprKind::Reference(name) = &only.value.kind
        && let ExprKind::Reference(same) = &state.kind
        && let Some(word) = name.as_word()
        && same.as_word() == Some(word)
    {
        Some((time_constant, word, input))
    } else {
        None
    }
}
