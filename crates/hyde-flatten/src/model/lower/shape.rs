//! Shapes: how long the whole arrays in an expression are.

use crate::instance::{Member, Scope};
use crate::model::Model;
use crate::refusals::values as refused;
use hyde_syntax::ast::{Argument, Expr, ExprKind, Reference};

impl<'a> Model<'a, '_> {
    /// The length of the whole arrays an expression reads, if it reads any.
    pub(crate) fn array_length(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Option<usize> {
        match &expr.kind {
            ExprKind::Reference(reference) => self.length_of(reference, scope),
            ExprKind::Array(..) | ExprKind::Comprehension(_) => self.list_length(expr, scope),
            ExprKind::Call(function, arguments) => elementwise_arguments(function, arguments)
                .iter()
                .find_map(|argument| self.array_length(&argument.value, scope)),
            ExprKind::Unary(..) | ExprKind::Binary(..) | ExprKind::If(..) => {
                let children = expr.children();
                children
                    .into_iter()
                    .find_map(|child| self.array_length(child, scope))
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Slice(..) => None,
        }
    }

    /// The length of what a name stands for: a whole array of values or of components, or a slice of one.
    pub(crate) fn length_of(
        &mut self,
        reference: &'a Reference,
        scope: &Scope<'a>,
    ) -> Option<usize> {
        let word = reference.as_word();
        let named = |name: &str| Some(name) == word;
        if scope.counters.iter().any(|(name, _)| named(name))
            || scope.locals.iter().any(|(name, _)| named(name))
            || scope.values.is_some()
        {
            return None;
        }
        let mut at = scope.instance;
        let mut parts = reference.parts.iter();
        let mut part = parts.next()?;
        let mut member = loop {
            match (
                self.tree[at].members.get(part.name.text.as_str()),
                self.tree[at].outer,
            ) {
                (Some(member), _) => break member.clone(),
                (None, Some(outer)) => at = outer,
                (None, None) => return None,
            }
        };
        let mut components = None;
        loop {
            let values = match &member {
                Member::Variable(var) => {
                    let whole = self.notes(*var).field.is_none();
                    self.flat.variables[*var].len.filter(|_| whole)
                }
                Member::Parameter(param) => self.flat.parameters[*param].len,
                Member::Instance(inner) => {
                    at = *inner;
                    None
                }
                Member::Instances(list) => {
                    let whole = self.whole_length(part.subscripts.as_slice(), list.len(), scope);
                    components = components.or(whole);
                    // What an array without a component has in it is not asked.
                    let Some(&first) = list.first() else {
                        return components;
                    };
                    at = first;
                    None
                }
                Member::Domain(_) => return None,
            };
            if values.is_none()
                && !part.subscripts.is_empty()
                && matches!(member, Member::Variable(_) | Member::Parameter(_))
            {
                return None; // Told where it is read: it has no elements.
            }
            let values =
                values.and_then(|len| self.whole_length(part.subscripts.as_slice(), len, scope));
            if let (Some(components), Some(values)) = (components, values) {
                self.report(refused::arrays_of_arrays(
                    components,
                    values,
                    reference.span,
                ));
                return None;
            }
            if values.is_some() {
                return values;
            }
            let Some(next) = parts.next() else {
                return components;
            };
            part = next;
            let inner = self.tree[at].members.get(part.name.text.as_str());
            member = inner?.clone();
        }
    }

    /// How many elements are meant: all without a subscript, those of a slice, none with the number of one.
    fn whole_length(
        &mut self,
        subscripts: &'a [Expr],
        len: usize,
        scope: &Scope<'a>,
    ) -> Option<usize> {
        match subscripts {
            [] => Some(len),
            [slice, ..] => self.slice_length(slice, scope),
        }
    }
}

/// The arguments of a call that may be whole arrays, taken element by element.
fn elementwise_arguments<'a>(function: &Reference, arguments: &'a [Argument]) -> &'a [Argument] {
    match function.as_word() {
        Some("sum") => &[],
        // The lists are the table's.
        Some("table" | "smooth_table") => &arguments[..arguments.len().min(1)],
        _ => arguments,
    }
}
