//! [`States`]: what the compiler made of the variables with derivatives, for those who want to know.

use hyde_diag::Origin;
use hyde_ir::dae::{Alias, Choice, Firmness, InitialCondition};
use hyde_ir::{Dae, StateChoice, VarId};
use std::collections::BTreeSet;

/// The states of a model.
#[derive(Clone, Debug, Default)]
pub struct States {
    /// States for the whole run; of arrays their bounds, `th[0] .. th[24]`.
    pub states: Vec<String>,
    /// Groups of which the run chooses the states.
    pub chosen: Vec<Choice>,
    /// Variables that were meant as states (by `fixed` or `state =`) and are given by others, each with its equation.
    pub dependent: Vec<(String, Origin)>,
    /// States that no condition of the model fixes at the start: they begin at their start values, unless one of the initial
    /// equations determines them.
    pub filled: Vec<String>,
    /// The number of initial equations; the run tells what each determines.
    pub equations: usize,
}

/// Whether a variable is equal to a state, as the speed of a body that is joined to the end of a field.
fn is_state_by_another_name(dae: &Dae, var: VarId) -> bool {
    let is_state = |other: VarId| {
        let mut own = dae.unknowns.iter();
        own.any(|block| block.var == other && block.differential)
    };
    let alias = dae.aliases.iter().any(|(own, alias)| {
        *own == var && matches!(alias, Alias::Of { var, .. } if is_state(*var))
    });
    let mut definitions = dae.definitions.iter().filter(|known| known.var == var);
    alias
        || definitions.any(|known| match dae.exprs[known.value].access() {
            Some((other, _, derivative)) => !derivative && is_state(other),
            None => false,
        })
}

impl States {
    pub(crate) fn of(dae: &Dae) -> Self {
        let blocks = dae.blocks();
        let name = |position: usize, len: usize| {
            let Some(block) = blocks.at(position) else {
                return String::new();
            };
            let block = &dae.unknowns[block];
            let variable = &dae.variables[block.var];
            let first = block.first + position - block.offset;
            match len {
                1 => variable.element_name(first),
                _ => format!(
                    "{} .. {}",
                    variable.element_name(first),
                    variable.element_name(first + len - 1)
                ),
            }
        };
        let groups = dae.selections.iter();
        let chosen: BTreeSet<usize> = groups.flat_map(|group| group.candidates.clone()).collect();
        let states = dae
            .unknowns
            .iter()
            .filter(|block| block.differential && !chosen.contains(&block.offset));
        // What its author gave a start or a choice was meant as a state.
        let meant = dae.dependent.iter().filter(|d| {
            let variable = &dae.variables[d.var];
            let meant = variable.fixed || variable.state != StateChoice::Open;
            meant && !is_state_by_another_name(dae, d.var)
        });
        let dependent = meant.map(|d| (dae.dependent_name(d), d.origin.clone()));
        let equations = dae.initial.iter().map(|condition| match condition {
            InitialCondition::Equation { range, .. } => range.len(),
            InitialCondition::Fixed { .. } | InitialCondition::Check { .. } => 0,
        });
        let equations = equations.sum();
        let filled = dae.initial.iter().filter_map(|condition| match condition {
            InitialCondition::Fixed {
                state,
                len,
                firmness,
                yields: false,
                ..
            } if *firmness < Firmness::Default => Some(name(*state, *len)),
            InitialCondition::Fixed { .. }
            | InitialCondition::Equation { .. }
            | InitialCondition::Check { .. } => None,
        });
        Self {
            states: states.map(|b| name(b.offset, b.len)).collect(),
            chosen: dae
                .selections
                .iter()
                .map(|group| dae.choice(group))
                .collect(),
            dependent: dependent.collect(),
            filled: filled.collect(),
            equations,
        }
    }
}
