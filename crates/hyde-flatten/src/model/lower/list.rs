//! Lists: `{1, 2, 3} [kg]` and `{i^2 for i in 1:n} [mm]`, an element at a time.

use super::subscript::without_elements;
use crate::dimension::Dim;
use crate::instance::{Counter, Elementwise, InstanceId, Scope, Typed};
use crate::model::Model;
use crate::refusals::values as refused;
use hyde_syntax::ast::{Comprehension, Expr, ExprKind, UnitText};
use hyde_units::NamedUnit;

/// More elements than this are a mistake.
const MOST: i64 = 1_000_000;

impl<'a> Model<'a, '_> {
    /// Lowers a list where an expression stands: the element meant.
    pub(super) fn list(&mut self, list: &'a Expr, scope: &Scope<'a>) -> Typed {
        match scope.elementwise {
            // Elements of a list have no common form: the equation is unrolled.
            Some(Elementwise::Range(_)) => {
                self.unroll();
                self.poison(list.span)
            }
            Some(Elementwise::One(position)) => {
                if let Some(len) = self.list_length(list, scope)
                    && len != position.of
                {
                    self.report(refused::lengths_of_list_differ(len, position.of, list.span));
                    return self.poison(list.span);
                }
                self.list_item(list, position.at, &without_elements(scope))
            }
            None => {
                self.report(refused::list_for_value(list.span));
                self.poison(list.span)
            }
        }
    }

    /// How many elements a list has; `None` if it is no list, or if that is no number (reported).
    pub(crate) fn list_length(&mut self, list: &'a Expr, scope: &Scope<'a>) -> Option<usize> {
        if let ExprKind::Array(items, _) = &list.kind {
            return Some(items.len());
        }
        let ExprKind::Comprehension(counted) = &list.kind else {
            return None;
        };
        let (first, last) = self.bounds(&counted.first, &counted.last, scope)?;
        let len = last - first + 1;
        if len > MOST {
            self.report(refused::long_list(len, MOST, list.span));
            return None;
        }
        Some(usize::try_from(len).unwrap_or(0))
    }

    /// How many elements a slice `first:last` has.
    pub(crate) fn slice_length(&mut self, slice: &'a Expr, scope: &Scope<'a>) -> Option<usize> {
        let ExprKind::Slice(first, last) = &slice.kind else {
            return None;
        };
        let (first, last) = self.bounds(first, last, scope)?;
        Some(usize::try_from(last - first + 1).unwrap_or(0))
    }

    fn bounds(&mut self, first: &'a Expr, last: &'a Expr, scope: &Scope<'a>) -> Option<(i64, i64)> {
        let scope = without_elements(scope);
        let first = self.structural_integer_in(&scope, first)?;
        Some((first, self.structural_integer_in(&scope, last)?))
    }

    /// An element of a list, from 0. Its plain numbers have the unit behind the list.
    pub(crate) fn list_item(&mut self, list: &'a Expr, at: usize, scope: &Scope<'a>) -> Typed {
        let (item, unit, scope) = match &list.kind {
            ExprKind::Array(items, unit) => match items.get(at) {
                Some(item) => (item, unit.as_ref(), scope.clone()),
                None => return self.poison(list.span),
            },
            ExprKind::Comprehension(counted) => {
                let scope = self.counted(counted, at, scope);
                (&counted.value, counted.unit.as_ref(), scope)
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Reference(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Slice(..) => return self.poison(list.span),
        };
        let typed = self.lower(item, &scope);
        self.in_unit(typed, unit)
    }

    /// Values of one dimension, taken one after another: a zero may be of any, and those behind it say which one.
    pub(crate) fn agreeing(
        &mut self,
        before: Option<Typed>,
        next: Typed,
        what: &'static str,
        instance: InstanceId,
    ) -> Typed {
        match before.filter(|before| before.dim != Dim::Any) {
            Some(before) => {
                self.agree(&before, &next, what, instance);
                before
            }
            None => next,
        }
    }

    /// The scope in which an element of a comprehension is read.
    pub(crate) fn counted(
        &mut self,
        list: &'a Comprehension,
        at: usize,
        scope: &Scope<'a>,
    ) -> Scope<'a> {
        let first = self.structural_integer_in(&without_elements(scope), &list.first);
        let count = first.unwrap_or(0) + i64::try_from(at).unwrap_or(i64::MAX);
        let fixed = Counter::Fixed(i32::try_from(count).unwrap_or(i32::MAX));
        let mut scope = scope.clone();
        scope.counters.push((list.counter.text.as_str(), fixed));
        scope
    }

    /// A pure number in the unit that stands behind its list; what has a unit of its own stays.
    pub(crate) fn in_unit(&mut self, typed: Typed, unit: Option<&UnitText>) -> Typed {
        let Some(text) = unit else { return typed };
        let pure = typed
            .dim
            .as_known()
            .is_some_and(|dim| dim.is_dimensionless());
        if typed.truth || !(pure || typed.bare) {
            return typed;
        }
        match NamedUnit::parse(&text.text) {
            Ok(unit) => {
                let unit = unit.unit();
                let arena = &mut self.flat.exprs;
                let id = match arena.as_constant(typed.id) {
                    Some(value) => arena.constant(unit.to_si(value)),
                    None => {
                        let scale = arena.constant(unit.difference_to_si(1.0));
                        let zero = arena.constant(unit.to_si(0.0));
                        let scaled = arena.times(scale, typed.id);
                        arena.plus(scaled, zero)
                    }
                };
                Typed {
                    id,
                    dim: Dim::known(unit.dimension),
                    bare: false,
                    ..typed
                }
            }
            Err(error) => {
                self.bad_unit(text, &error);
                self.poison(typed.span)
            }
        }
    }
}
