//! An array expression at one value of its counter.

use crate::expr::{Expr, ExprArena, Index};
use crate::id::ExprId;
use std::collections::HashMap;

impl ExprArena {
    /// The expression at one value of its counter: elements that count along become fixed ones, the counter a number.
    pub fn at_counter(&mut self, root: ExprId, counter: i32) -> ExprId {
        let fixed = |index: Index| Index::fixed(index.at(counter));
        self.rewrite(root, &mut HashMap::new(), |arena, _, expr| match expr {
            Expr::Var(var, index) => Some(arena.add(Expr::Var(var, fixed(index)))),
            Expr::Der(var, index) => Some(arena.add(Expr::Der(var, fixed(index)))),
            Expr::Pre(var, index) => Some(arena.add(Expr::Pre(var, fixed(index)))),
            Expr::Param(param, index) => Some(arena.add(Expr::Param(param, fixed(index)))),
            Expr::Counter => Some(arena.constant(f64::from(counter))),
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
