//! Solves an equation for one of its leaves where that is linear: `a*v + b = 0` gives `v = -b/a`.

use hyde_ir::{Expr, ExprArena, ExprId, Memo};

/// The value of `leaf` from `lhs = rhs`; `None` unless it stands linearly, with a factor of parameters alone.
pub(crate) fn solve_for(
    arena: &mut ExprArena,
    lhs: ExprId,
    rhs: ExprId,
    leaf: Expr,
) -> Option<ExprId> {
    let contains = |arena: &ExprArena, id: ExprId| arena.any(id, |expr| expr == leaf);
    let (in_left, in_right) = (contains(arena, lhs), contains(arena, rhs));
    if arena[lhs] == leaf && !in_right {
        return Some(rhs);
    }
    if arena[rhs] == leaf && !in_left {
        return Some(lhs);
    }
    if !in_left && !in_right {
        return None;
    }
    let residual = arena.minus(lhs, rhs);
    let gradient = arena.gradient(residual, |expr| expr == leaf);
    let [(_, factor)] = gradient.as_slice() else {
        return None;
    };
    if !arena.is_parametric(*factor) || arena.is_constant(*factor, 0.0) {
        return None;
    }
    let mut memo = Memo::default();
    let mut without = |arena: &mut ExprArena, id: ExprId| {
        arena.rewrite(id, &mut memo, |arena, _, expr| {
            (expr == leaf).then(|| arena.constant(0.0))
        })
    };
    let (left, right) = (without(arena, lhs), without(arena, rhs));
    let above = arena.minus(right, left);
    Some(arena.over(above, *factor))
}

/// What [`solve_for`] divides by to get `leaf` from `lhs = rhs`; `None` if by nothing.
pub(crate) fn divisor(
    arena: &mut ExprArena,
    lhs: ExprId,
    rhs: ExprId,
    leaf: Expr,
) -> Option<ExprId> {
    if arena[lhs] == leaf || arena[rhs] == leaf {
        return None;
    }
    let residual = arena.minus(lhs, rhs);
    let gradient = arena.gradient(residual, |expr| expr == leaf);
    let (_, factor) = *gradient.first()?;
    Some(factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_ir::{Id as _, Index, VarId};

    #[test]
    fn sums_are_solved_and_squares_are_not() {
        let mut arena = ExprArena::new();
        let [x, y, z] = [0, 1, 2].map(|n| Expr::Var(VarId::from_index(n), Index::SCALAR));
        let [a, b, c] = [x, y, z].map(|leaf| arena.add(leaf));
        let zero = arena.constant(0.0);
        let sum = arena.plus(a, b);
        let sum = arena.plus(sum, c);
        let solved = solve_for(&mut arena, sum, zero, y).unwrap();
        let value = |expr| Ok::<f64, ()>(if expr == x { 3.0 } else { 4.0 });
        assert_eq!(arena.evaluate(solved, value), Ok(-7.0));
        let square = arena.times(b, b);
        assert!(solve_for(&mut arena, square, a, y).is_none());
        let product = arena.times(b, c);
        assert!(
            solve_for(&mut arena, product, a, y).is_none(),
            "a factor that may vanish"
        );
    }
}
