//! Expressions as they are written, with parentheses only where the tree needs them.

use super::name::{bracketed, quoted, reference};
use crate::ast::{Argument, Binary, Expr, ExprKind, Range, Unary};
use std::fmt::Write as _;

/// An expression.
#[must_use]
pub fn expression(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number(value, unit) => format!("{}{}", number(*value), bracketed(unit.as_ref())),
        ExprKind::String(text) => quoted(text),
        ExprKind::Boolean(value) => value.to_string(),
        ExprKind::Reference(name) => reference(name),
        ExprKind::Call(name, arguments) => {
            format!("{}{}", reference(name), call_arguments(arguments))
        }
        ExprKind::Unary(op, inner) => {
            let text = within(inner, level(expr) + 1);
            match op {
                Unary::Negative => format!("-{text}"),
                Unary::Positive => format!("+{text}"),
                Unary::Not => format!("not {text}"),
            }
        }
        ExprKind::Binary(op, left, right) => {
            let level = level(expr);
            let right_associative = *op == Binary::Pow;
            let left = within(left, if right_associative { level + 1 } else { level });
            let right = within(right, if right_associative { level } else { level + 1 });
            match op {
                Binary::Mul | Binary::Div | Binary::Pow => format!("{left}{}{right}", symbol(*op)),
                Binary::Add
                | Binary::Sub
                | Binary::Lt
                | Binary::Le
                | Binary::Gt
                | Binary::Ge
                | Binary::Eq
                | Binary::Ne
                | Binary::And
                | Binary::Or => format!("{left} {} {right}", symbol(*op)),
            }
        }
        ExprKind::If(branches, otherwise) => {
            let mut text = String::new();
            for (index, (condition, value)) in branches.iter().enumerate() {
                let word = if index == 0 { "if" } else { "elseif" };
                let _ = write!(
                    text,
                    "{word} {} then {} ",
                    expression(condition),
                    expression(value)
                );
            }
            let _ = write!(text, "else {}", expression(otherwise));
            text
        }
        ExprKind::Array(items, unit) => {
            let items: Vec<String> = items.iter().map(expression).collect();
            format!("{{{}}}{}", items.join(", "), bracketed(unit.as_ref()))
        }
        ExprKind::Comprehension(list) => format!(
            "{{{} for {} in {}:{}}}{}",
            expression(&list.value),
            list.counter.text,
            expression(&list.first),
            expression(&list.last),
            bracketed(list.unit.as_ref())
        ),
        ExprKind::Slice(first, last) => format!("{}:{}", expression(first), expression(last)),
    }
}

/// `(a, n = b)`, also where there are none.
pub(super) fn call_arguments(arguments: &[Argument]) -> String {
    let texts: Vec<String> = arguments
        .iter()
        .map(|argument| match &argument.name {
            Some(name) => format!("{} = {}", name.text, expression(&argument.value)),
            None => expression(&argument.value),
        })
        .collect();
    format!("({})", texts.join(", "))
}

/// The arguments, or nothing where there are none.
pub(super) fn optional_arguments(arguments: &[Argument]) -> String {
    if arguments.is_empty() {
        String::new()
    } else {
        call_arguments(arguments)
    }
}

/// `a .. b`
pub(super) fn range(range: &Range) -> String {
    format!("{} .. {}", expression(&range.from), expression(&range.to))
}

fn number(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

fn symbol(op: Binary) -> &'static str {
    match op {
        Binary::Add => "+",
        Binary::Sub => "-",
        Binary::Mul => "*",
        Binary::Div => "/",
        Binary::Pow => "^",
        Binary::Lt => "<",
        Binary::Le => "<=",
        Binary::Gt => ">",
        Binary::Ge => ">=",
        Binary::Eq => "==",
        Binary::Ne => "<>",
        Binary::And => "and",
        Binary::Or => "or",
    }
}

/// How tightly an expression binds.
fn level(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::If(..) => 0,
        ExprKind::Binary(op, ..) => match op {
            Binary::Or => 1,
            Binary::And => 2,
            Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge | Binary::Eq | Binary::Ne => 4,
            Binary::Add | Binary::Sub => 5,
            Binary::Mul | Binary::Div => 7,
            Binary::Pow => 8,
        },
        ExprKind::Unary(Unary::Not, _) => 3,
        ExprKind::Unary(Unary::Negative | Unary::Positive, _) => 6,
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => 9,
    }
}

fn within(expr: &Expr, least: u8) -> String {
    let text = expression(expr);
    if level(expr) < least {
        format!("({text})")
    } else {
        text
    }
}
