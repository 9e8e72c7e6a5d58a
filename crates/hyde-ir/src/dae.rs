//! [`Dae`]: what can be solved. `0 = F(t, y, y', z, u, p)` with one residual an unknown, everything else ordered.

mod affine;
mod arithmetic;
mod clock;
mod equation;
mod event;
mod guarded;
mod initial;
mod partial;
mod place;
mod relation;
mod selection;

pub use clock::{ClockedAssignment, Hold, Tick};
pub use equation::{Definition, Residual};
pub use event::{Assignment, Automaton, Pin, Reaction, ReactionKind, Target};
pub use initial::{Firmness, InitialCondition, Start};
pub use partial::{Function, Partial, Wrt};
pub use place::{Alias, Place, Space, Unknown};
pub use relation::{Relation, RelationUse};
pub use selection::{Choice, Dependent, Selection};

use crate::flat::{Delay, Experiment};
use crate::id::{
    AutomatonId, ClockId, ColumnId, DelayId, ExprId, IdVec, ParamId, RelationId, UnknownId, VarId,
};
use crate::{Column, ExprArena, Parameter, Quantity, Range, Variable};
use rustc_hash::FxHashMap;

/// A reported quantity: scalar, or an array with one column an element.
#[derive(Clone, Debug)]
pub struct Output {
    /// Names of its columns.
    pub names: Vec<String>,
    /// Values of the counter, one a column.
    pub range: Range,
    /// Its value.
    pub value: ExprId,
    /// Dimension and printed unit.
    pub quantity: Quantity,
    /// Whether it jumps at events only: clocked, discrete or held.
    pub discrete: bool,
}

/// The model, ready to be solved.
#[derive(Clone, Debug, Default)]
pub struct Dae {
    /// Name of the model.
    pub name: String,
    /// All expressions.
    pub exprs: ExprArena,
    /// All variables, eliminated ones too.
    pub variables: IdVec<VarId, Variable>,
    /// Where the kept ones live; `None` for eliminated ones.
    pub places: IdVec<VarId, Option<Place>>,
    /// What the eliminated scalars stand for.
    pub aliases: Vec<(VarId, Alias)>,
    /// All parameters, derived ones last.
    pub parameters: IdVec<ParamId, Parameter>,
    /// All parameters, each after those its value uses; derived ones last.
    pub parameter_order: Vec<ParamId>,
    /// Position of each parameter's first element.
    pub parameter_places: IdVec<ParamId, usize>,
    /// The record columns; column k is read linearly at 2k and held at 2k + 1 of the inputs.
    pub columns: IdVec<ColumnId, Column>,
    /// The solver's vector, block after block.
    pub unknowns: IdVec<UnknownId, Unknown>,
    /// One a block of unknowns, in the same order.
    pub residuals: Vec<Residual>,
    /// Explicit variables, each after those it uses.
    pub definitions: Vec<Definition>,
    /// Relations; relation k's truth is at position k of the memory.
    pub relations: IdVec<RelationId, Relation>,
    /// Automata.
    pub automata: IdVec<AutomatonId, Automaton>,
    /// Reactions: exits in order of priority, branches in order of priority, asserts.
    pub reactions: Vec<Reaction>,
    /// What reactions set.
    pub assignments: Vec<Assignment>,
    /// Modes that fix states.
    pub pins: Vec<Pin>,
    /// Groups of variables of which the run chooses the states.
    pub selections: Vec<Selection>,
    /// Variables that constraints give for the whole run, in the order found.
    pub dependent: Vec<Dependent>,
    /// Clocked partitions.
    pub ticks: IdVec<ClockId, Tick>,
    /// The order in which partitions that tick together run.
    pub tick_order: Vec<ClockId>,
    /// Held values.
    pub holds: Vec<Hold>,
    /// What something outside the equations computes.
    pub foreign: Vec<crate::flat::Foreign>,
    /// Delayed quantities; their values follow those of the columns among the inputs, delay after delay.
    pub delays: IdVec<DelayId, Delay>,
    /// Conditions at the start.
    pub initial: Vec<InitialCondition>,
    /// Start values of unknowns and memory.
    pub starts: Vec<Start>,
    /// Reported quantities; then the experiment's measured expressions, then its reductions', one scalar each.
    pub outputs: Vec<Output>,
    /// Derivatives of the functions by unknowns, derivatives of unknowns and time.
    pub partials: Vec<(Function, Vec<Partial>)>,
    /// How fast the arguments of sines turn that the time and parameters determine, where these rates are constant; rad/s.
    pub turning: Vec<ExprId>,
    /// Arguments of the sines and cosines in root functions, rad.
    pub angles: Vec<ExprId>,
    /// Whether the residual has an exponential of unknowns that grows.
    pub exponential: bool,
    /// Whether the residual reads the time, a record column or a delayed value.
    pub timed: bool,
    /// What the experiment adds.
    pub experiment: Experiment,
    /// Length of the solver's vector.
    pub n_unknowns: usize,
    /// Length of the memory.
    pub n_memory: usize,
    /// Length of the work vector.
    pub n_work: usize,
    /// Length of the parameter vector, and of its part that is not derived.
    pub n_parameters: (usize, usize),
    /// What the analysis decided and a user may want to know.
    pub notes: Vec<String>,
}

/// The blocks of the solver's vector in the order of their positions, each with that of its first element.
pub struct Blocks(Vec<(usize, UnknownId)>);

impl Blocks {
    /// The block that a position of the vector is in.
    #[must_use]
    pub fn at(&self, position: usize) -> Option<UnknownId> {
        let after = self.0.partition_point(|(offset, _)| *offset <= position);
        Some(self.0.get(after.checked_sub(1)?)?.1)
    }
}

impl Dae {
    /// The blocks of the solver's vector in the order of their positions.
    #[must_use]
    pub fn blocks(&self) -> Blocks {
        let all = self.unknowns.enumerate();
        let mut blocks: Vec<(usize, UnknownId)> =
            all.map(|(id, block)| (block.offset, id)).collect();
        blocks.sort_unstable();
        Blocks(blocks)
    }

    /// The name of the unknown at a position of the solver's vector.
    #[must_use]
    pub fn unknown_name(&self, position: usize) -> String {
        let mut blocks = self.unknowns.iter();
        let inside =
            |block: &&Unknown| (block.offset..block.offset + block.len).contains(&position);
        blocks.find(inside).map_or_else(
            || format!("y[{position}]"),
            |block| self.variables[block.var].element_name(block.first + position - block.offset),
        )
    }

    /// Where a variable that was kept lives.
    #[must_use]
    pub fn place(&self, var: VarId) -> Option<Place> {
        match self.variables[var].kind {
            crate::VariableKind::Column(column, interpolation) => {
                let held = usize::from(interpolation == crate::Interpolation::Held);
                Some(Place {
                    space: Space::Input,
                    base: 2 * crate::Id::index(column) + held,
                })
            }
            crate::VariableKind::Delayed(delay) => Some(Place {
                space: Space::Input,
                base: 2 * self.columns.len() + self.delay_offset(delay),
            }),
            crate::VariableKind::Continuous
            | crate::VariableKind::Discrete
            | crate::VariableKind::Clocked(_)
            | crate::VariableKind::Held(..)
            | crate::VariableKind::Reduction(_) => self.places[var],
        }
    }

    /// The numbers of the definitions of each variable that has any.
    #[must_use]
    pub fn definitions_of_variables(&self) -> FxHashMap<VarId, Vec<usize>> {
        let mut found: FxHashMap<VarId, Vec<usize>> = FxHashMap::default();
        for (number, definition) in self.definitions.iter().enumerate() {
            found.entry(definition.var).or_default().push(number);
        }
        found
    }

    /// The values that the continuous equations are made of: residuals, definitions, relations.
    #[must_use]
    pub fn equation_values(&self) -> Vec<ExprId> {
        let residuals = self.residuals.iter().map(|residual| residual.value);
        let definitions = self.definitions.iter().map(|definition| definition.value);
        let relations = self.relations.iter().map(|relation| relation.root);
        residuals.chain(definitions).chain(relations).collect()
    }

    /// Number of the first delayed value of a delay.
    #[must_use]
    pub fn delay_offset(&self, delay: DelayId) -> usize {
        let before = self.delays.iter().take(crate::Id::index(delay));
        before.map(|delay| delay.range.len()).sum()
    }

    /// Number of delayed values.
    #[must_use]
    pub fn n_delayed(&self) -> usize {
        self.delays.iter().map(|delay| delay.range.len()).sum()
    }

    /// The name of what is dependent: of an array with its bounds.
    #[must_use]
    pub fn dependent_name(&self, dependent: &Dependent) -> String {
        let variable = &self.variables[dependent.var];
        let first = variable.element_name(dependent.element);
        match dependent.len {
            1 => first,
            len => format!(
                "{first} .. {}",
                variable.element_name(dependent.element + len - 1)
            ),
        }
    }

    /// A selection in names: what the run chooses from, how many are states, and where the constraints are written.
    #[must_use]
    pub fn choice(&self, selection: &Selection) -> Choice {
        let name = |&position: &usize| {
            let inside = |b: &&Unknown| (b.offset..b.offset + b.len).contains(&position);
            let block = self.unknowns.iter().find(inside);
            block.map_or_else(String::new, |block| {
                self.variables[block.var].element_name(block.first + position - block.offset)
            })
        };
        let origins = selection.constraints.iter().flat_map(|&row| {
            let mut blocks = self.unknowns.enumerate();
            let found = blocks.find(|(_, b)| (b.offset..b.offset + b.len).contains(&row));
            let residual =
                found.and_then(|(id, _)| self.residuals.iter().find(|r| r.unknown == id));
            residual.map_or_else(Vec::new, |residual| residual.origins.clone())
        });
        Choice {
            candidates: selection.candidates.iter().map(name).collect(),
            states: selection.candidates.len() - selection.constraints.len(),
            constraints: origins.collect(),
        }
    }

    /// The derivatives of a function.
    #[must_use]
    pub fn partials(&self, function: Function) -> &[Partial] {
        self.partials
            .iter()
            .find(|(f, _)| *f == function)
            .map_or(&[], |(_, list)| list)
    }

    /// Number of reported columns.
    #[must_use]
    pub fn n_outputs(&self) -> usize {
        self.outputs.iter().map(|output| output.range.len()).sum()
    }

    /// Number of values of the initial conditions: one of each equation, two of each start value to be checked.
    #[must_use]
    fn n_initial_values(&self) -> usize {
        self.initial
            .iter()
            .map(|condition| match condition {
                InitialCondition::Equation { range, .. } => range.len(),
                InitialCondition::Fixed { .. } => 0,
                InitialCondition::Check { .. } => 2,
            })
            .sum()
    }

    /// Number of values of a function.
    #[must_use]
    pub fn rows(&self, function: Function) -> usize {
        match function {
            Function::Residual => self.n_unknowns,
            Function::Roots => self.relations.len(),
            Function::Assignments => self.assignments.len() + self.pins.len(),
            Function::Outputs => self.n_outputs(),
            Function::Initial => self.n_initial_values(),
            Function::Delayed => self.n_delayed(),
            Function::Angles => self.angles.len(),
        }
    }
}
