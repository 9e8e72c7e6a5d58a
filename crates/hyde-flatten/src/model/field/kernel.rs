//! The weight of a node for a place that moves, by their distance in cells.
//!
//! With `s` the share of the cell left of the place, the four nodes round it have the weights
//!
//! ```text
//! a(s),   1 - s - 2*a(s) + a(1-s),   s + a(s) - 2*a(1-s),   a(1-s)        a(s) = -s*(1-s)^2*p(s)/2
//! ```
//!
//! the linear shape functions with second differences added. They add up to one and read a straight line exactly,
//! whatever `a` is. `a'(0) = -1/2` and `a(1) = a'(1) = 0` make them continuously differentiable. What is left of `a`
//! makes the bar as stiff at the place as a continuous bar is: a load with the weights `w` makes the mesh too compliant by
//! `h/(E*A)` times
//!
//! ```text
//! D(s) = sum over i, k of w[i]*w[k]*|i - k|/2
//!      = s*(1-s) + 2*a(s)*(1-s) + 2*a(1-s)*s - 2*a(s)^2 - 2*a(1-s)^2 + 2*a(s)*a(1-s)
//! ```
//!
//! because linear elements are exact at their nodes. With linear shape functions D goes up to 1/4, and the static
//! stiffness ripples with every cell the nut passes. The polynomial `p` below was fitted to D = 0; it leaves 4e-8.

use hyde_ir::{BinaryOp, ExprArena, ExprId, UnaryOp};

/// The coefficients of p by rising power; the second is exact, the rest fitted.
const P: [f64; 5] = [1.0, 1.5, 0.898_031, -1.630_863, 0.436_944];

/// The weight of the node at `node` for a place at `place`, both in cells.
pub(super) fn kernel(arena: &mut ExprArena, place: ExprId, node: ExprId) -> ExprId {
    let difference = arena.minus(place, node);
    let distance = arena.unary(UnaryOp::Abs, difference);
    let (one, two) = (arena.constant(1.0), arena.constant(2.0));
    // Nodes two cells away and further have none.
    let distance = arena.binary(BinaryOp::Min, distance, two);
    let rest = arena.minus(one, distance);
    let near = {
        let (here, there) = (bend(arena, distance, rest), bend(arena, rest, distance));
        let twice = arena.times(two, here);
        let bent = arena.minus(there, twice);
        arena.plus(rest, bent)
    };
    let far = {
        let (beyond, left) = (arena.minus(distance, one), arena.minus(two, distance));
        bend(arena, beyond, left)
    };
    let is_near = arena.binary(BinaryOp::Lt, distance, one);
    let weight = arena.if_else(is_near, near, far);
    arena.no_event(weight)
}

/// a(s), with 1 - s given.
fn bend(arena: &mut ExprArena, s: ExprId, rest: ExprId) -> ExprId {
    let mut sum = arena.constant(0.0);
    for coefficient in P.iter().rev() {
        let coefficient = arena.constant(-0.5 * coefficient);
        let raised = arena.times(s, sum);
        sum = arena.plus(coefficient, raised);
    }
    let squared = arena.times(rest, rest);
    let shape = arena.times(s, squared);
    arena.times(shape, sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_ir::Expr;

    fn weights(s: f64) -> [f64; 4] {
        [-1.0, 0.0, 1.0, 2.0].map(|node| {
            let mut arena = ExprArena::new();
            let (place, node) = (arena.constant(s), arena.constant(node));
            let id = kernel(&mut arena, place, node);
            let Expr::NoEvent(inner) = arena[id] else {
                return arena.as_constant(id).expect("of constants");
            };
            arena.as_constant(inner).expect("of constants")
        })
    }

    #[test]
    fn straight_lines_are_read_exactly() {
        for step in 0..=20 {
            let s = f64::from(step) / 20.0;
            let [a, b, c, d] = weights(s);
            // Rounding of a handful of operations.
            assert!((a + b + c + d - 1.0).abs() < 1e-15, "{s}");
            assert!((-a + c + 2.0 * d - s).abs() < 1e-15, "{s}");
        }
    }

    #[test]
    fn the_mesh_is_as_stiff_as_a_bar_everywhere() {
        for step in 0..=1000 {
            let w = weights(f64::from(step) / 1000.0);
            let mut excess = 0.0;
            for i in 0..4_usize {
                for k in 0..4_usize {
                    excess += 0.5 * w[i] * w[k] * i.abs_diff(k) as f64;
                }
            }
            // What the fit of P leaves.
            assert!(excess.abs() < 4e-8, "{step}: {excess}");
        }
    }

    #[test]
    fn weights_change_smoothly_from_cell_to_cell() {
        // The slopes on both sides of a node, of the nodes left of it, at it and right of it.
        let e = 1e-6;
        let (before, at, after) = (weights(1.0 - e), weights(0.0), weights(e));
        for node in 0..3 {
            let arriving = (at[node] - before[node + 1]) / e;
            let leaving = (after[node] - at[node]) / e;
            // Second derivatives of a few units times e.
            assert!((arriving - leaving).abs() < 2e-5, "{arriving} {leaving}");
        }
    }
}
