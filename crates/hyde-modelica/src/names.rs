//! [`Names`]: identifiers of everything that has a value. Variables that were eliminated have none.

use hyde_ir::dae::{Dae, Space};
use hyde_ir::{Expr, ExprId, Id as _, ParamId, VarId, VariableKind};
use std::collections::{BTreeMap, BTreeSet};

/// The identifiers of a model.
pub(crate) struct Names<'d> {
    pub(crate) dae: &'d Dae,
    /// The variable and element at each position of the memory.
    memory: BTreeMap<usize, String>,
    /// The variables whose definitions contain held values.
    pub(crate) made_of_held: BTreeSet<VarId>,
}

impl<'d> Names<'d> {
    pub(crate) fn of(dae: &'d Dae) -> Self {
        let mut memory = BTreeMap::new();
        for (var, variable) in dae.variables.enumerate() {
            let Some(place) = dae.place(var).filter(|own| own.space == Space::Memory) else {
                continue;
            };
            for element in 0..variable.size() {
                memory.insert(
                    place.base + element,
                    quoted(&variable.element_name(element)),
                );
            }
        }
        for automaton in dae.automata.iter() {
            memory.insert(automaton.place, mode_name(&automaton.name));
        }
        Self {
            dae,
            memory,
            made_of_held: made_of_held(dae),
        }
    }

    /// An element of a variable.
    pub(crate) fn variable(&self, var: VarId, element: i32) -> String {
        let variable = &self.dae.variables[var];
        if let VariableKind::Column(column, interpolation) = variable.kind {
            return column_name(self.dae, column.index(), interpolation);
        }
        let element = usize::try_from(element).unwrap_or(0);
        quoted(&variable.element_name(element))
    }

    /// An element of a parameter.
    pub(crate) fn parameter(&self, param: ParamId, element: i32) -> String {
        parameter_name(self.dae, param, usize::try_from(element).unwrap_or(0))
    }

    /// Whether a name is that of an input, which an input variable of the model stands for.
    pub(crate) fn is_input(&self, name: &str) -> bool {
        let free = &self.dae.experiment.free;
        free.iter()
            .any(|&param| parameter_name(self.dae, param, 0) == name)
    }

    /// What a position of the memory is called; `None` of the truth of a relation.
    pub(crate) fn memory(&self, position: usize) -> Option<&str> {
        self.memory.get(&position).map(String::as_str)
    }

    /// What a position of the solver's vector is called.
    pub(crate) fn unknown(&self, position: usize) -> String {
        quoted(&self.dae.unknown_name(position))
    }
}

/// The variables whose definitions contain held values, themselves or by other definitions.
fn made_of_held(dae: &Dae) -> BTreeSet<VarId> {
    let is_held = |var: VarId| {
        let place = dae.place(var).filter(|own| own.space == Space::Memory);
        place.is_some_and(|own| {
            let end = own.base + dae.variables[var].size();
            let mut holds = dae.holds.iter();
            holds.any(|hold| hold.target < end && own.base < hold.target + hold.len)
        })
    };
    let mut found = BTreeSet::new();
    if dae.holds.is_empty() {
        return found;
    }
    loop {
        let before = found.len();
        for definition in dae.definitions.iter().filter(|own| !own.slope) {
            let reads = |id: ExprId| {
                let Expr::Var(var, _) = dae.exprs[id] else {
                    return false;
                };
                found.contains(&var) || is_held(var)
            };
            if dae.exprs.below(&[definition.value]).into_iter().any(reads) {
                found.insert(definition.var);
            }
        }
        if found.len() == before {
            return found;
        }
    }
}

/// The number of the mode of an automaton.
pub(crate) fn mode_name(automaton: &str) -> String {
    quoted(&format!("{automaton}.mode"))
}

/// An element of a parameter.
pub(crate) fn parameter_name(dae: &Dae, param: ParamId, element: usize) -> String {
    quoted(&dae.parameters[param].element_name(element))
}

/// A column of a record as an input.
pub(crate) fn column_name(
    dae: &Dae,
    column: usize,
    interpolation: hyde_ir::Interpolation,
) -> String {
    let own = &dae.columns[hyde_ir::ColumnId::from_index(column)];
    let next = if own.next { ".next" } else { "" };
    let held = match interpolation {
        hyde_ir::Interpolation::Held => ".held",
        hyde_ir::Interpolation::Linear => "",
    };
    quoted(&format!("{}.{}{next}{held}", own.record, own.column))
}

/// A quoted identifier; what one may not contain is `_`.
pub(crate) fn quoted(name: &str) -> String {
    let letter = |c: char| match c {
        '\'' | '\\' => '_',
        ' '..='~' => c,
        _ => '_',
    };
    let inner: String = name.chars().map(letter).collect();
    format!("'{inner}'")
}
