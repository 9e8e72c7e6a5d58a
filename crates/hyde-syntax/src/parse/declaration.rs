//! Declarations, modifications, modes, domains, and the elements of effects.

use super::build::{Builder, Node, has, parts};
use crate::ast::{
    AccountKind, Change, Declaration, Declarator, Discretize, Domain, Element, Exit, Measure, Mode,
    Modes, Prefix, Prior,
};
use crate::grammar::Rule;
use crate::refusals;

impl Builder<'_> {
    /// From one of the nodes that `element` yields, clocked parts and sections apart.
    pub(super) fn element(&mut self, node: Node<'_>) -> Option<Element> {
        Some(match node.as_rule() {
            Rule::extends_clause => {
                let mut inner = parts(node);
                let base = self.reference(inner.next()?);
                Element::Extends(
                    base,
                    inner
                        .next()
                        .map_or_else(Vec::new, |part| self.changes(part)),
                )
            }
            Rule::declaration => Element::Declaration(self.declaration(node)?),
            Rule::domain => {
                let mut inner = parts(node);
                let name = self.name(&inner.next()?);
                let coordinate = self.name(&inner.next()?);
                Element::Domain(Domain {
                    name,
                    coordinate,
                    range: self.range(inner.next()?)?,
                })
            }
            Rule::discretize => {
                let mut inner = parts(node);
                let domain = self.name(&inner.next()?);
                let method = self.name(&inner.next()?);
                let arguments = inner
                    .next()
                    .map_or_else(Vec::new, |part| self.arguments(part));
                Element::Discretize(Discretize {
                    domain,
                    method,
                    arguments,
                })
            }
            Rule::modes => Element::Modes(self.modes(node)?),
            Rule::wrap => {
                let mut inner = parts(node);
                let site = self.reference(inner.next()?);
                Element::Wrap(site, self.expression(inner.next()?))
            }
            Rule::added => Element::Add(self.equation(parts(node).next()?)?),
            Rule::replaced => {
                let mut inner = parts(node);
                let component = self.reference(inner.next()?);
                let by = self.reference(inner.next()?);
                Element::Replace(
                    component,
                    by,
                    inner
                        .next()
                        .map_or_else(Vec::new, |part| self.changes(part)),
                )
            }
            Rule::signature => {
                let marks = parts(node).filter_map(|mark| {
                    let mut inner = parts(mark);
                    let name = self.name(&inner.next()?);
                    Some((
                        name,
                        inner
                            .next()
                            .map_or_else(Vec::new, |part| self.arguments(part)),
                    ))
                });
                Element::Signature(marks.collect())
            }
            Rule::confounds => {
                Element::Confounds(parts(node).map(|part| self.reference(part)).collect())
            }
            Rule::measure => Element::Measure(self.measure(parts(node))?),
            Rule::account => {
                let mut inner = parts(node);
                let kind = match inner.next()?.as_str().trim() {
                    "stored" => AccountKind::Stored,
                    "dissipated" => AccountKind::Dissipated,
                    _ => AccountKind::Supplied,
                };
                Element::Account(kind, self.measure(inner)?)
            }
            _ => Element::Equation(self.equation(node)?),
        })
    }

    /// From the parts of a `measure` node.
    pub(super) fn measure<'n>(
        &mut self,
        mut inner: impl Iterator<Item = Node<'n>>,
    ) -> Option<Measure> {
        let type_name = self.reference(inner.next()?);
        let name = self.name(&inner.next()?);
        let value = self.expression(inner.next()?);
        let (mut unit, mut doc) = (None, None);
        for part in inner {
            match part.as_rule() {
                Rule::unit => unit = Some(self.unit(part)),
                _ => doc = Some(Self::text(part)),
            }
        }
        Some(Measure {
            type_name,
            name,
            value,
            unit,
            doc,
        })
    }

    /// From a `modification` node.
    pub(super) fn changes(&mut self, node: Node<'_>) -> Vec<Change> {
        parts(node)
            .filter_map(|change| self.only_change(change))
            .collect()
    }

    /// The change of a node that is one.
    pub(super) fn only_change(&mut self, node: Node<'_>) -> Option<Change> {
        self.change(parts(node).next()?)
    }

    fn change(&mut self, node: Node<'_>) -> Option<Change> {
        let (each, is_final) = (has(&node, Rule::kw_each), has(&node, Rule::kw_final));
        let redeclaration = node.as_rule() == Rule::redeclaration;
        let mut inner = parts(node);
        let redeclare = if redeclaration {
            Some(self.reference(inner.next()?))
        } else {
            None
        };
        let target = inner.next()?;
        let target = if target.as_rule() == Rule::ident {
            let name = self.name(&target);
            let span = name.span;
            crate::ast::Reference {
                parts: vec![crate::ast::Part {
                    name,
                    subscripts: Vec::new(),
                }],
                span,
            }
        } else {
            self.reference(target)
        };
        let mut change = Change {
            target,
            redeclare,
            each,
            is_final,
            changes: Vec::new(),
            value: None,
            prior: None,
            source: None,
        };
        for part in inner {
            match part.as_rule() {
                Rule::modification => change.changes = self.changes(part),
                Rule::binding => change.value = self.first_expression(part),
                Rule::prior => change.prior = self.prior(part),
                _ => change.source = Some(Self::text(part)),
            }
        }
        Some(change)
    }

    fn declaration(&mut self, node: Node<'_>) -> Option<Declaration> {
        let span = self.span(&node);
        let mut declaration = Declaration {
            prefixes: Vec::new(),
            type_name: crate::ast::Reference {
                parts: Vec::new(),
                span,
            },
            dims: Vec::new(),
            declarators: Vec::new(),
            span,
        };
        for part in parts(node) {
            match part.as_rule() {
                Rule::prefix_word => declaration.prefixes.push(prefix(part.as_str().trim())),
                Rule::path => declaration.type_name = self.reference(part),
                Rule::subscript => declaration.dims = self.subscripts(part),
                _ => declaration.declarators.push(self.declarator(part)?),
            }
        }
        if let (Some("der"), Some(first)) = (
            declaration.type_name.as_word(),
            declaration.declarators.first(),
        ) {
            let here = declaration.type_name.span.to(first.name.span);
            let refusal = refusals::derivative_without_parentheses(&first.name, here);
            self.diagnostics.push(refusal);
            return None;
        }
        Some(declaration)
    }

    fn declarator(&mut self, node: Node<'_>) -> Option<Declarator> {
        let mut inner = parts(node);
        let name = self.name(&inner.next()?);
        let mut declarator = Declarator {
            name,
            dims: Vec::new(),
            changes: Vec::new(),
            domain: None,
            binding: None,
            prior: None,
            source: None,
            within: None,
            over: Vec::new(),
            doc: None,
        };
        for part in inner {
            match part.as_rule() {
                Rule::subscript => declarator.dims = self.subscripts(part),
                Rule::modification => declarator.changes = self.changes(part),
                Rule::on_domain => {
                    declarator.domain = parts(part).next().map(|name| self.name(&name))
                }
                Rule::binding => declarator.binding = self.first_expression(part),
                Rule::prior => declarator.prior = self.prior(part),
                Rule::source => declarator.source = Some(Self::text(part)),
                Rule::within => {
                    declarator.within = parts(part).next().and_then(|range| self.range(range))
                }
                Rule::over_variables => declarator.over = self.arguments(part),
                _ => declarator.doc = Some(Self::text(part)),
            }
        }
        Some(declarator)
    }

    fn prior(&mut self, node: Node<'_>) -> Option<Prior> {
        let span = self.span(&node);
        let mut prior = Prior {
            value: 0.0,
            percent: false,
            unit: None,
            span,
        };
        for part in parts(node) {
            match part.as_rule() {
                Rule::number => prior.value = self.number(&part),
                Rule::percent => prior.percent = true,
                Rule::unit => prior.unit = Some(self.unit(part)),
                _ => {}
            }
        }
        Some(prior)
    }

    fn modes(&mut self, node: Node<'_>) -> Option<Modes> {
        let span = self.span(&node);
        let mut name = None;
        let mut initial = None;
        let mut arguments = Vec::new();
        let mut modes = Vec::new();
        for part in parts(node) {
            match part.as_rule() {
                Rule::modes_name => name = parts(part).next().map(|inner| self.name(&inner)),
                Rule::ident => initial = Some(self.name(&part)),
                Rule::arguments => arguments = self.arguments(part),
                _ => modes.push(self.mode(part)?),
            }
        }
        Some(Modes {
            name,
            initial: initial?,
            arguments,
            modes,
            span,
        })
    }

    fn mode(&mut self, node: Node<'_>) -> Option<Mode> {
        let mut inner = parts(node);
        let mut mode = Mode {
            name: self.name(&inner.next()?),
            parameters: Vec::new(),
            equations: Vec::new(),
            enter: Vec::new(),
            leave: Vec::new(),
            exits: Vec::new(),
        };
        for part in inner {
            match part.as_rule() {
                Rule::mode_parameters => {
                    for parameter in parts(part) {
                        let mut words = parts(parameter);
                        let type_name = self.reference(words.next()?);
                        mode.parameters.push((type_name, self.name(&words.next()?)));
                    }
                }
                Rule::enter => mode.enter.extend(self.equations(parts(part))),
                Rule::leave => mode.leave.extend(self.equations(parts(part))),
                Rule::exit => mode.exits.push(self.exit(part)?),
                _ => mode.equations.push(self.equation(part)?),
            }
        }
        Some(mode)
    }

    fn exit(&mut self, node: Node<'_>) -> Option<Exit> {
        let span = self.span(&node);
        let mut inner = parts(node);
        let guard = self.expression(inner.next()?);
        let target = self.name(&inner.next()?);
        let mut exit = Exit {
            guard,
            target,
            arguments: Vec::new(),
            impact: false,
            actions: Vec::new(),
            span,
        };
        for part in inner {
            match part.as_rule() {
                Rule::arguments => exit.arguments = self.arguments(part),
                Rule::exit_impact => exit.impact = true,
                _ => exit.actions = self.equations(parts(part)),
            }
        }
        Some(exit)
    }
}

fn prefix(word: &str) -> Prefix {
    match word {
        "parameter" => Prefix::Parameter,
        "constant" => Prefix::Constant,
        "final" => Prefix::Final,
        "flow" => Prefix::Flow,
        "input" => Prefix::Input,
        "output" => Prefix::Output,
        "replaceable" => Prefix::Replaceable,
        "site" => Prefix::Site,
        "field" => Prefix::Field,
        "size" => Prefix::Size,
        _ => Prefix::Shape,
    }
}
