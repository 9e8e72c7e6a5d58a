//! Whether a value is arithmetic of the unknowns.

use super::{Dae, Space};
use crate::{BinaryOp, Expr, ExprId, UnaryOp, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

impl Dae {
    /// For each relation, whether its root function is made of unknowns, memory and parameters by sums, products, magnitudes
    /// and limits alone: between two steps it turns no more often than they do. The time itself, columns of records, delays,
    /// derivatives and periodic functions may turn unseen by a solver.
    #[must_use]
    pub fn arithmetic_relations(&self) -> Vec<bool> {
        let mut values: FxHashMap<VarId, Vec<ExprId>> = FxHashMap::default();
        for definition in &self.definitions {
            let of_variable = values.entry(definition.var).or_default();
            of_variable.push(definition.value);
        }
        let relations = self.relations.iter();
        relations
            .map(|relation| self.is_arithmetic(relation.root, &values))
            .collect()
    }

    fn is_arithmetic(&self, root: ExprId, values: &FxHashMap<VarId, Vec<ExprId>>) -> bool {
        let mut seen = FxHashSet::default();
        let mut open = vec![root];
        while let Some(root) = open.pop() {
            for id in self.exprs.below(&[root]) {
                let plain = match self.exprs[id] {
                    Expr::Var(var, _) => match self.place(var).map(|place| place.space) {
                        Some(Space::Work) => {
                            if seen.insert(var) {
                                open.extend(values.get(&var).into_iter().flatten());
                            }
                            true
                        }
                        Some(Space::Unknown | Space::Memory | Space::Parameter) => true,
                        Some(Space::Input) | None => false,
                    },
                    Expr::Unary(op, _) => is_plain(op),
                    Expr::Binary(op, ..) => joins_plainly(op),
                    Expr::Time | Expr::Der(..) | Expr::NoEvent(_) => false,
                    Expr::Const(_)
                    | Expr::Counter
                    | Expr::Param(..)
                    | Expr::Pre(..)
                    | Expr::Relation(_)
                    | Expr::InMode(..)
                    | Expr::If(..) => true,
                };
                if !plain {
                    return false;
                }
            }
        }
        true
    }
}

fn is_plain(op: UnaryOp) -> bool {
    [UnaryOp::Neg, UnaryOp::Abs, UnaryOp::Sqrt].contains(&op)
}

fn joins_plainly(op: BinaryOp) -> bool {
    let plain = [
        BinaryOp::Add,
        BinaryOp::Sub,
        BinaryOp::Mul,
        BinaryOp::Div,
        BinaryOp::Min,
        BinaryOp::Max,
    ];
    plain.contains(&op)
}
