//! What conditions of events read of the memory.

use super::{Dae, RelationUse, Space};
use crate::{Expr, ExprId, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

impl Dae {
    /// Whether a value is made of what events set.
    #[must_use]
    pub fn reads_memory(&self, value: ExprId) -> bool {
        let of_memory = |var| {
            let place = self.place(var);
            place.is_some_and(|place| place.space == Space::Memory)
        };
        self.exprs.any(value, |expr| match expr {
            Expr::Var(var, _) => of_memory(var),
            Expr::Pre(..) => true,
            Expr::Const(_)
            | Expr::Counter
            | Expr::Param(..)
            | Expr::Time
            | Expr::Der(..)
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::Unary(..)
            | Expr::Binary(..)
            | Expr::If(..)
            | Expr::NoEvent(_) => false,
        })
    }

    /// The positions of the memory that conditions of exits and `when` clauses read, themselves or through explicit variables: an
    /// event that sets one of them may make others fire.
    #[must_use]
    pub fn read_by_conditions(&self) -> FxHashSet<usize> {
        let mut values: FxHashMap<VarId, Vec<ExprId>> = FxHashMap::default();
        for definition in &self.definitions {
            let of_variable = values.entry(definition.var).or_default();
            of_variable.push(definition.value);
        }
        let relations = self.relations.iter();
        let of_conditions = relations.filter(|relation| match relation.used {
            RelationUse::Exit(..) | RelationUse::When => true,
            RelationUse::Equation | RelationUse::Assert => false,
        });
        let reactions = self.reactions.iter().map(|reaction| reaction.condition);
        let roots = of_conditions.map(|relation| relation.root);
        let mut open: Vec<ExprId> = roots.chain(reactions).collect();
        let (mut seen, mut read) = (FxHashSet::default(), FxHashSet::default());
        while let Some(root) = open.pop() {
            for id in self.exprs.below(&[root]) {
                let (Expr::Var(var, _) | Expr::Pre(var, _)) = self.exprs[id] else {
                    continue;
                };
                let Some(place) = self.place(var).filter(|_| seen.insert(var)) else {
                    continue;
                };
                match place.space {
                    Space::Memory => {
                        read.extend(place.base..place.base + self.variables[var].size());
                    }
                    Space::Work => open.extend(values.get(&var).into_iter().flatten()),
                    Space::Unknown | Space::Input | Space::Parameter => {}
                }
            }
        }
        read
    }
}
