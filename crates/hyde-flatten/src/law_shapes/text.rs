//! The text of a shape's expressions: names of inputs left open, other names of the function replaced by their values,
//! functions named with their package.

use super::draft::Draft;
use crate::law_roles::{Refusal, wrong};
use crate::law_sites::full_name;
use crate::model::Model;
use crate::refusals::laws as refused;
use hyde_ir::{ExprId, LawInput, LawPiece, LawText};
use hyde_syntax::ast::{Binary, Expr, ExprKind, Reference};

/// Stands for an input in a text, with its number and a `_` behind.
const OPEN: &str = "input_of_shape_";

/// The text of an expression of a shape.
pub(super) fn text_in_shape<'a>(
    model: &Model<'a, '_>,
    draft: &Draft<'a>,
    expr: &Expr,
    value: ExprId,
) -> Result<LawText, Refusal> {
    let mut open = expr.clone();
    open_calls(model, draft, &mut open);
    let text = hyde_syntax::format_expression(&open);
    let mut parts = text.split(OPEN);
    let mut pieces: Vec<LawPiece> = Vec::new();
    let letters = |text: &str| (!text.is_empty()).then(|| LawPiece::Letters(text.to_owned()));
    pieces.extend(parts.next().and_then(letters));
    for part in parts {
        let (number, rest) = part.split_once('_').unwrap_or((part, ""));
        let number = number.parse().unwrap_or(0);
        if let LawInput::Least(_) | LawInput::Greatest(_) = draft.shape.inputs[number] {
            return Err(wrong(refused::depends_on_records(expr.span)));
        }
        pieces.push(LawPiece::Input(number));
        pieces.extend(letters(rest));
    }
    let product = |op: &Binary| matches!(op, Binary::Mul | Binary::Div | Binary::Pow);
    Ok(LawText {
        value,
        pieces,
        is_sum: match &open.kind {
            ExprKind::Binary(op, ..) => !product(op),
            ExprKind::If(..) | ExprKind::Unary(..) => true,
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Reference(_)
            | ExprKind::Call(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => false,
        },
    })
}

/// Replaces the names in an expression.
fn open_calls<'a>(model: &Model<'a, '_>, draft: &Draft<'a>, expr: &mut Expr) {
    if let ExprKind::Reference(name) = &mut expr.kind {
        let word = name.as_word().unwrap_or_default();
        if let Some((_, value)) = draft.locals.iter().find(|(own, _)| *own == word) {
            let mut value = (*value).clone();
            open_calls(model, draft, &mut value);
            *expr = value;
        } else if let Some(number) = draft.input(word) {
            *name = Reference::of_path(&format!("{OPEN}{number}_"), name.span);
        }
        return;
    }
    if let ExprKind::Call(function, _) = &mut expr.kind
        && let Some((file, class)) = model.function_named(function)
    {
        *function = Reference::of_path(&full_name(model.input, file, class), function.span);
    }
    for child in expr.children_mut() {
        open_calls(model, draft, child);
    }
}
