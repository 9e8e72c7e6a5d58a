//! Expressions.

use super::{Name, Reference, UnitText};
use hyde_diag::Span;

/// An expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Its place.
    pub span: Span,
}

impl Expr {
    /// The expressions directly below this one, in the order written; subscripts of references are none of them.
    #[must_use]
    pub fn children(&self) -> Vec<&Self> {
        match &self.kind {
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Reference(_) => Vec::new(),
            ExprKind::Call(_, arguments) => {
                arguments.iter().map(|argument| &argument.value).collect()
            }
            ExprKind::Unary(_, inner) => vec![&**inner],
            ExprKind::Binary(_, left, right) => vec![&**left, &**right],
            ExprKind::If(branches, otherwise) => branches
                .iter()
                .flat_map(|(condition, value)| [condition, value])
                .chain([&**otherwise])
                .collect(),
            ExprKind::Array(items, _) => items.iter().collect(),
            ExprKind::Comprehension(list) => vec![&list.value, &list.first, &list.last],
            ExprKind::Slice(first, last) => vec![&**first, &**last],
        }
    }

    /// The same, to be changed.
    pub fn children_mut(&mut self) -> Vec<&mut Self> {
        match &mut self.kind {
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Reference(_) => Vec::new(),
            ExprKind::Call(_, arguments) => arguments
                .iter_mut()
                .map(|argument| &mut argument.value)
                .collect(),
            ExprKind::Unary(_, inner) => vec![&mut **inner],
            ExprKind::Binary(_, left, right) => vec![&mut **left, &mut **right],
            ExprKind::If(branches, otherwise) => branches
                .iter_mut()
                .flat_map(|(condition, value)| [condition, value])
                .chain([&mut **otherwise])
                .collect(),
            ExprKind::Array(items, _) => items.iter_mut().collect(),
            ExprKind::Comprehension(list) => {
                vec![&mut list.value, &mut list.first, &mut list.last]
            }
            ExprKind::Slice(first, last) => vec![&mut **first, &mut **last],
        }
    }

    /// Whether this expression or one below it satisfies `test`.
    pub fn any(&self, test: &impl Fn(&Self) -> bool) -> bool {
        test(self) || self.children().into_iter().any(|child| child.any(test))
    }

    /// Whether it or an expression below it calls the function of that name.
    #[must_use]
    pub fn calls(&self, function: &str) -> bool {
        self.any(&|expr| {
            matches!(&expr.kind, ExprKind::Call(name, _) if name.as_word() == Some(function))
        })
    }
}

/// Operators on one value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unary {
    /// `-a`
    Negative,
    /// `+a`
    Positive,
    /// `not a`
    Not,
}

/// Operators on two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    /// `a + b`
    Add,
    /// `a - b`
    Sub,
    /// `a * b`
    Mul,
    /// `a / b`
    Div,
    /// `a ^ b`
    Pow,
    /// `a < b`
    Lt,
    /// `a <= b`
    Le,
    /// `a > b`
    Gt,
    /// `a >= b`
    Ge,
    /// `a == b`
    Eq,
    /// `a <> b`
    Ne,
    /// `a and b`
    And,
    /// `a or b`
    Or,
}

/// The kinds of expressions.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `0.35 [ohm]`
    Number(f64, Option<UnitText>),
    /// `"text"`
    String(String),
    /// `true`, `false`
    Boolean(bool),
    /// `motor.phi`
    Reference(Reference),
    /// `der(x)`, `th.at(xn)`, `max(a, b)`
    Call(Reference, Vec<Argument>),
    /// `-a`
    Unary(Unary, Box<Expr>),
    /// `a + b`
    Binary(Binary, Box<Expr>, Box<Expr>),
    /// `if a then b elseif c then d else e`
    If(Vec<(Expr, Expr)>, Box<Expr>),
    /// `{1, 2, 3} [mm]`
    Array(Vec<Expr>, Option<UnitText>),
    /// `{i^2 for i in 1:n} [mm]`
    Comprehension(Box<Comprehension>),
    /// `2:n`, as a subscript: these elements of an array.
    Slice(Box<Expr>, Box<Expr>),
}

/// `{value for counter in first:last} [unit]`
#[derive(Clone, Debug, PartialEq)]
pub struct Comprehension {
    /// The value of an element.
    pub value: Expr,
    /// What counts the elements.
    pub counter: Name,
    /// Its first value.
    pub first: Expr,
    /// Its last value.
    pub last: Expr,
    /// The unit of the plain numbers among the values.
    pub unit: Option<UnitText>,
}

/// An argument of a call, named or not.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// `n` in `fem(n = 24)`.
    pub name: Option<Name>,
    /// Its value.
    pub value: Expr,
}

/// `a .. b`
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Lower bound.
    pub from: Expr,
    /// Upper bound.
    pub to: Expr,
}
