//! Hints between the words of a text: the unit of what is declared without one, the value of an expression of constants.

use crate::analysis::Analysis;
use crate::describe;
use crate::position::Encoding;
use crate::values;
use hyde_compiler::Meaning;
use hyde_diag::Span;
use hyde_syntax::ast::{
    Class, ClassBody, Declaration, Declared, Element, Expr, ExprKind, Item, Unary,
};
use hyde_units::format_value;
use lsp_types::{InlayHint, InlayHintKind, InlayHintLabel};
use std::ops::Range;
use std::rc::Rc;

/// The hints of a part of the file itself.
pub(crate) fn hints(
    analysis: &Analysis,
    bytes: &Range<usize>,
    encoding: Encoding,
) -> Vec<InlayHint> {
    let mut found: Vec<(usize, String, InlayHintKind)> = Vec::new();
    let overlaps =
        |span: Span| (span.start as usize) < bytes.end && bytes.start < span.end as usize;
    for (number, (item, span)) in analysis.items().enumerate() {
        let Some(meaning) = overlaps(span).then(|| analysis.meaning(number)).flatten() else {
            continue;
        };
        if let Item::Class(class) = item {
            units(analysis, class, &meaning, &mut found);
        }
        let Some(tree) = analysis.files().file(0) else {
            continue;
        };
        tree.each_expression(&mut |expr| {
            let own = span.start <= expr.span.start && expr.span.end <= span.end;
            if own && !is_plain(expr) {
                let value = value(&meaning, expr.span);
                found.extend(value.map(|text| {
                    (
                        expr.span.end as usize,
                        format!("= {text}"),
                        InlayHintKind::PARAMETER,
                    )
                }));
            }
        });
    }
    found.retain(|(at, ..)| bytes.contains(at));
    found.sort_by_key(|(at, ..)| *at);
    found.dedup_by_key(|(at, ..)| *at);
    let text = analysis.text();
    let hint = |(at, label, kind): (usize, String, InlayHintKind)| InlayHint {
        position: encoding.position(text, at),
        label: InlayHintLabel::String(label),
        kind: Some(kind),
        text_edits: None,
        tooltip: None,
        padding_left: Some(true),
        padding_right: None,
        data: None,
    };
    found.into_iter().map(hint).collect()
}

/// The units of what a class declares without one.
fn units(
    analysis: &Analysis,
    class: &Class,
    meaning: &Rc<Meaning>,
    found: &mut Vec<(usize, String, InlayHintKind)>,
) {
    let ClassBody::Long { elements, .. } = &class.body else {
        return;
    };
    let inner = elements.iter().filter_map(|element| {
        let Element::Clocked(clocked) = element else {
            return None;
        };
        Some(&clocked.elements)
    });
    for element in elements.iter().chain(inner.flatten()) {
        for (name, declared) in element.declared() {
            let Declared::Variable(declaration, declarator) = declared else {
                continue;
            };
            let shown = declarator.binding.as_ref().is_some_and(is_plain);
            if shown || has_unit(analysis, declaration) {
                continue;
            }
            let quantity = values::declared(meaning, name.span);
            found.extend(quantity.map(|own| {
                let label = format!("[{}]", own.unit.text());
                (name.span.end as usize, label, InlayHintKind::TYPE)
            }));
        }
    }
}

/// Whether the type of a declaration says the unit.
fn has_unit(analysis: &Analysis, declaration: &Declaration) -> bool {
    describe::unit(analysis, 0, &declaration.type_name).is_some()
}

/// The value of an expression in the unit of its dimension.
fn value(meaning: &Meaning, span: Span) -> Option<String> {
    let own = meaning.expressions.iter().find(|own| own.span == span)?;
    let quantity = own.quantity.as_ref()?;
    Some(format_value(own.value?, &quantity.unit))
}

/// A literal: its value is to be seen.
fn is_plain(expr: &Expr) -> bool {
    match &expr.kind {
        ExprKind::Number(..) | ExprKind::String(_) | ExprKind::Boolean(_) => true,
        ExprKind::Unary(Unary::Negative | Unary::Positive, inner) => is_plain(inner),
        ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(Unary::Not, _)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => false,
    }
}
