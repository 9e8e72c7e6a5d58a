//! Whether the residual is affine in the unknowns and their derivatives.

use super::{Dae, Space};
use crate::{BinaryOp, Expr, ExprId, UnaryOp, VarId};
use std::collections::HashMap;

/// How a value depends on the unknowns between two events.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Dependence {
    /// Not at all, and neither on the time: parameters and memory.
    Fixed,
    /// Not at all: it may change with the time and the inputs.
    Given,
    /// A sum of unknowns and their derivatives times fixed values, and of given ones.
    Affine,
    /// In another way.
    Bent,
}

use Dependence::{Affine, Bent, Fixed, Given};

impl Dae {
    /// Whether the residual is affine in the unknowns and their derivatives, with coefficients that change at events alone.
    /// Then one iteration of Newton's method solves a step, whatever its matrix was evaluated at.
    #[must_use]
    pub fn is_affine(&self) -> bool {
        let mut known: HashMap<ExprId, Dependence> = HashMap::new();
        let mut of_variable: HashMap<VarId, Dependence> = HashMap::new();
        for definition in &self.definitions {
            let own = self.dependence(definition.value, &mut known, &of_variable);
            let all = of_variable.entry(definition.var).or_insert(own);
            *all = own.max(*all);
        }
        let mut residuals = self.residuals.iter();
        residuals.all(|row| self.dependence(row.value, &mut known, &of_variable) <= Affine)
    }

    fn dependence(
        &self,
        root: ExprId,
        known: &mut HashMap<ExprId, Dependence>,
        of_variable: &HashMap<VarId, Dependence>,
    ) -> Dependence {
        for id in self.exprs.below(&[root]) {
            if known.contains_key(&id) {
                continue;
            }
            let of = |child: ExprId| known.get(&child).copied().unwrap_or(Bent);
            let own = match self.exprs[id] {
                Expr::Var(var, _) => match self.place(var).map(|place| place.space) {
                    Some(Space::Memory | Space::Parameter) => Fixed,
                    Some(Space::Input) => Given,
                    Some(Space::Unknown) => Affine,
                    Some(Space::Work) => of_variable.get(&var).copied().unwrap_or(Bent),
                    None => Bent,
                },
                Expr::Const(_)
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..) => Fixed,
                Expr::Time => Given,
                Expr::Der(..) => Affine,
                Expr::Unary(UnaryOp::Neg, value) => of(value),
                Expr::Unary(_, value) => bent(of(value)),
                Expr::Binary(op, a, b) => joined(op, of(a), of(b)),
                Expr::If(condition, then, other) => {
                    let (condition, branches) = (of(condition), of(then).max(of(other)));
                    match condition == Fixed {
                        true => branches,
                        false => bent(condition.max(branches)),
                    }
                }
                // Its relations change between events.
                Expr::NoEvent(_) => Bent,
            };
            known.insert(id, own);
        }
        known.get(&root).copied().unwrap_or(Bent)
    }
}

fn joined(op: BinaryOp, a: Dependence, b: Dependence) -> Dependence {
    let straight = [BinaryOp::Add, BinaryOp::Sub].contains(&op)
        || (op == BinaryOp::Mul && a.min(b) == Fixed)
        || (op == BinaryOp::Div && b == Fixed);
    let more = a.max(b);
    if straight { more } else { bent(more) }
}

/// What any other operation makes of a value.
fn bent(value: Dependence) -> Dependence {
    match value {
        Fixed | Given => value,
        Affine | Bent => Bent,
    }
}
