//! Expressions, by precedence climbing.

use super::build::{Builder, Node, parts};
use crate::ast::{
    Argument, Binary, Comprehension, Expr, ExprKind, Part, Range, Reference, Unary, UnitText,
};
use crate::grammar::Rule;
use crate::matcher::Pairs;
use crate::refusals;
use hyde_diag::Span;
use std::iter::Peekable;
/// How strongly an operator between two operands binds them, as in Modelica.
fn strength(operator: Rule) -> u8 {
    match operator {
        Rule::or => 1,
        Rule::and => 2,
        Rule::lt | Rule::le | Rule::gt | Rule::ge | Rule::eq | Rule::ne => 4,
        Rule::plus | Rule::minus => 5,
        Rule::times | Rule::over => 7,
        _ => 8,
    }
}

/// The operator in front of an operand and how strongly it binds it.
fn in_front(rule: Rule) -> Option<(Unary, u8)> {
    match rule {
        Rule::not => Some((Unary::Not, 3)),
        Rule::negative => Some((Unary::Negative, 6)),
        Rule::positive => Some((Unary::Positive, 6)),
        _ => None,
    }
}

impl Builder<'_> {
    /// From an `expression` node.
    pub(super) fn expression(&mut self, node: Node<'_>) -> Expr {
        let span = self.span(&node);
        let mut nodes = node.into_inner().peekable();
        let expr = self.operators(&mut nodes, 0, span);
        Expr { span, ..expr }
    }

    /// The operand that is next with every operator behind it that binds more strongly than `least`; `span` is that of the
    /// whole expression.
    fn operators(&mut self, nodes: &mut Peekable<Pairs<'_>>, least: u8, span: Span) -> Expr {
        let Some(first) = nodes.next() else {
            // The grammar has an operand behind every operator.
            let kind = ExprKind::Number(0.0, None);
            return Expr { kind, span };
        };
        let mut left = match in_front(first.as_rule()) {
            Some((unary, strength)) => {
                let operand = self.operators(nodes, strength - 1, span);
                let span = self.span(&first).to(operand.span);
                let kind = ExprKind::Unary(unary, Box::new(operand));
                Expr { kind, span }
            }
            None => self.primary(first),
        };
        while let Some(next) = nodes.peek() {
            let rule = next.as_rule();
            let strength = strength(rule);
            if strength <= least {
                break;
            }
            let operator = self.span(next);
            nodes.next();
            // A power is taken from the right: `2^3^2` is `2^(3^2)`.
            let from_right = u8::from(rule == Rule::power);
            let right = self.operators(nodes, strength - from_right, span);
            if matches!(rule, Rule::plus | Rule::minus) {
                self.refuse_two_signs(operator, &right);
            }
            let span = left.span.to(right.span);
            let kind = ExprKind::Binary(binary(rule), Box::new(left), Box::new(right));
            left = Expr { kind, span };
        }
        left
    }

    /// From the first expression among the children of a node.
    pub(super) fn first_expression(&mut self, node: Node<'_>) -> Option<Expr> {
        let inner = parts(node).find(|part| part.as_rule() == Rule::expression)?;
        Some(self.expression(inner))
    }

    /// From a `reference` or `path` node.
    pub(super) fn reference(&mut self, node: Node<'_>) -> Reference {
        let span = self.span(&node);
        let mut list = Vec::new();
        for part in parts(node) {
            if part.as_rule() == Rule::ident {
                list.push(Part {
                    name: self.name(&part),
                    subscripts: Vec::new(),
                });
                continue;
            }
            let mut inner = parts(part);
            if let Some(name) = inner.next() {
                let name = match name.as_rule() {
                    Rule::quoted_name => self.quoted_name(&name),
                    _ => self.name(&name),
                };
                let subscripts = inner
                    .flat_map(|subscript| self.subscripts(subscript))
                    .collect();
                list.push(Part { name, subscripts });
            }
        }
        Reference { parts: list, span }
    }

    /// Every expression among the children of a node.
    pub(super) fn expressions(&mut self, node: Node<'_>) -> Vec<Expr> {
        let inner: Vec<_> = parts(node)
            .filter(|part| part.as_rule() == Rule::expression)
            .collect();
        inner
            .into_iter()
            .map(|part| self.expression(part))
            .collect()
    }

    /// From a `subscript` node: expressions and slices.
    pub(super) fn subscripts(&mut self, node: Node<'_>) -> Vec<Expr> {
        let mut list = Vec::new();
        for part in parts(node) {
            if part.as_rule() == Rule::expression {
                list.push(self.expression(part));
                continue;
            }
            if let (Some(last), Some(first)) = (self.first_expression(part), list.pop()) {
                let span = first.span.to(last.span);
                let kind = ExprKind::Slice(Box::new(first), Box::new(last));
                list.push(Expr { kind, span });
            }
        }
        list
    }

    /// From an `arguments` node.
    pub(super) fn arguments(&mut self, node: Node<'_>) -> Vec<Argument> {
        let mut list = Vec::new();
        for argument in parts(node) {
            let mut name = None;
            for part in parts(argument) {
                if part.as_rule() == Rule::ident {
                    name = Some(self.name(&part));
                } else {
                    list.push(Argument {
                        name: name.take(),
                        value: self.expression(part),
                    });
                }
            }
        }
        list
    }

    /// From a `range` node; a unit written at the upper bound belongs to both (U2).
    pub(super) fn range(&mut self, node: Node<'_>) -> Option<Range> {
        let mut bounds = self.expressions(node).into_iter();
        let (mut from, to) = (bounds.next()?, bounds.next()?);
        if let Some(unit) = unit_of(&to)
            && let Some(slot) = missing_unit(&mut from)
        {
            *slot = Some(unit);
        }
        self.refuse_backwards(&from, &to);
        Some(Range { from, to })
    }

    /// `10 +- 2` may be meant as an uncertainty, and would be 8: one sign right behind another is refused.
    fn refuse_two_signs(&mut self, operator: Span, right: &Expr) {
        let ExprKind::Unary(Unary::Negative | Unary::Positive, operand) = &right.kind else {
            return;
        };
        if operator.end != right.span.start {
            return;
        }
        let number = crate::format_expression(operand);
        let signs = operator.to(right.span);
        self.diagnostics.push(refusals::two_signs(signs, &number));
    }

    /// A range of numbers goes upwards.
    fn refuse_backwards(&mut self, from: &Expr, to: &Expr) {
        let (Some((a, unit)), Some((b, other))) = (written(from), written(to)) else {
            return;
        };
        let text = |unit: Option<&UnitText>| unit.map(|unit| unit.text.clone());
        if a <= b || text(unit) != text(other) {
            return;
        }
        let span = from.span.to(to.span);
        let (low, high) = (crate::format_expression(to), crate::format_expression(from));
        self.diagnostics
            .push(refusals::range_downwards(span, (&low, &high)));
    }

    /// From a `counted` node, behind the value of its elements.
    fn comprehension(
        &mut self,
        value: Expr,
        node: Node<'_>,
        unit: Option<crate::ast::UnitText>,
    ) -> Option<Comprehension> {
        let counter = parts(node.clone()).find(|part| part.as_rule() == Rule::ident)?;
        let counter = self.name(&counter);
        let mut list = self.expressions(node).into_iter();
        Some(Comprehension {
            value,
            counter,
            first: list.next()?,
            last: list.next()?,
            unit,
        })
    }

    fn primary(&mut self, node: Node<'_>) -> Expr {
        let span = self.span(&node);
        let kind = match node.as_rule() {
            Rule::quantity => {
                let mut inner = parts(node);
                let value = inner.next().map_or(0.0, |number| self.number(&number));
                ExprKind::Number(value, inner.next().map(|unit| self.unit(unit)))
            }
            Rule::string => ExprKind::String(Self::string(&node)),
            Rule::boolean => ExprKind::Boolean(node.as_str().trim() == "true"),
            Rule::conditional => {
                let mut list = self.expressions(node).into_iter();
                let mut branches = Vec::new();
                let otherwise = loop {
                    match (list.next(), list.next()) {
                        (Some(condition), Some(value)) => branches.push((condition, value)),
                        (Some(otherwise), None) => break otherwise,
                        (None, _) => {
                            break Expr {
                                kind: ExprKind::Number(0.0, None),
                                span,
                            };
                        }
                    }
                };
                ExprKind::If(branches, Box::new(otherwise))
            }
            Rule::array => {
                let unit = parts(node.clone()).find(|part| part.as_rule() == Rule::unit);
                let unit = unit.map(|unit| self.unit(unit));
                let counted = parts(node.clone()).find(|part| part.as_rule() == Rule::counted);
                let mut elements = self.expressions(node);
                let value = counted.as_ref().and_then(|_| elements.pop());
                let list = value
                    .zip(counted)
                    .and_then(|(value, counted)| self.comprehension(value, counted, unit.clone()));
                match list {
                    Some(list) => ExprKind::Comprehension(Box::new(list)),
                    None => ExprKind::Array(elements, unit),
                }
            }
            Rule::named => {
                let mut inner = parts(node);
                let name = inner.next().map(|part| self.reference(part));
                let name = name.unwrap_or(Reference {
                    parts: Vec::new(),
                    span,
                });
                match inner.next() {
                    Some(part) => ExprKind::Call(name, self.arguments(part)),
                    None => ExprKind::Reference(name),
                }
            }
            // A group is its expression; the span keeps the parentheses.
            _ => match parts(node).next() {
                Some(inner) => self.expression(inner).kind,
                None => ExprKind::Number(0.0, None),
            },
        };
        Expr { kind, span }
    }
}

fn unit_of(expr: &Expr) -> Option<crate::ast::UnitText> {
    match &expr.kind {
        ExprKind::Number(_, unit) => unit.clone(),
        ExprKind::Unary(_, inner) => unit_of(inner),
        ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => None,
    }
}

fn missing_unit(expr: &mut Expr) -> Option<&mut Option<crate::ast::UnitText>> {
    match &mut expr.kind {
        ExprKind::Number(_, unit) => unit.is_none().then_some(unit),
        ExprKind::Unary(_, inner) => missing_unit(inner),
        ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => None,
    }
}

fn binary(rule: Rule) -> Binary {
    match rule {
        Rule::or => Binary::Or,
        Rule::and => Binary::And,
        Rule::lt => Binary::Lt,
        Rule::le => Binary::Le,
        Rule::gt => Binary::Gt,
        Rule::ge => Binary::Ge,
        Rule::eq => Binary::Eq,
        Rule::ne => Binary::Ne,
        Rule::plus => Binary::Add,
        Rule::minus => Binary::Sub,
        Rule::times => Binary::Mul,
        Rule::over => Binary::Div,
        _ => Binary::Pow,
    }
}

/// A number as it is written, with a sign, and its unit.
fn written(expr: &Expr) -> Option<(f64, Option<&UnitText>)> {
    if let ExprKind::Unary(Unary::Negative, inner) = &expr.kind {
        return written(inner).map(|(number, unit)| (-number, unit));
    }
    if let ExprKind::Number(number, unit) = &expr.kind {
        return Some((*number, unit.as_ref()));
    }
    None
}
