//! Relations that may turn without any effect: `load > 0 and speed > 0` is false whatever the speed does while there is no load.

use super::State;
use crate::moment::At;
use hyde_program::{Function, Program, RelationUse};

impl State<'_> {
    /// Turns the truths of relations over if that has no effect: no equation reads them, and with them turned every condition
    /// and every root function is what it was. Whether it has none.
    pub(crate) fn turns_without_effect(&mut self, relations: &[usize], at: At<'_>) -> bool {
        let program = self.program;
        let read_by_equations = |number: &usize| {
            let relation = program.relations.get(*number);
            relation.is_none_or(|relation| relation.used == RelationUse::Equation)
        };
        if relations.iter().any(read_by_equations) {
            return false;
        }
        let before = (self.conditions(at), self.values(Function::Roots, at));
        Program::turn(&mut self.z, relations);
        let after = (self.conditions(at), self.values(Function::Roots, at));
        let roots = before.1.iter().zip(&after.1);
        let mut same_roots = roots.map(|(a, b)| a.to_bits() == b.to_bits());
        let without = before.0 == after.0 && same_roots.all(|same| same);
        if !without {
            Program::turn(&mut self.z, relations);
        }
        without
    }
}
