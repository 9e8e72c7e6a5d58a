//! [`Program`]: the kernels and everything that is to be known of their numbers.

use crate::event::{Assignment, Clock, Delay, InitialCondition, Pin, Reaction, Relation};
use crate::experiment::Experiment;
use crate::foreign::ForeignPart;
use crate::jacobian::{Jacobian, JacobianEntry};
use crate::kernels::{Constant, Kernels};
use hyde_diag::{Origin, Span};
use hyde_ir::Prior;
use hyde_ir::dae::{Automaton, Function, Hold, Selection};
use hyde_units::{Allowed, Dimension, Kind, NamedUnit};
use std::sync::{Arc, OnceLock};

/// A block of the solver's vector.
#[derive(Clone, Debug)]
pub struct UnknownBlock {
    /// Name of the variable.
    pub name: String,
    /// Whether its elements are called `name[i]`, and what the first one of the block is called.
    pub first: Option<i64>,
    /// Position of the first element.
    pub offset: usize,
    /// Number of elements.
    pub len: usize,
    /// States, whose derivative appears.
    pub differential: bool,
    /// The equations that determine it: its rows have the same numbers.
    pub origins: Vec<Origin>,
}

/// A reported column.
#[derive(Clone, Debug, PartialEq)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its dimension.
    pub dimension: Dimension,
    /// Unit for printing; values are SI.
    pub unit: NamedUnit,
    /// Changes at events only.
    pub discrete: bool,
    /// Made for the experiment (measured, reduced, response) or the energy ledger, not a variable of the model.
    pub auxiliary: bool,
    /// The first output that has the same value by its equations, if that is another: the ends of joined parts are one.
    pub same_as: Option<usize>,
}

/// A parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its full name.
    pub name: String,
    /// Position of its first element in the parameter vector.
    pub place: usize,
    /// Number of elements.
    pub len: usize,
    /// Its dimension.
    pub dimension: Dimension,
    /// Unit for printing; values are SI.
    pub unit: NamedUnit,
    /// The values it may have.
    pub allowed: Allowed,
    /// A change of it compiles anew.
    pub structural: bool,
    /// May not be set.
    pub is_final: bool,
    /// Its value is a guess: an initial equation finds it.
    pub found: bool,
    /// Its spread, if it is uncertain.
    pub prior: Option<Prior>,
    /// Whether it is the `size` of an effect: at 0 the effect vanishes.
    pub is_size: bool,
    /// The values it may have, SI, where that is said.
    pub range: Option<(f64, f64)>,
    /// Where its number comes from.
    pub source: Option<String>,
    /// Where it is declared or modified.
    pub origin: Origin,
}

impl Parameter {
    /// The name of an element (counted from 0): `k[3]`, or the plain name of what has only one.
    #[must_use]
    pub fn element_name(&self, element: usize) -> String {
        match self.len {
            1 => self.name.clone(),
            _ => format!("{}[{}]", self.name, element + 1),
        }
    }
}

/// A column of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The record as the experiment calls it.
    pub record: String,
    /// The name in the header.
    pub column: String,
    /// Read one row ahead.
    pub next: bool,
    /// Whether the continuous equations read it, linearly or held.
    pub continuous: bool,
    /// Whether they read it as it is held, or one row ahead: it steps at every row.
    pub stepped: bool,
    /// Standard deviation of what its values are not known to, SI; 0 if nothing is said.
    pub noise: f64,
    /// The period in s of a clock that gave it, if that ticks several times between two rows.
    pub ticks_s: Option<f64>,
    /// The Integer or Boolean that it drives: its kind, its name, and where that is said. Every row must have such a value.
    pub drives: Option<(Kind, String, Span)>,
}

/// Which number of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecordValueKind {
    /// That of its first row.
    First,
    /// That of its last row.
    Last,
    /// The mean of all rows.
    Mean,
}

impl RecordValueKind {
    /// The number of these rows, of which there is one at least.
    #[must_use]
    pub fn of(self, rows: &[f64]) -> f64 {
        match self {
            Self::First => rows.first().copied().unwrap_or(f64::NAN),
            Self::Last => rows.last().copied().unwrap_or(f64::NAN),
            Self::Mean => rows.iter().sum::<f64>() / rows.len() as f64,
        }
    }
}

/// A parameter that the run fills from a record.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordValue {
    /// Position in the parameter vector.
    pub place: usize,
    /// The record as the experiment calls it.
    pub record: String,
    /// The column; none for the time of the rows.
    pub column: Option<String>,
    /// Which number of it.
    pub kind: RecordValueKind,
}

/// With respect to what a function is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Wrt {
    /// An unknown.
    Unknown(usize),
    /// The derivative of an unknown.
    Derivative(usize),
    /// A parameter, by its position.
    Parameter(usize),
    /// A value in the memory, by its position.
    Memory(usize),
    /// A delayed value.
    Delayed(usize),
    /// Time.
    Time,
}

/// A derivative of a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PartialEntry {
    /// Row of the function.
    pub row: usize,
    /// With respect to what.
    pub wrt: Wrt,
}

/// The places of derivatives and the sparsity of the Jacobian: made when first asked for, because a model of many cells
/// is compiled in no time and has long tables.
#[derive(Clone, Default)]
pub struct Derivatives {
    entries: OnceLock<[Vec<PartialEntry>; 7]>,
    jacobian: OnceLock<Jacobian>,
}

/// An executable hybrid DAE.
#[derive(Clone)]
pub struct Program {
    /// Name of the model.
    pub name: String,
    /// The solver's vector.
    pub unknowns: Vec<UnknownBlock>,
    /// Length of the solver's vector.
    pub n_unknowns: usize,
    /// Length of the memory.
    pub n_memory: usize,
    /// Of a residual that is affine in the unknowns and their derivatives, with coefficients that change at events alone:
    /// how many of the first places of the memory these read. Nothing of any other.
    pub affine_in: Option<usize>,
    /// Length of the workspace.
    pub n_work: usize,
    /// Length of the parameter vector.
    pub n_parameters: usize,
    /// The parameters, derived ones apart.
    pub parameters: Vec<Parameter>,
    /// Parameters that the run fills from a record.
    pub record_values: Vec<RecordValue>,
    /// The record columns.
    pub columns: Vec<Column>,
    /// The reported columns.
    pub outputs: Vec<Output>,
    /// The relations.
    pub relations: Vec<Relation>,
    /// The automata.
    pub automata: Vec<Automaton>,
    /// The reactions: exits and branches in their order of priority.
    pub reactions: Vec<Reaction>,
    /// What reactions set.
    pub assignments: Vec<Assignment>,
    /// Modes that fix states.
    pub pins: Vec<Pin>,
    /// Groups of variables of which the run chooses the states.
    pub selections: Vec<Selection>,
    /// The clocks.
    pub clocks: Vec<Clock>,
    /// The order in which clocks that tick together run.
    pub clock_order: Vec<usize>,
    /// The held values.
    pub holds: Vec<Hold>,
    /// The delayed values, each on its own.
    pub delays: Vec<Delay>,
    /// Number of sines of the time whose rates are known ([`crate::Constant::Turning`]).
    pub turning: usize,
    /// Number of sines in root functions ([`Function::Angles`]).
    pub angles: usize,
    /// Whether the residual has an exponential of unknowns that grows.
    pub exponential: bool,
    /// Whether the residual reads the time, a record column or a delayed value.
    pub timed: bool,
    /// Conditions at the start.
    pub initial: Vec<InitialCondition>,
    /// What is known of the derivatives, once asked for.
    pub derivatives: Derivatives,
    /// The parts that are not equations.
    pub foreign: Vec<ForeignPart>,
    /// What the experiment asks.
    pub experiment: Experiment,
    /// What the compiler decided and a user may want to know.
    pub notes: Vec<String>,
    /// The numbers.
    pub kernels: Arc<dyn Kernels>,
}

impl Program {
    /// Whether sources that turn may switch something on and off by an exponential, as a rectifier does that takes its current
    /// in pulses: a method that evaluates the ends of its steps alone may pass over one.
    #[must_use]
    pub fn may_pulse(&self) -> bool {
        self.exponential && self.turning > 0
    }

    /// The shortest period of a sine of the time whose rate is known, in s; infinite without one.
    #[must_use]
    pub fn shortest_period_s(&self, parameters: &[f64]) -> f64 {
        let rate = |number| self.kernels.constant(Constant::Turning(number), parameters);
        let rates = (0..self.turning).filter_map(rate).map(f64::abs);
        std::f64::consts::TAU / rates.fold(0.0, f64::max)
    }

    /// The derivatives of a function, in the order its kernel writes them.
    #[must_use]
    pub fn partials(&self, function: Function) -> &[PartialEntry] {
        let all = self
            .derivatives
            .entries
            .get_or_init(|| Function::ALL.map(|function| self.kernels.entries(function)));
        let number = Function::ALL.iter().position(|known| *known == function);
        number.map_or(&[], |number| &all[number])
    }

    /// The sparsity of the Jacobian.
    #[must_use]
    pub fn jacobian(&self) -> &Jacobian {
        self.derivatives
            .jacobian
            .get_or_init(|| self.jacobian_of(self.partials(Function::Residual)))
    }

    /// Number of values of a function.
    #[must_use]
    pub fn rows(&self, function: Function) -> usize {
        match function {
            Function::Residual => self.n_unknowns,
            Function::Roots => self.relations.len(),
            Function::Assignments => self.assignments.len() + self.pins.len(),
            Function::Outputs => self.outputs.len(),
            Function::Initial => self
                .initial
                .iter()
                .map(|condition| match condition {
                    InitialCondition::Equation { len, .. } => *len,
                    InitialCondition::Fixed { .. } => 0,
                    InitialCondition::Check { .. } => 2,
                })
                .sum(),
            Function::Delayed => self.delays.len(),
            Function::Angles => self.angles,
        }
    }

    /// Number of the initial conditions' values that are equations; those of checks follow.
    #[must_use]
    pub fn n_initial_equations(&self) -> usize {
        let equations = self.initial.iter().map(|condition| match condition {
            InitialCondition::Equation { len, .. } => *len,
            InitialCondition::Fixed { .. } | InitialCondition::Check { .. } => 0,
        });
        equations.sum()
    }

    /// Whether each unknown is a state, with the choice of states that the memory holds.
    #[must_use]
    pub fn differential(&self, memory: &[f64]) -> Vec<bool> {
        let mut found = vec![false; self.n_unknowns];
        for block in self.unknowns.iter().filter(|block| block.differential) {
            found[block.offset..block.offset + block.len]
                .iter_mut()
                .for_each(|flag| *flag = true);
        }
        for selection in &self.selections {
            let m = selection.candidates.len();
            let factors = &memory[selection.factors..][..m * (m - selection.constraints.len())];
            for (column, &candidate) in selection.candidates.iter().enumerate() {
                found[candidate] = factors.iter().skip(column).step_by(m).any(|&f| f != 0.0);
            }
        }
        found
    }

    /// The block of an element of the solver's vector.
    #[must_use]
    pub fn block(&self, position: usize) -> Option<&UnknownBlock> {
        self.unknowns
            .iter()
            .find(|block| (block.offset..block.offset + block.len).contains(&position))
    }

    /// The name of an element of the solver's vector.
    #[must_use]
    pub fn unknown_name(&self, position: usize) -> String {
        self.block(position).map_or_else(
            || format!("unknown {position}"),
            |block| match block.first {
                None => block.name.clone(),
                Some(first) => {
                    let number = first + i64::try_from(position - block.offset).unwrap_or(0);
                    format!("{}[{number}]", block.name)
                }
            },
        )
    }

    /// The parameter of that name with the number of an element: `motor.R`, `k[2]`.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<(&Parameter, usize)> {
        if let Some(found) = self
            .parameters
            .iter()
            .find(|parameter| parameter.name == name)
        {
            return Some((found, 0));
        }
        let (array, rest) = name.rsplit_once('[')?;
        let number: usize = rest.strip_suffix(']')?.parse().ok()?;
        let found = self
            .parameters
            .iter()
            .find(|parameter| parameter.name == array)?;
        let element = number.checked_sub(1)?;
        (element < found.len).then_some((found, element))
    }

    /// The parameter that has an element at a position of the parameter vector, and the name of the element.
    #[must_use]
    pub fn parameter_at(&self, place: usize) -> Option<(&Parameter, String)> {
        let inside = |known: &&Parameter| (known.place..known.place + known.len).contains(&place);
        let parameter = self.parameters.iter().find(inside)?;
        Some((parameter, parameter.element_name(place - parameter.place)))
    }

    /// The output of that name.
    #[must_use]
    pub fn output(&self, name: &str) -> Option<usize> {
        self.outputs
            .iter()
            .position(|output| output.name == name && !output.auxiliary)
    }

    /// The Jacobian's pattern from the derivatives of the residual: by unknowns and their derivatives, then by delayed
    /// values, which are no entries.
    #[must_use]
    fn jacobian_of(&self, partials: &[PartialEntry]) -> Jacobian {
        let entries: Vec<JacobianEntry> = partials
            .iter()
            .filter_map(|entry| match entry.wrt {
                Wrt::Unknown(column) => Some(JacobianEntry {
                    row: entry.row,
                    column,
                    by_derivative: false,
                }),
                Wrt::Derivative(column) => Some(JacobianEntry {
                    row: entry.row,
                    column,
                    by_derivative: true,
                }),
                Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => None,
            })
            .collect();
        Jacobian::new(self.n_unknowns, &entries, &self.kernels.sliding_cells())
    }
}
