//! Subscripts: elements by number or affine in the counter of a `for` equation, and whole arrays.

use crate::instance::{Counter, Elementwise, Scope};
use crate::model::Model;
use crate::refusals::values as refused;
use hyde_diag::Span;
use hyde_ir::Index;
use hyde_syntax::ast::{Binary, Expr, ExprKind, Reference, Unary};

impl<'a> Model<'a, '_> {
    /// Subscripts affine in the counter: `stride*i + offset`, counted as written.
    pub(crate) fn affine(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Option<Index> {
        if !mentions_counter(expr, scope) {
            let value = self.structural_integer_in(scope, expr)?;
            return Some(Index::fixed(i32::try_from(value).unwrap_or(i32::MAX)));
        }
        match &expr.kind {
            ExprKind::Reference(_) => Some(Index::COUNTER),
            ExprKind::Unary(Unary::Negative, inner) => {
                let inner = self.affine(inner, scope)?;
                Some(Index {
                    stride: -inner.stride,
                    offset: -inner.offset,
                })
            }
            ExprKind::Binary(op @ (Binary::Add | Binary::Sub), a, b) => {
                let (a, b) = (self.affine(a, scope)?, self.affine(b, scope)?);
                let sign = if *op == Binary::Add { 1 } else { -1 };
                Some(Index {
                    stride: a.stride + sign * b.stride,
                    offset: a.offset + sign * b.offset,
                })
            }
            ExprKind::Binary(Binary::Mul, a, b) => {
                let (a, b) = (self.affine(a, scope)?, self.affine(b, scope)?);
                match (a.stride, b.stride) {
                    (0, _) => Some(Index {
                        stride: a.offset * b.stride,
                        offset: a.offset * b.offset,
                    }),
                    (_, 0) => Some(Index {
                        stride: b.offset * a.stride,
                        offset: b.offset * a.offset,
                    }),
                    _ => {
                        self.unroll();
                        None
                    }
                }
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => {
                self.unroll();
                None
            }
        }
    }

    /// The element of a subscript, counted from 0; `Some(None)` where there is no subscript.
    pub(super) fn element(
        &mut self,
        subscript: Option<&'a Expr>,
        len: Option<usize>,
        first: i32,
        scope: &Scope<'a>,
        reference: &Reference,
    ) -> Option<Option<Index>> {
        let Some(subscript) = subscript else {
            return Some(None);
        };
        let Some(len) = len else {
            self.report(refused::not_an_array(reference));
            return None;
        };
        if let ExprKind::Slice(from, _) = &subscript.kind {
            return self
                .of_slice(subscript, from, (len, first), scope)
                .map(Some);
        }
        if len == 0 && self.diagnostics.has_errors() {
            return None; // Its length is the mistake.
        }
        let written = self.affine(subscript, scope)?;
        let index = Index {
            stride: written.stride,
            offset: written.offset - first,
        };
        let inside = usize::try_from(index.offset).is_ok_and(|at| at < len);
        if index.stride == 0 && !inside {
            let last = i64::from(first) + i64::try_from(len).unwrap_or(0) - 1;
            self.report(refused::no_element(
                reference,
                (first, last),
                (subscript.span, written.offset),
            ));
            return None;
        }
        Some(Some(index))
    }

    /// The element a whole array means in an array equation; an error where one value is expected.
    pub(crate) fn whole(
        &mut self,
        index: Option<Index>,
        len: Option<usize>,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<Index> {
        match (index, len, scope.elementwise) {
            (Some(index), ..) => Some(index),
            (None, None, _) => Some(Index::SCALAR),
            (None, Some(len), Some(elements)) if len == elements.len() => {
                Some(element_index(elements, 0))
            }
            (None, Some(len), Some(elements)) => {
                let expected = elements.len();
                self.report(refused::lengths_differ(len, expected, span));
                None
            }
            (None, Some(len), None) => {
                self.report(refused::array_for_value(len, span));
                None
            }
        }
    }

    /// The element that a slice `from:to` of an array of `len` elements, counted from `first`, means in an array equation.
    fn of_slice(
        &mut self,
        slice: &'a Expr,
        from: &'a Expr,
        (len, first): (usize, i32),
        scope: &Scope<'a>,
    ) -> Option<Index> {
        let start = self.structural_integer_in(&without_elements(scope), from)? - i64::from(first);
        let count = self.slice_length(slice, scope)?;
        let Some(elements) = scope.elementwise else {
            self.report(refused::slice_for_value(count, slice.span));
            return None;
        };
        let inside = usize::try_from(start).is_ok_and(|start| start + count <= len);
        if !inside {
            let last = i64::from(first) + i64::try_from(len).unwrap_or(0) - 1;
            self.report(refused::slice_out_of_range((first, last), slice.span));
            return None;
        }
        if count != elements.len() {
            self.report(refused::lengths_of_slice_differ(
                count,
                elements.len(),
                slice.span,
            ));
            return None;
        }
        Some(element_index(
            elements,
            i32::try_from(start).unwrap_or(i32::MAX),
        ))
    }
}

/// The element that is meant of an array from its element `start` on.
fn element_index(elements: Elementwise, start: i32) -> Index {
    match elements {
        Elementwise::Range(_) => Index {
            stride: 1,
            offset: start,
        },
        Elementwise::One(position) => {
            Index::fixed(start + i32::try_from(position.at).unwrap_or(i32::MAX))
        }
    }
}

/// The scope for what counts elements itself.
pub(super) fn without_elements<'a>(scope: &Scope<'a>) -> Scope<'a> {
    Scope {
        elementwise: None,
        ..scope.clone()
    }
}

fn is_symbolic_counter(reference: &Reference, scope: &Scope<'_>) -> bool {
    let Some(word) = reference.as_word() else {
        return false;
    };
    let counter = scope.counters.iter().rev().find(|(name, _)| *name == word);
    matches!(counter, Some((_, Counter::Symbolic)))
}

/// Whether an expression depends on the counter of a range equation.
pub(crate) fn mentions_counter(expr: &Expr, scope: &Scope<'_>) -> bool {
    expr.any(&|expr| {
        matches!(&expr.kind, ExprKind::Reference(reference) if is_symbolic_counter(reference, scope))
    })
}
