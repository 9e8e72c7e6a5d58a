//! [`ExprArena::column`]: an expression in every row of a record, a block of rows at a time.
//!
//! Each node has a lane of one block, children before their parents. What is the same in every row is computed once. The
//! values are those of [`ExprArena::evaluate`], to the last bit: both take the operations from the same table.

use crate::expr::{Expr, ExprArena};
use crate::id::ExprId;
use crate::{BinaryOp, UnaryOp};

/// Rows of a block: the lanes of a few nodes stay in the processor's cache.
const BLOCK: usize = 256;

/// What a leaf is along the rows.
#[derive(Clone, Copy, Debug)]
pub enum Along<'c> {
    /// The same in every row.
    Same(f64),
    /// A value for each row.
    Rows(&'c [f64]),
}

/// How the lane of a node is filled.
enum Step<'c> {
    Same(f64),
    Rows(&'c [f64]),
    Unary(UnaryOp, usize),
    Binary(BinaryOp, usize, usize),
    If(usize, usize, usize),
}

impl ExprArena {
    /// The value of `root` in each of so many rows, where `leaf` gives each leaf (numbers and operations apart).
    ///
    /// # Errors
    /// The first error of `leaf`.
    pub fn column<'c, E>(
        &self,
        root: ExprId,
        rows: usize,
        leaf: impl FnMut(Expr) -> Result<Along<'c>, E>,
    ) -> Result<Vec<f64>, E> {
        let (steps, last) = self.steps(root, leaf)?;
        if let Step::Same(value) = steps[last] {
            return Ok(vec![value; rows]);
        }
        let mut lanes = vec![0.0; steps.len() * BLOCK];
        for (step, lane) in steps.iter().zip(lanes.chunks_exact_mut(BLOCK)) {
            if let Step::Same(value) = step {
                lane.fill(*value);
            }
        }
        let mut values = Vec::with_capacity(rows);
        for start in (0..rows).step_by(BLOCK) {
            let count = BLOCK.min(rows - start);
            for (number, step) in steps.iter().enumerate() {
                let (below, own) = lanes.split_at_mut(number * BLOCK);
                let own = &mut own[..count];
                let lane = |at: usize| &below[at * BLOCK..][..count];
                match *step {
                    Step::Same(_) => {}
                    Step::Rows(all) => own.copy_from_slice(&all[start..][..count]),
                    Step::Unary(op, a) => unary(op, lane(a), own),
                    Step::Binary(op, a, b) => binary(op, lane(a), lane(b), own),
                    Step::If(c, a, b) => {
                        let branches = lane(a).iter().zip(lane(b));
                        for ((own, c), (a, b)) in own.iter_mut().zip(lane(c)).zip(branches) {
                            *own = if *c != 0.0 { *a } else { *b };
                        }
                    }
                }
            }
            values.extend_from_slice(&lanes[last * BLOCK..][..count]);
        }
        Ok(values)
    }

    /// The steps to the lane of `root`, and the number of that lane.
    fn steps<'c, E>(
        &self,
        root: ExprId,
        mut leaf: impl FnMut(Expr) -> Result<Along<'c>, E>,
    ) -> Result<(Vec<Step<'c>>, usize), E> {
        let nodes = self.below(&[root]);
        let mut steps: Vec<Step<'c>> = Vec::with_capacity(nodes.len());
        // The lane of each node: `noEvent` has that of what is in it.
        let mut lanes: Vec<usize> = Vec::with_capacity(nodes.len());
        for id in &nodes {
            let lane = |child: ExprId| nodes.binary_search(&child).map_or(0, |at| lanes[at]);
            let same = |lane: usize| match steps[lane] {
                Step::Same(value) => Some(value),
                Step::Rows(_) | Step::Unary(..) | Step::Binary(..) | Step::If(..) => None,
            };
            let step = match self[*id] {
                Expr::Const(number) => Step::Same(number.0),
                Expr::NoEvent(a) => {
                    let lane = lane(a);
                    lanes.push(lane);
                    continue;
                }
                Expr::Unary(op, a) => match same(lane(a)) {
                    Some(value) => Step::Same(op.apply(value)),
                    None => Step::Unary(op, lane(a)),
                },
                Expr::Binary(op, a, b) => match (same(lane(a)), same(lane(b))) {
                    (Some(first), Some(second)) => Step::Same(op.apply(first, second)),
                    _ => Step::Binary(op, lane(a), lane(b)),
                },
                Expr::If(c, a, b) => match (same(lane(c)), same(lane(a)), same(lane(b))) {
                    (Some(c), Some(a), Some(b)) => Step::Same(if c != 0.0 { a } else { b }),
                    _ => Step::If(lane(c), lane(a), lane(b)),
                },
                other @ (Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)) => match leaf(other)? {
                    Along::Same(value) => Step::Same(value),
                    Along::Rows(rows) => Step::Rows(rows),
                },
            };
            lanes.push(steps.len());
            steps.push(step);
        }
        let last = lanes.last().copied().unwrap_or(0);
        Ok((steps, last))
    }
}

/// An operation in each row. Those that are cheaper than a call get a loop of their own.
fn unary(op: UnaryOp, from: &[f64], to: &mut [f64]) {
    let each = to.iter_mut().zip(from);
    if op == UnaryOp::Neg {
        each.for_each(|(to, a)| *to = UnaryOp::Neg.apply(*a));
    } else if op == UnaryOp::Abs {
        each.for_each(|(to, a)| *to = UnaryOp::Abs.apply(*a));
    } else {
        each.for_each(|(to, a)| *to = op.apply(*a));
    }
}

fn binary(op: BinaryOp, left: &[f64], right: &[f64], to: &mut [f64]) {
    let each = to.iter_mut().zip(left.iter().zip(right));
    if op == BinaryOp::Add {
        each.for_each(|(to, (a, b))| *to = BinaryOp::Add.apply(*a, *b));
    } else if op == BinaryOp::Sub {
        each.for_each(|(to, (a, b))| *to = BinaryOp::Sub.apply(*a, *b));
    } else if op == BinaryOp::Mul {
        each.for_each(|(to, (a, b))| *to = BinaryOp::Mul.apply(*a, *b));
    } else if op == BinaryOp::Div {
        each.for_each(|(to, (a, b))| *to = BinaryOp::Div.apply(*a, *b));
    } else {
        each.for_each(|(to, (a, b))| *to = op.apply(*a, *b));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::id::{Id as _, VarId};

    #[test]
    fn a_column_has_the_values_of_its_rows() {
        let mut arena = ExprArena::new();
        let (x, y) = (VarId::from_index(0), VarId::from_index(1));
        let (a, b) = (arena.var(x), arena.var(y));
        let magnitude = arena.unary(UnaryOp::Abs, a);
        let magnitude = arena.no_event(magnitude);
        let sum = arena.plus(magnitude, b);
        let part = arena.over(a, sum);
        let zero = arena.constant(0.0);
        let below = arena.binary(BinaryOp::Lt, a, zero);
        let sine = arena.unary(UnaryOp::Sin, b);
        let root = arena.if_else(below, part, sine);
        let rows: Vec<f64> = (0..700).map(|row| f64::from(row - 300) / 80.0).collect();
        let is_x = |leaf: Expr| leaf == Expr::Var(x, crate::Index::SCALAR);
        let column = arena.column(root, rows.len(), |leaf| match is_x(leaf) {
            true => Ok(Along::Rows(&rows)),
            false => Ok(Along::Same(0.3)),
        });
        let one = |row: f64| arena.evaluate(root, |leaf| Ok(if is_x(leaf) { row } else { 0.3 }));
        let each: Result<Vec<f64>, ()> = rows.iter().map(|&row| one(row)).collect();
        assert_eq!(column, each);
        let same = arena.column(sine, 3, |_| Ok::<_, ()>(Along::Same(0.0)));
        assert_eq!(same, Ok(vec![0.0; 3]));
    }
}
