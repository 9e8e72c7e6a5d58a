//! What a binding gives to each element: of an array, and of the arrays of components that it came through.
//!
//! ```text
//! Mass car[3](M = {90, 80, 80} [kg]);       car[2].M is the second of the list
//! Mass car[3](M = load);                    load[2], if load is an array of three; else load
//! Chain row[2](each m = {1, 2, 3} [kg]);    row[2].m is the whole list
//! ```

use crate::instance::{Binding, Elementwise, Position, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::values as refused;
use hyde_syntax::ast::{Expr, ExprKind, UnitText};

/// The values of a binding.
pub(super) enum Elements {
    /// One for the whole of it; it may depend on the counter of the elements, from 0.
    All(Typed),
    /// One an element.
    Each(Vec<Typed>),
}

impl<'a> Model<'a, '_> {
    /// The values that a binding gives to a scalar, or to an array of `len` elements.
    pub(super) fn elements(
        &mut self,
        binding: &Binding<'a>,
        len: Option<usize>,
        setting: Setting,
    ) -> Elements {
        let (expr, unit, scope) = self.picked(binding, setting);
        let Some(len) = len else {
            let value = self.lower(expr, &scope);
            return Elements::All(self.in_unit(value, unit));
        };
        let found = match scope.elementwise {
            Some(_) => None,
            None => self.array_length(expr, &scope),
        };
        match found {
            None => {
                let value = self.lower(expr, &scope);
                return Elements::All(self.in_unit(value, unit));
            }
            Some(found) if found != len => {
                self.report(refused::not_as_many(found, len, expr.span));
                return Elements::All(self.poison(expr.span));
            }
            Some(_) => {}
        }
        if matches!(expr.kind, ExprKind::Array(..) | ExprKind::Comprehension(_)) {
            let items = (0..len).map(|at| {
                let item = self.list_item(expr, at, &scope);
                self.in_unit(item, unit)
            });
            return Elements::Each(items.collect());
        }
        let counted = scope.elements(Elementwise::Range(len));
        if let Some(all) = self.together(|model| model.lower(expr, &counted)) {
            return Elements::All(all);
        }
        let one = |at| scope.elements(Elementwise::One(Position { at, of: len }));
        Elements::Each((0..len).map(|at| self.lower(expr, &one(at))).collect())
    }

    /// The value that a binding gives to a scalar.
    pub(crate) fn bound_value(&mut self, binding: &Binding<'a>, setting: Setting) -> Typed {
        let (expr, unit, scope) = self.picked(binding, setting);
        let value = self.value(expr, &scope);
        self.in_unit(value, unit)
    }

    /// Of a binding that came through arrays of components, what it gives to this one of them: the item of a list with the
    /// unit behind it, or an expression whose whole arrays stand for one element.
    pub(crate) fn picked(
        &mut self,
        binding: &Binding<'a>,
        setting: Setting,
    ) -> (&'a Expr, Option<&'a UnitText>, Scope<'a>) {
        let (mut expr, mut unit, mut scope) = (binding.expr, None, binding.scope_for(setting));
        for &position in &binding.elements {
            let Some(found) = self.array_length(expr, &scope) else {
                break;
            };
            if found != position.of {
                self.report(refused::not_as_many(found, position.of, expr.span));
                break;
            }
            match &expr.kind {
                ExprKind::Array(items, own) => {
                    let Some(item) = items.get(position.at) else {
                        break;
                    };
                    expr = item;
                    unit = own.as_ref().or(unit);
                }
                ExprKind::Comprehension(list) => {
                    scope = self.counted(list, position.at, &scope);
                    expr = &list.value;
                    unit = list.unit.as_ref().or(unit);
                }
                ExprKind::Number(..)
                | ExprKind::String(_)
                | ExprKind::Boolean(_)
                | ExprKind::Reference(_)
                | ExprKind::Call(..)
                | ExprKind::Unary(..)
                | ExprKind::Binary(..)
                | ExprKind::If(..)
                | ExprKind::Slice(..) => {
                    scope.elementwise = Some(Elementwise::One(position));
                    break;
                }
            }
        }
        (expr, unit, scope)
    }
}
