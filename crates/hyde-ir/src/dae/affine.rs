//! Whether the residual is affine in the unknowns and their derivatives, and what of the memory its coefficients read.

use super::{Dae, Space};
use crate::{BinaryOp, Expr, ExprId, UnaryOp, VarId};
use rustc_hash::FxHashMap;

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
    /// If the residual is affine in the unknowns and their derivatives, with coefficients that change at events alone: how many
    /// of the first places of the memory the coefficients read. Relations and modes have the first places; other values follow.
    /// One iteration of Newton's method solves a step of an affine residual, whatever its matrix was evaluated at.
    #[must_use]
    pub fn affine_in(&self) -> Option<usize> {
        let of_switches = self.relations.len() + self.automata.len();
        if self.n_memory > of_switches && self.is_affine(Given) {
            return Some(of_switches);
        }
        self.is_affine(Fixed).then_some(self.n_memory)
    }

    /// Whether the residual is affine. `memory` says what its values are taken for, but for those of relations and modes: given
    /// ones cannot be factors of unknowns.
    fn is_affine(&self, memory: Dependence) -> bool {
        let mut known: FxHashMap<ExprId, Dependence> = FxHashMap::default();
        let mut of_variable: FxHashMap<VarId, Dependence> = FxHashMap::default();
        for definition in &self.definitions {
            let own = self.dependence(definition.value, memory, &mut known, &of_variable);
            let all = of_variable.entry(definition.var).or_insert(own);
            *all = own.max(*all);
        }
        let mut residuals = self.residuals.iter();
        let mut own = |value| self.dependence(value, memory, &mut known, &of_variable);
        residuals.all(|row| own(row.value) <= Affine)
    }

    fn dependence(
        &self,
        root: ExprId,
        memory: Dependence,
        known: &mut FxHashMap<ExprId, Dependence>,
        of_variable: &FxHashMap<VarId, Dependence>,
    ) -> Dependence {
        for id in self.exprs.below(&[root]) {
            if known.contains_key(&id) {
                continue;
            }
            let of = |child: ExprId| known.get(&child).copied().unwrap_or(Bent);
            let own = match self.exprs[id] {
                Expr::Var(var, _) => match self.place(var).map(|place| place.space) {
                    Some(Space::Memory) => memory,
                    Some(Space::Parameter) => Fixed,
                    Some(Space::Input) => Given,
                    Some(Space::Unknown) => Affine,
                    Some(Space::Work) => of_variable.get(&var).copied().unwrap_or(Bent),
                    None => Bent,
                },
                Expr::Const(_)
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Relation(_)
                | Expr::InMode(..) => Fixed,
                Expr::Pre(..) => memory,
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
