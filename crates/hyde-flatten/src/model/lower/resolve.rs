//! Names: what they stand for in scope.

use super::resolved::Resolved;
use super::subscript::{mentions_counter, without_elements};
use crate::experiment::record_column;
use crate::instance::{Elementwise, FieldPlace, InstanceId, Member, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::values as refused;
use hyde_diag::Span;
use hyde_syntax::ast::{Expr, ExprKind, Reference};

impl<'a> Model<'a, '_> {
    /// What a name stands for in a function.
    fn in_function(
        &mut self,
        reference: &'a Reference,
        values: &[(&'a str, Typed)],
    ) -> Option<Resolved> {
        let word = reference.as_word();
        if let Some((_, value)) = values.iter().rev().find(|(name, _)| Some(*name) == word) {
            return Some(Resolved::Value(value.clone()));
        }
        if word == Some("pi") {
            return Some(Resolved::Pi);
        }
        let known: Vec<&str> = values.iter().map(|(name, _)| *name).collect();
        self.report(refused::unknown_in_function(reference, &known));
        None
    }

    /// What a name stands for; reported if nothing.
    pub(crate) fn resolve(
        &mut self,
        reference: &'a Reference,
        scope: &Scope<'a>,
    ) -> Option<Resolved> {
        let first = reference.parts.first()?;
        let word = first.name.text.as_str();
        let single = reference.parts.len() == 1 && first.subscripts.is_empty();
        let counter = scope.counters.iter().rev();
        let counter = counter.filter(|_| single).find(|(name, _)| *name == word);
        if let Some((_, counter)) = counter {
            return Some(Resolved::Counter(*counter));
        }
        if let Some(values) = &scope.values {
            return self.in_function(reference, values);
        }
        if single {
            if let Some((_, var)) = scope.locals.iter().rev().find(|(name, _)| *name == word) {
                return Some(Resolved::Variable(*var, None));
            }
            if let (Setting::Measure, Some((_, value))) = (
                scope.setting,
                self.measured_numbers.iter().find(|(name, _)| *name == word),
            ) {
                return Some(Resolved::Value(value.clone()));
            }
            if self.coordinate(scope) == Some(word) {
                return Some(Resolved::Coordinate);
            }
        }
        if scope.records
            && self
                .flat
                .experiment
                .records
                .iter()
                .any(|record| record == word)
        {
            return record_column(self, reference, scope);
        }
        let mut at = scope.instance;
        let mut member = loop {
            if let Some(member) = self.tree[at].members.get(word) {
                break member.clone();
            }
            match (self.tree[at].outer, word) {
                (Some(outer), _) => at = outer,
                (None, "time") => return Some(Resolved::Time),
                (None, "pi") => return Some(Resolved::Pi),
                (None, _) => {
                    self.unknown_name(scope, scope.instance, word, reference);
                    return None;
                }
            }
        };
        let mut parts = reference.parts.iter();
        let mut part = parts.next()?;
        loop {
            let subscript = match part.subscripts.as_slice() {
                [] => None,
                [subscript] => Some(subscript),
                [_, second, ..] => {
                    self.report(refused::second_subscript(second.span));
                    return None;
                }
            };
            let instance = match member {
                Member::Variable(var) => {
                    let variable = &self.flat.variables[var];
                    let (len, first) = (variable.len, variable.first);
                    let rest = parts.next();
                    let index = self.element(subscript, len, first, scope, reference)?;
                    return self
                        .last(rest, reference)
                        .then_some(Resolved::Variable(var, index));
                }
                Member::Parameter(param) => {
                    let len = self.flat.parameters[param].len;
                    let rest = parts.next();
                    let index = self.element(subscript, len, 1, scope, reference)?;
                    return self
                        .last(rest, reference)
                        .then_some(Resolved::Parameter(param, index));
                }
                Member::Domain(_) => {
                    self.report(refused::domain_as_value(&part.name.text, reference.span));
                    return None;
                }
                Member::Instance(instance) if subscript.is_none() => instance,
                Member::Instance(_) => {
                    self.report(refused::not_an_array(reference));
                    return None;
                }
                Member::Instances(list) => {
                    let at = reference.parts.len() - 1 - parts.len();
                    self.one_of(&list, (at, subscript), scope, reference)?
                }
            };
            let Some(next) = parts.next() else {
                return Some(Resolved::Instance(instance));
            };
            let word = next.name.text.as_str();
            let Some(inner) = self.tree[instance].members.get(word) else {
                self.unknown_name(scope, instance, word, reference);
                return None;
            };
            member = inner.clone();
            part = next;
        }
    }

    fn one_of(
        &mut self,
        list: &[InstanceId],
        (at, subscript): (usize, Option<&'a Expr>),
        scope: &Scope<'a>,
        reference: &Reference,
    ) -> Option<InstanceId> {
        let slice = subscript.and_then(|subscript| {
            if let ExprKind::Slice(first, _) = &subscript.kind {
                Some((subscript, &**first))
            } else {
                None
            }
        });
        if let (true, Some(elements)) = (subscript.is_none() || slice.is_some(), scope.elementwise)
        {
            return self.one_of_whole(list, slice, elements, scope, reference.span);
        }
        let Some(subscript) = subscript.filter(|_| slice.is_none()) else {
            let words: Vec<&str> = reference
                .parts
                .iter()
                .map(|part| part.name.text.as_str())
                .collect();
            let (array, rest) = words.split_at(at + 1);
            let array = array.join(".");
            let one: String = rest.iter().map(|word| format!(".{word}")).collect();
            self.report(refused::which_component(
                (&array, &one),
                list.len(),
                reference.span,
            ));
            return None;
        };
        if mentions_counter(subscript, scope) {
            self.unroll();
            return None;
        }
        let number = self.structural_integer_in(scope, subscript)?;
        let found = usize::try_from(number - 1)
            .ok()
            .and_then(|at| list.get(at))
            .copied();
        if found.is_none() {
            self.report(refused::no_component(list.len(), (subscript.span, number)));
        }
        found
    }

    /// The component of an array of them, or of a slice of it, that is meant where whole arrays stand for one element.
    fn one_of_whole(
        &mut self,
        list: &[InstanceId],
        slice: Option<(&'a Expr, &'a Expr)>,
        elements: Elementwise,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<InstanceId> {
        let Elementwise::One(position) = elements else {
            self.unroll();
            return None;
        };
        let (start, count) = match slice {
            None => (0, list.len()),
            Some((slice, first)) => {
                let count = self.slice_length(slice, scope)?;
                let first = self.structural_integer_in(&without_elements(scope), first)?;
                (usize::try_from(first - 1).unwrap_or(usize::MAX), count)
            }
        };
        if count != position.of {
            self.report(refused::numbers_of_components(count, position.of, span));
            return None;
        }
        let found = list.get(start.saturating_add(position.at)).copied();
        if found.is_none() {
            self.report(refused::components_out_of_range(list.len(), span));
        }
        found
    }

    pub(super) fn last(
        &mut self,
        rest: Option<&hyde_syntax::ast::Part>,
        reference: &Reference,
    ) -> bool {
        let Some(part) = rest else { return true };
        self.report(refused::part_of_value(reference, &part.name));
        false
    }

    /// The name of the coordinate where a field expression is being lowered.
    fn coordinate(&self, scope: &Scope<'a>) -> Option<&'a str> {
        match scope.place {
            FieldPlace::Nowhere => None,
            FieldPlace::Node(domain, _) | FieldPlace::Cell(domain, _) => {
                (self.domains[domain].instance == scope.instance)
                    .then(|| self.domains[domain].coordinate)
            }
        }
    }
}
