//! The counter of an array expression: fixed at a value, or counting differently.

use crate::expr::{Expr, ExprArena, Index, Memo};
use crate::id::ExprId;

impl ExprArena {
    /// The expression at one value of its counter: elements that count along become fixed ones, the counter a number.
    pub fn at_counter(&mut self, root: ExprId, counter: i32) -> ExprId {
        self.with_counter(root, Index::fixed(counter))
    }

    /// The expression with its counter replaced by `stride*counter + offset`.
    pub fn with_counter(&mut self, root: ExprId, counter: Index) -> ExprId {
        let moved = |index: Index| Index {
            stride: index.stride * counter.stride,
            offset: index.at(counter.offset),
        };
        self.rewrite(root, &mut Memo::default(), |arena, _, expr| match expr {
            Expr::Var(var, index) => Some(arena.add(Expr::Var(var, moved(index)))),
            Expr::Der(var, index) => Some(arena.add(Expr::Der(var, moved(index)))),
            Expr::Pre(var, index) => Some(arena.add(Expr::Pre(var, moved(index)))),
            Expr::Param(param, index) => Some(arena.add(Expr::Param(param, moved(index)))),
            Expr::Counter => {
                let own = arena.add(Expr::Counter);
                let stride = arena.constant(f64::from(counter.stride));
                let offset = arena.constant(f64::from(counter.offset));
                let scaled = arena.times(stride, own);
                Some(arena.plus(scaled, offset))
            }
            Expr::Const(_)
            | Expr::Time
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::Unary(..)
            | Expr::Binary(..)
            | Expr::If(..)
            | Expr::NoEvent(_) => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::{Expr, ExprArena, Index};
    use crate::id::{Id as _, VarId};

    #[test]
    fn elements_and_counter_become_fixed() {
        let mut arena = ExprArena::new();
        let x = VarId::from_index(0);
        let along = arena.add(Expr::Var(
            x,
            Index {
                stride: 2,
                offset: 1,
            },
        ));
        let counter = arena.add(Expr::Counter);
        let product = arena.times(counter, along);
        let (three, element) = (
            arena.constant(3.0),
            arena.add(Expr::Var(x, Index::fixed(7))),
        );
        let expected = arena.times(three, element);
        assert_eq!(arena.at_counter(product, 3), expected);
    }
}
