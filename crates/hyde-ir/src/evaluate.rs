//! The reference evaluator: an expression's value, node by node, straight from the table of operations.

use crate::expr::{Expr, ExprArena};
use crate::id::ExprId;
use rustc_hash::FxHashMap;

impl ExprArena {
    /// The value of `root` where `leaf` gives the value of each leaf (numbers and operations apart).
    ///
    /// # Errors
    /// The first error of `leaf`.
    pub fn evaluate<E>(
        &self,
        root: ExprId,
        leaf: impl FnMut(Expr) -> Result<f64, E>,
    ) -> Result<f64, E> {
        self.evaluate_nodes(root, false, leaf)
    }

    /// The same, but what reads a value that is not a number is not a number either, comparisons and branches too: no
    /// truth follows from one.
    ///
    /// # Errors
    /// The first error of `leaf`.
    pub fn evaluate_known<E>(
        &self,
        root: ExprId,
        leaf: impl FnMut(Expr) -> Result<f64, E>,
    ) -> Result<f64, E> {
        self.evaluate_nodes(root, true, leaf)
    }

    fn evaluate_nodes<E>(
        &self,
        root: ExprId,
        known: bool,
        mut leaf: impl FnMut(Expr) -> Result<f64, E>,
    ) -> Result<f64, E> {
        let mut values: FxHashMap<ExprId, f64> = FxHashMap::default();
        let unknown = |value: f64| known && value.is_nan();
        for id in self.below(&[root]) {
            let value = match self[id] {
                Expr::Const(number) => number.0,
                Expr::Unary(_, a) | Expr::Binary(_, a, _) | Expr::If(a, ..)
                    if unknown(values[&a]) =>
                {
                    f64::NAN
                }
                Expr::Binary(_, _, b) if unknown(values[&b]) => f64::NAN,
                Expr::Unary(op, a) => op.apply(values[&a]),
                Expr::Binary(op, a, b) => op.apply(values[&a], values[&b]),
                Expr::If(c, a, b) => {
                    if values[&c] != 0.0 {
                        values[&a]
                    } else {
                        values[&b]
                    }
                }
                Expr::NoEvent(a) => values[&a],
                other @ (Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)) => leaf(other)?,
            };
            values.insert(id, value);
        }
        Ok(values[&root])
    }
}

#[cfg(test)]
mod tests {
    use crate::expr::{Expr, ExprArena};
    use crate::id::{ExprId, Id as _, VarId};
    use crate::{BinaryOp, UnaryOp};

    /// Random expressions of two variables by a small linear congruential generator.
    fn random(arena: &mut ExprArena, seed: &mut u64, depth: usize) -> ExprId {
        let mut next = |n: u64| {
            *seed = seed
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (*seed >> 33) % n
        };
        if depth == 0 {
            return match next(3) {
                0 => arena.var(VarId::from_index(0)),
                1 => arena.var(VarId::from_index(1)),
                _ => {
                    let value = next(19);
                    arena.constant(value as f64 / 4.0 - 2.0)
                }
            };
        }
        let choice = next(2);
        let (unary, binary) = (
            next(UnaryOp::ALL.len() as u64),
            next(BinaryOp::ALL.len() as u64),
        );
        let a = random(arena, seed, depth - 1);
        if choice == 0 {
            return arena.unary(UnaryOp::ALL[unary as usize], a);
        }
        let b = random(arena, seed, depth - 1);
        arena.binary(BinaryOp::ALL[binary as usize], a, b)
    }

    /// Whether the operation has a derivative everywhere near a random point.
    fn smooth(arena: &ExprArena, root: ExprId) -> bool {
        !arena.any(root, |e| match e {
            Expr::Unary(op, _) => matches!(op, UnaryOp::Floor | UnaryOp::Ceil | UnaryOp::Not),
            Expr::Binary(op, ..) => {
                op.is_truth() || matches!(op, BinaryOp::FloorTo | BinaryOp::RoundTo)
            }
            Expr::Const(_)
            | Expr::Time
            | Expr::Counter
            | Expr::Param(..)
            | Expr::Var(..)
            | Expr::Der(..)
            | Expr::Pre(..)
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::If(..)
            | Expr::NoEvent(_) => false,
        })
    }

    #[test]
    fn derivatives_agree_with_differences_and_with_each_other() {
        let mut compared = 0;
        for start in 0..4000_u64 {
            let mut arena = ExprArena::new();
            let mut seed = start;
            let root = random(&mut arena, &mut seed, 4);
            if !smooth(&arena, root) {
                continue;
            }
            let x = VarId::from_index(0);
            let point = [0.731, 1.37];
            let value = |arena: &ExprArena, id, p: [f64; 2]| {
                let leaf = |e| {
                    Ok::<f64, ()>(if matches!(e, Expr::Var(v, _) if v == x) {
                        p[0]
                    } else {
                        p[1]
                    })
                };
                arena.evaluate(id, leaf).unwrap()
            };
            let one = arena.constant(1.0);
            let tangent = arena.tangent(root, |_, e| {
                matches!(e, Expr::Var(v, _) if v == x).then_some(one)
            });
            let gradient = arena.gradient(root, |e| matches!(e, Expr::Var(..)));
            let by_x = gradient
                .iter()
                .find(|(e, _)| matches!(e, Expr::Var(v, _) if *v == x));
            let by_x = by_x.map_or(0.0, |&(_, d)| value(&arena, d, point));
            let forward = value(&arena, tangent, point);
            let h = 1e-6;
            let up = value(&arena, root, [point[0] + h, point[1]]);
            let down = value(&arena, root, [point[0] - h, point[1]]);
            let difference = (up - down) / (2.0 * h);
            let second = (up - 2.0 * value(&arena, root, point) + down) / (h * h);
            if !(forward.is_finite() && difference.is_finite())
                || forward.abs() > 1e4
                || second.abs() > 1e4
            {
                continue;
            }
            compared += 1;
            // Central differences at h = 1e-6: rounding 1e-10 relative to the values, curvature bounded above.
            assert!(
                (forward - difference).abs() <= 1e-5 * (1.0 + forward.abs()),
                "{start}: {forward} {difference}"
            );
            // The two modes sum the same terms in another order.
            assert!(
                (forward - by_x).abs() <= 1e-9 * (1.0 + forward.abs()),
                "{start}: {forward} {by_x}"
            );
        }
        assert!(
            compared > 300,
            "only {compared} random expressions were compared"
        );
    }
}
