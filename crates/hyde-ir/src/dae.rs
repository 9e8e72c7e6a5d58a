//! [`Dae`]: what can be solved. `0 = F(t, y, y', z, u, p)` with one residual an unknown, everything else ordered.

use crate::flat::Experiment;
use crate::id::{
    AutomatonId, ClockId, ColumnId, ExprId, IdVec, ParamId, RelationId, UnknownId, VarId,
};
use crate::{Column, ExprArena, Index, Parameter, Quantity, Range, Variable};
use hyde_diag::Origin;

/// Where values lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Space {
    /// The solver's vector: states and implicit algebraic variables.
    Unknown,
    /// What changes only at events: truths of relations, modes, discrete, clocked and held variables.
    Memory,
    /// Columns of records at the current time.
    Input,
    /// Explicit variables, computed from the others.
    Work,
    /// Parameters, then what is derived from them alone.
    Parameter,
}

/// A variable's first element within a space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The space.
    pub space: Space,
    /// Position of element 0.
    pub base: usize,
}

/// What a variable that was eliminated stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alias {
    /// An element of another variable, negated or not.
    Of {
        /// The variable kept.
        var: VarId,
        /// Its element.
        element: usize,
        /// Whether the sign differs.
        negated: bool,
    },
    /// An expression of parameters alone.
    Value(ExprId),
}

/// A block of the solver's vector: consecutive elements of one variable with one residual each.
#[derive(Clone, Debug)]
pub struct Unknown {
    /// The variable.
    pub var: VarId,
    /// Its first element in this block.
    pub first: usize,
    /// Number of elements.
    pub len: usize,
    /// Position of the first element in the vector; its residual is the row of the same number.
    pub offset: usize,
    /// A state: its derivative appears.
    pub differential: bool,
}

/// `0 = value`, for every value of the counter; the rows are those of the unknown it is matched to.
#[derive(Clone, Debug)]
pub struct Residual {
    /// The block of unknowns.
    pub unknown: UnknownId,
    /// Values of the counter.
    pub range: Range,
    /// Row of a value of the counter (stride 1 or -1).
    pub row: Index,
    /// The residual.
    pub value: ExprId,
    /// The equations it is made of: one, or one a mode.
    pub origins: Vec<Origin>,
}

/// `variable[index] = value`: an explicit variable, in terms of `y, y', z, u, p` and earlier definitions.
#[derive(Clone, Debug)]
pub struct Definition {
    /// The variable.
    pub var: VarId,
    /// Values of the counter.
    pub range: Range,
    /// Element of the variable at a value of the counter (stride 1 or -1; a scalar has stride 0).
    pub index: Index,
    /// Its value.
    pub value: ExprId,
    /// The equation it comes from.
    pub origin: Origin,
}

/// What a relation is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RelationUse {
    /// Its frozen truth stands in equations: an event whenever it changes.
    Equation,
    /// It stands in an exit of that mode: watched while the mode is on.
    Exit(AutomatonId, u32),
    /// It stands in a `when` condition.
    When,
    /// It stands in an `assert`.
    Assert,
}

/// A relation: true where its root function is positive (or not negative, if inclusive).
#[derive(Clone, Debug)]
pub struct Relation {
    /// Root function `g`.
    pub root: ExprId,
    /// Whether `g = 0` counts as true where the flow does not decide (M2).
    pub inclusive: bool,
    /// `g = sign*time - s`: the instant is `s*sign`, scheduled and never searched for.
    pub time_event: Option<ExprId>,
    /// What it is for.
    pub used: RelationUse,
    /// As written.
    pub text: String,
    /// Where it is written.
    pub origin: Origin,
}

/// The modes of an automaton.
#[derive(Clone, Debug)]
pub struct AutomatonInfo {
    /// Its full name.
    pub name: String,
    /// The names of its modes.
    pub modes: Vec<String>,
    /// Number of the first mode.
    pub initial: usize,
    /// Position of its mode in the memory.
    pub place: usize,
    /// Where it is written.
    pub origin: Origin,
}

/// Where an event writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// The solver's vector.
    State(usize),
    /// The memory.
    Memory(usize),
}

/// One thing an event sets.
#[derive(Clone, Debug)]
pub struct Assignment {
    /// Where.
    pub target: Target,
    /// To what, from the values before the event.
    pub value: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// What happens when a condition becomes true.
#[derive(Clone, Debug)]
pub enum ReactionKind {
    /// An exit of a mode.
    Transition {
        /// The automaton.
        automaton: AutomatonId,
        /// Number of the mode left.
        from: usize,
        /// Number of the mode entered.
        to: usize,
        /// The jump of a pinned state on entry is meant.
        impact: bool,
    },
    /// A branch of a `when` clause; of the branches of one clause the first that becomes true reacts.
    When {
        /// Number of the clause.
        clause: usize,
    },
    /// A condition that must never be false; its message.
    Assert(String),
}

/// A condition over truths and what it sets in motion.
#[derive(Clone, Debug)]
pub struct Reaction {
    /// The condition.
    pub condition: ExprId,
    /// What happens.
    pub kind: ReactionKind,
    /// Its assignments: a range of [`Dae::assignments`].
    pub assignments: std::ops::Range<usize>,
    /// As written.
    pub text: String,
    /// Where it is written.
    pub origin: Origin,
}

/// A mode that fixes a state (M3).
#[derive(Clone, Debug)]
pub struct Pin {
    /// The automaton.
    pub automaton: AutomatonId,
    /// Number of the mode.
    pub mode: usize,
    /// Position of the state in the solver's vector.
    pub state: usize,
    /// What it is fixed to.
    pub value: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// Variables of one order that constraints tie to each other: as many as there are no constraints for are states, and
/// the run chooses which (dummy derivatives).
#[derive(Clone, Debug)]
pub struct Selection {
    /// Positions of the variables in the solver's vector.
    pub candidates: Vec<usize>,
    /// Rows of the constraints.
    pub constraints: Vec<usize>,
    /// Position of the factors in the memory: for each state a row with a one at the variable chosen.
    pub factors: usize,
}

/// One assignment of a tick.
#[derive(Clone, Debug)]
pub struct ClockedAssignment {
    /// The clocked variable.
    pub var: VarId,
    /// Values of the counter.
    pub range: Range,
    /// Its element at a value of the counter.
    pub index: Index,
    /// Its new value; `Pre` is the value at the last tick.
    pub value: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// A clocked partition, sorted.
#[derive(Clone, Debug)]
pub struct Tick {
    /// Its full name.
    pub name: String,
    /// Period in s, of parameters alone.
    pub period: ExprId,
    /// From the tick to the change of held values, in s.
    pub delay: ExprId,
    /// First tick in s.
    pub phase: ExprId,
    /// In the order of computation.
    pub assignments: Vec<ClockedAssignment>,
    /// Where it is written.
    pub origin: Origin,
}

/// `hold(source)`.
#[derive(Clone, Debug)]
pub struct Hold {
    /// The clock of the source.
    pub clock: ClockId,
    /// Position of the source in the memory.
    pub source: usize,
    /// Position of the held value in the memory.
    pub target: usize,
    /// Number of elements.
    pub len: usize,
    /// Whether the continuous equations read it: a change of it is an event.
    pub read: bool,
}

/// Why a condition is part of the initial system (I3).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// `fixed = true` or an `initial equation`.
    Declared,
    /// Taken from the start value of a state because conditions were missing.
    Filled,
}

/// A condition at the start.
#[derive(Clone, Debug)]
pub enum InitialCondition {
    /// States take their start values.
    Fixed {
        /// Position of the first in the solver's vector.
        state: usize,
        /// Number of them.
        len: usize,
        /// Why.
        reason: Reason,
    },
    /// `0 = value`.
    Equation {
        /// Values of the counter.
        range: Range,
        /// The residual.
        value: ExprId,
        /// Where it is written.
        origin: Origin,
    },
}

/// Start value of the elements of a place.
#[derive(Clone, Debug)]
pub struct Start {
    /// Where.
    pub place: Place,
    /// Values of the counter.
    pub range: Range,
    /// Element at a value of the counter.
    pub index: Index,
    /// Of parameters alone.
    pub value: ExprId,
}

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

/// With respect to what a function is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Wrt {
    /// An unknown: element at a value of the counter, in the solver's vector.
    Unknown(Index),
    /// The derivative of an unknown.
    Derivative(Index),
    /// A parameter, by its position.
    Parameter(usize),
    /// Time.
    Time,
}

/// Derivatives of a range of rows of a function.
#[derive(Clone, Debug)]
pub struct Partial {
    /// Values of the counter.
    pub range: Range,
    /// Row at a value of the counter.
    pub row: Index,
    /// With respect to what.
    pub wrt: Wrt,
    /// The derivative.
    pub value: ExprId,
}

/// The functions that a program offers with their derivatives (S2).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Function {
    /// `F`.
    Residual,
    /// Root functions of the relations.
    Roots,
    /// Values that events assign, then the values of the pins.
    Assignments,
    /// Reported quantities.
    Outputs,
    /// Conditions at the start that are equations.
    Initial,
}

impl Function {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Residual,
        Self::Roots,
        Self::Assignments,
        Self::Outputs,
        Self::Initial,
    ];
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
    pub automata: IdVec<AutomatonId, AutomatonInfo>,
    /// Reactions: exits in order of priority, branches in order of priority, asserts.
    pub reactions: Vec<Reaction>,
    /// What reactions set.
    pub assignments: Vec<Assignment>,
    /// Modes that fix states.
    pub pins: Vec<Pin>,
    /// Groups of variables of which the run chooses the states.
    pub selections: Vec<Selection>,
    /// Clocked partitions.
    pub ticks: IdVec<ClockId, Tick>,
    /// The order in which partitions that tick together run.
    pub tick_order: Vec<ClockId>,
    /// Held values.
    pub holds: Vec<Hold>,
    /// Conditions at the start.
    pub initial: Vec<InitialCondition>,
    /// Start values of unknowns and memory.
    pub starts: Vec<Start>,
    /// Reported quantities; then the experiment's measured expressions, then its reductions', one scalar each.
    pub outputs: Vec<Output>,
    /// Derivatives of the functions by unknowns, derivatives of unknowns and time.
    pub partials: Vec<(Function, Vec<Partial>)>,
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

impl Dae {
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
            crate::VariableKind::Continuous
            | crate::VariableKind::Discrete
            | crate::VariableKind::Clocked(_)
            | crate::VariableKind::Held(..)
            | crate::VariableKind::Reduction(_) => self.places[var],
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

    /// Number of initial conditions that are equations.
    #[must_use]
    pub fn n_initial_equations(&self) -> usize {
        self.initial
            .iter()
            .map(|condition| match condition {
                InitialCondition::Equation { range, .. } => range.len(),
                InitialCondition::Fixed { .. } => 0,
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
            Function::Initial => self.n_initial_equations(),
        }
    }
}
