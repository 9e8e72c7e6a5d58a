//! Aliases: quantities that are one by the equations, as the positions of joined parts are, have one variable and further names.

use super::{Causality, Interface, Source, Variable};
use hyde_program::Program;
use std::collections::BTreeMap;

impl Interface {
    /// Marks the aliases among the reported quantities that are local. The variable of several is the state or derivative among
    /// them, or else the first. An output has no further names: an alias has the causality of its variable, so that importers
    /// would list each as an output.
    pub(super) fn find_aliases(&mut self, program: &Program, names: &BTreeMap<String, usize>) {
        let mut same: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for (number, output) in program.outputs.iter().enumerate() {
            let Some(&variable) = names.get(&output.name) else {
                continue;
            };
            if !output.auxiliary && self.variables[variable].is_inner() {
                let first = output.same_as.unwrap_or(number);
                same.entry(first).or_default().push(variable);
            }
        }
        for numbers in same.into_values() {
            let of_solver = |number: &&usize| !self.variables[**number].is_computed();
            let Some(&chosen) = numbers.iter().find(of_solver).or(numbers.first()) else {
                continue;
            };
            let of = self.variables[chosen].clone();
            for number in numbers.into_iter().filter(|number| *number != chosen) {
                let own = &mut self.variables[number];
                if own.may_be_alias(&of) {
                    own.alias_of = Some(chosen);
                }
            }
        }
    }

    /// The aliases by the number of their variable.
    pub(crate) fn aliases(&self) -> BTreeMap<usize, Vec<&Variable>> {
        let mut found: BTreeMap<usize, Vec<&Variable>> = BTreeMap::new();
        for own in &self.variables {
            if let Some(of) = own.alias_of {
                found.entry(of).or_default().push(own);
            }
        }
        found
    }
}

impl Variable {
    /// Whether it is a quantity inside of the model, not a parameter.
    fn is_inner(&self) -> bool {
        let of_run = matches!(
            self.source,
            Source::Output(_) | Source::State(_) | Source::Derivative(_)
        );
        of_run && self.causality == Causality::Local
    }

    /// Whether it is computed, neither a state nor a derivative.
    fn is_computed(&self) -> bool {
        matches!(self.source, Source::Output(_))
    }

    /// Whether it says nothing that another variable with the same value does not.
    fn may_be_alias(&self, of: &Self) -> bool {
        let si = |own: &Self| own.unit.as_ref().map(|unit| unit.si().text().to_owned());
        self.is_computed()
            && self.variability == of.variability
            && self.kind == of.kind
            && si(self) == si(of)
    }
}
