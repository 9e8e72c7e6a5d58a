//! Equations and what stands among them.

use super::build::{Builder, Node, has, parts};
use crate::ast::{Equation, EquationKind, Expr, ExprKind, Place};
use crate::grammar::Rule;

impl Builder<'_> {
    /// From an `equation` node, or from one of its kinds.
    pub(super) fn equation(&mut self, node: Node<'_>) -> Option<Equation> {
        let node = if node.as_rule() == Rule::equation {
            parts(node).next()?
        } else {
            node
        };
        let span = self.span(&node);
        let kind = match node.as_rule() {
            Rule::equality => {
                let mut sides = Vec::new();
                let mut place = None;
                for part in parts(node) {
                    if part.as_rule() == Rule::place {
                        place = self.place(part);
                    } else {
                        sides.push(self.expression(part));
                    }
                }
                let mut sides = sides.into_iter();
                EquationKind::Equality {
                    lhs: sides.next()?,
                    rhs: sides.next()?,
                    place,
                }
            }
            Rule::connection => {
                EquationKind::Connect(parts(node).map(|part| self.reference(part)).collect())
            }
            Rule::for_equation => {
                let mut inner = parts(node);
                let counter = self.name(&inner.next()?);
                let first = self.expression(inner.next()?);
                let last = self.expression(inner.next()?);
                EquationKind::For {
                    counter,
                    first,
                    last,
                    equations: self.equations(inner),
                }
            }
            Rule::if_equation => {
                let has_else = has(&node, Rule::kw_else);
                let (mut branches, otherwise) = self.branches(node, has_else);
                if branches.is_empty() {
                    branches.push((
                        Expr {
                            kind: ExprKind::Boolean(false),
                            span,
                        },
                        Vec::new(),
                    ));
                }
                EquationKind::If {
                    branches,
                    otherwise,
                }
            }
            Rule::when_equation => EquationKind::When(self.branches(node, false).0),
            Rule::assertion => {
                let mut inner = parts(node);
                let condition = self.expression(inner.next()?);
                EquationKind::Assert(condition, Self::string(&inner.next()?))
            }
            Rule::reinit => {
                let mut inner = parts(node);
                let state = self.reference(inner.next()?);
                EquationKind::Reinit(state, self.expression(inner.next()?))
            }
            _ => return None,
        };
        Some(Equation { kind, span })
    }

    /// From a sequence of `equation` nodes.
    pub(super) fn equations<'a>(&mut self, nodes: impl Iterator<Item = Node<'a>>) -> Vec<Equation> {
        nodes.filter_map(|node| self.equation(node)).collect()
    }

    /// Conditions with their equations, then the equations of `else`.
    fn branches(
        &mut self,
        node: Node<'_>,
        has_else: bool,
    ) -> (Vec<(Expr, Vec<Equation>)>, Vec<Equation>) {
        let mut branches = Vec::new();
        let mut condition = None;
        let mut otherwise = Vec::new();
        for part in parts(node) {
            if part.as_rule() == Rule::expression {
                condition = Some(self.expression(part));
            } else {
                let equations = self.equations(parts(part));
                match condition.take() {
                    Some(condition) => branches.push((condition, equations)),
                    None if has_else => otherwise = equations,
                    None => {}
                }
            }
        }
        (branches, otherwise)
    }

    fn place(&mut self, node: Node<'_>) -> Option<Place> {
        let mut domain = None;
        let mut end = None;
        let mut loads = Vec::new();
        for part in parts(node) {
            if part.as_rule() == Rule::load {
                let mut inner = self.expressions(part).into_iter();
                if let (Some(at), Some(force)) = (inner.next(), inner.next()) {
                    loads.push((at, force));
                }
            } else if domain.is_none() {
                domain = Some(self.name(&part));
            } else {
                end = Some(self.name(&part));
            }
        }
        Some(Place {
            domain: domain?,
            end,
            loads,
        })
    }
}
