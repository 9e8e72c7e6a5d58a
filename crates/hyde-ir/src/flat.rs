//! [`FlatModel`]: what flatten leaves. Every variable and equation of every instance; nothing solved yet.

mod figure;
mod response;

use crate::id::{AutomatonId, ClockId, ColumnId, DelayId, ExprId, IdVec, ParamId, VarId};
use crate::{Column, ExprArena, Index, Parameter, Quantity, Range, Variable};
pub use figure::{Curve, Figure, FigureKind};
use hyde_diag::{FileId, InstancePath, Origin, Span};
pub use response::{Bode, Cut, MeasuredResponse, Moment, RecordedResponse, ScaledColumn, Stepped};
use std::collections::BTreeMap;

/// `lhs = rhs`, for every value of the counter in the range.
#[derive(Clone, Debug)]
pub struct Equation {
    /// Values of the counter.
    pub range: Range,
    /// Left side.
    pub lhs: ExprId,
    /// Right side.
    pub rhs: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// What an event sets.
#[derive(Clone, Debug)]
pub enum Action {
    /// `reinit(x, e)`: a state takes a value.
    Reinit(VarId, Index, ExprId),
    /// A discrete variable takes a value.
    Assign(VarId, Index, ExprId),
}

/// An exit of a mode.
#[derive(Clone, Debug)]
pub struct Transition {
    /// Becomes true: leave the mode.
    pub guard: ExprId,
    /// Number of the mode entered.
    pub target: usize,
    /// Values of the entered mode's parameters, and resets of states.
    pub actions: Vec<Action>,
    /// The jump of a pinned state on entry is meant (M3).
    pub impact: bool,
    /// Where it is written.
    pub origin: Origin,
}

/// A mode of an automaton.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Its name.
    pub name: String,
    /// Its equations; as many in every mode (M1).
    pub equations: Vec<Equation>,
    /// Its exits in order of priority (M2).
    pub exits: Vec<Transition>,
    /// Where it is written.
    pub origin: Origin,
}

/// A `modes` block of an instance.
#[derive(Clone, Debug)]
pub struct Automaton {
    /// Full name: the instance, and the block's own name if it has one.
    pub name: String,
    /// Its modes in the order written.
    pub modes: Vec<Mode>,
    /// Number of the first mode.
    pub initial: usize,
    /// Values of the first mode's parameters.
    pub initial_actions: Vec<Action>,
    /// Where it is written.
    pub origin: Origin,
}

/// `when condition then … elsewhen … end when`.
#[derive(Clone, Debug)]
pub struct When {
    /// Conditions in order of priority, each with what it sets on becoming true.
    pub branches: Vec<(ExprId, Vec<Action>)>,
    /// Where it is written.
    pub origin: Origin,
}

/// `edge(condition)`: true in the round of an event's iteration in which the condition became true.
#[derive(Clone, Debug)]
pub struct Edge {
    /// What becomes true.
    pub condition: ExprId,
    /// The discrete variable that stands for it.
    pub var: VarId,
    /// Where it is written.
    pub origin: Origin,
}

/// A clocked partition: period, delay and phase in s, of parameters alone.
#[derive(Clone, Debug)]
pub struct Clock {
    /// Full name.
    pub name: String,
    /// Time between ticks.
    pub period: ExprId,
    /// From a tick to the change of what it holds.
    pub delay: ExprId,
    /// Time of the first tick.
    pub phase: ExprId,
    /// Where it is written.
    pub origin: Origin,
}

/// An equation of a clocked partition.
#[derive(Clone, Debug)]
pub struct ClockedEquation {
    /// The partition.
    pub clock: ClockId,
    /// The equation.
    pub equation: Equation,
}

/// A component that something outside the equations computes, an FMU: stepped behind each tick of its clock. All its
/// variables are clocked; the equations keep its outputs as they are (`y = pre(y)`) until it is stepped.
#[derive(Clone, Debug)]
pub struct Foreign {
    /// Full name of the component.
    pub name: String,
    /// The file that it comes from, as the model names it.
    pub file: String,
    /// The source file that stands for it.
    pub source: FileId,
    /// Its clock.
    pub clock: ClockId,
    /// What it is given before its first step.
    pub parameters: Vec<VarId>,
    /// What it reads at a tick.
    pub inputs: Vec<VarId>,
    /// What it gives.
    pub outputs: Vec<VarId>,
    /// Where the component is declared.
    pub origin: Origin,
}

/// `delay(u, T)`. In a run the time is a number: the parameters it is made of are structural, for without a delay the
/// equations are others. In the observed form they are plain, and the time may be 0: what an observer delays is known.
#[derive(Clone, Debug)]
pub struct Delay {
    /// Values of the counter: one an element of an array.
    pub range: Range,
    /// What is delayed.
    pub value: ExprId,
    /// By how much: made of parameters.
    pub time: ExprId,
    /// Its value in s where parameters are as declared.
    pub time_s: f64,
    /// The variable that stands for the result.
    pub var: VarId,
    /// Where it is written.
    pub origin: Origin,
}

/// A condition that must hold during a run.
#[derive(Clone, Debug)]
pub struct Assert {
    /// True while all is well.
    pub condition: ExprId,
    /// Said when it fails.
    pub message: String,
    /// Where it is written.
    pub origin: Origin,
}

/// A step of preparing a measured column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preparation {
    /// `lowpass(x, f)`: Butterworth of order 4, forwards and backwards, corner in Hz.
    Lowpass(f64),
    /// `slope(x)`: central differences over time.
    Slope,
    /// Multiplied by a number in SI.
    Scale(f64),
}

/// `measured column = expression ~ noise`.
#[derive(Clone, Debug)]
pub struct Measured {
    /// As written left of the equals sign: the name of the channel.
    pub name: String,
    /// The record and its column.
    pub column: ColumnId,
    /// What is done to the column, in order.
    pub preparation: Vec<Preparation>,
    /// What the model has for it.
    pub value: ExprId,
    /// Compared after the tick (clocked) or before (continuous).
    pub clocked: bool,
    /// Standard deviation of white noise, SI, of parameters alone.
    pub noise: Option<ExprId>,
    /// Width of the uniform error of its quantiser, SI, of parameters alone; known in the observed form.
    pub rounding: Option<ExprId>,
    /// The period with which it begins again, as an angle after a turn, SI, of parameters alone: compared modulo that.
    pub period: Option<ExprId>,
    /// In the observed form, how much later than the value the column shows it, s, and the parameters that decide that.
    pub late: Option<(f64, Vec<String>)>,
    /// Dimension and printed unit.
    pub quantity: Quantity,
    /// Where it is written.
    pub origin: Origin,
}

/// `replay x = column` of a continuous variable, in the observed form: what the model itself has for it, and what takes its
/// place.
#[derive(Clone, Debug)]
pub struct Replayed {
    /// The variable.
    pub name: String,
    /// What takes its place: an expression of columns.
    pub recorded: ExprId,
    /// The column that this reads, if it is one alone.
    pub column: Option<ColumnId>,
    /// What the model has for it.
    pub value: ExprId,
    /// Where it comes from the tick before: the equation `u = pre(w)` that alone decides it.
    pub register: Option<Origin>,
    /// Dimension and printed unit.
    pub quantity: Quantity,
    /// Where it is written.
    pub origin: Origin,
}

/// How a signal over time becomes one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReductionKind {
    /// Largest value.
    Max,
    /// Smallest value.
    Min,
    /// Root mean square over time.
    Rms,
    /// Mean over time.
    Mean,
    /// Integral over time.
    Integral,
    /// The first value, where there is a condition the one at the first instant at which it holds.
    First,
    /// The last value, where there is a condition the one at the last instant at which it holds.
    Last,
    /// The instant from which the signal stays at zero or below, in s; infinite if it never does.
    Settling,
    /// The frequency at which the spectrum is highest, in Hz.
    Resonance,
}

/// A reduction of a signal over the run.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// How.
    pub kind: ReductionKind,
    /// Of what.
    pub value: ExprId,
    /// When it counts, as 1 or 0; none where always.
    pub condition: Option<ExprId>,
    /// a - b of each comparison of `a` with `b` in both, once its outputs are reported.
    pub margins: Vec<ExprId>,
    /// The variable that stands for the result; its name is the reduction as written.
    pub var: VarId,
}

/// `expect condition` or `measure T name = value`, over reductions.
#[derive(Clone, Debug)]
pub struct Measure {
    /// The measure's name, or the condition as written.
    pub name: String,
    /// A number, or a truth for an expectation.
    pub value: ExprId,
    /// Whether it is an expectation.
    pub expectation: bool,
    /// Dimension and printed unit.
    pub quantity: Quantity,
    /// Where it is written.
    pub origin: Origin,
}

/// What an account says of its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccountKind {
    /// An energy that it has, in J.
    Stored,
    /// A power that it turns into heat, in W.
    Dissipated,
    /// A power that it has from outside the model, in W.
    Supplied,
}

/// `stored Energy kinetic = e`, or `dissipated` or `supplied Power p = e`: the sum of its pieces.
#[derive(Clone, Debug)]
pub struct Account {
    /// The instance.
    pub component: InstancePath,
    /// Its name there.
    pub name: String,
    /// What it says.
    pub kind: AccountKind,
    /// Each summed over its counter: a scalar, or a share a cell of a field.
    pub pieces: Vec<(Range, ExprId)>,
}

/// How the variables of a connector make the power that enters its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortKind {
    /// Flow times the derivative of the potential: force and position.
    Work,
    /// Flow times potential: current and voltage.
    Power,
    /// The flow itself: heat.
    Heat,
}

/// A pair of variables of a connector through which energy enters its component.
#[derive(Clone, Debug)]
pub struct Port {
    /// The component that has the connector.
    pub component: InstancePath,
    /// How they make a power.
    pub kind: PortKind,
    /// The flow into the component.
    pub flow: ExprId,
    /// The potential.
    pub potential: ExprId,
}

/// What the energy ledger adds up; empty unless it was asked for.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    /// What components say of themselves.
    pub accounts: Vec<Account>,
    /// Where energy goes from one component to another.
    pub ports: Vec<Port>,
}

/// What goes from one component to another where they are connected: a force, a torque, a current.
#[derive(Clone, Debug)]
pub struct Flow {
    /// `motor.shaft to belt.a`, or `into belt.a` where more than two connectors meet.
    pub name: String,
    /// What goes into the connector named last.
    pub var: VarId,
}

/// How the continuous equations are integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Backward differentiation of variable order, by IDA of SUNDIALS.
    Ida,
    /// An implicit Runge-Kutta method of order 5, which starts anew at an event at no cost.
    Esdirk,
    /// What suits the program.
    #[default]
    Auto,
}

/// What an experiment adds to its model beside equations.
#[derive(Clone, Debug, Default)]
pub struct Experiment {
    /// Its name; empty for a model run as it stands.
    pub name: String,
    /// The form that an observer runs: measured channels alone are reported.
    pub observed: bool,
    /// The records it names.
    pub records: Vec<String>,
    /// Measured channels.
    pub measured: Vec<Measured>,
    /// Variables that a record takes the place of.
    pub replayed: Vec<Replayed>,
    /// Reductions that measures and expectations use.
    pub reductions: Vec<Reduction>,
    /// Measures and expectations.
    pub measures: Vec<Measure>,
    /// Frequency responses asked for.
    pub bodes: Vec<Bode>,
    /// Where loops are cut for their margins.
    pub cuts: Vec<Cut>,
    /// Parameters by which something drives the model from outside: free inputs, test signals.
    pub free: Vec<ParamId>,
    /// Those of them whose derivative by the time the equations need, and take for zero.
    pub differentiated: Vec<ParamId>,
    /// Figures asked for.
    pub figures: Vec<Figure>,
    /// Measured frequency responses.
    pub measured_responses: Vec<MeasuredResponse>,
    /// The energy ledger.
    pub ledger: Ledger,
    /// The flows of the connections.
    pub flows: Vec<Flow>,
    /// When it begins in s, of parameters alone; else where its records begin.
    pub start: Option<ExprId>,
    /// When it ends in s, of parameters alone.
    pub stop: Option<ExprId>,
    /// Time between rows of the results in s, of parameters alone.
    pub every: Option<ExprId>,
    /// Time in s before which measured channels are not compared, of parameters alone.
    pub skip: Option<ExprId>,
    /// The method of the solver.
    pub method: Method,
    /// Whether the tolerance of a step falls over long smooth stretches.
    pub conserve: bool,
    /// Options of the solver by name (`rtol`), of parameters alone.
    pub solve: Vec<(String, ExprId)>,
}

impl Experiment {
    /// The conditions of the reductions that have one, in their order.
    pub fn conditions(&self) -> impl Iterator<Item = ExprId> {
        self.reductions
            .iter()
            .filter_map(|reduction| reduction.condition)
    }

    /// The margins of the reductions, in their order.
    pub fn margins(&self) -> impl Iterator<Item = ExprId> {
        let reductions = self.reductions.iter();
        reductions.flat_map(|reduction| reduction.margins.iter().copied())
    }
}

/// A model with an experiment, flat.
#[derive(Clone, Debug, Default)]
pub struct FlatModel {
    /// Name of the model.
    pub name: String,
    /// What flatten decided and a user may want to know.
    pub notes: Vec<String>,
    /// All expressions.
    pub exprs: ExprArena,
    /// All variables.
    pub variables: IdVec<VarId, Variable>,
    /// All parameters, as declared.
    pub parameters: IdVec<ParamId, Parameter>,
    /// All parameters, each after those its value uses.
    pub parameter_order: Vec<ParamId>,
    /// The record columns read.
    pub columns: IdVec<ColumnId, Column>,
    /// Continuous equations, those of modes apart.
    pub equations: Vec<Equation>,
    /// Equations that hold at the start.
    pub initial_equations: Vec<Equation>,
    /// The `modes` blocks.
    pub automata: IdVec<AutomatonId, Automaton>,
    /// The `when` clauses.
    pub whens: Vec<When>,
    /// The edges of conditions.
    pub edges: Vec<Edge>,
    /// The clocked partitions.
    pub clocks: IdVec<ClockId, Clock>,
    /// The equations of clocked partitions.
    pub clocked_equations: Vec<ClockedEquation>,
    /// What something outside the equations computes.
    pub foreign: Vec<Foreign>,
    /// The delayed quantities.
    pub delays: IdVec<DelayId, Delay>,
    /// Conditions that must hold.
    pub asserts: Vec<Assert>,
    /// What the experiment adds.
    pub experiment: Experiment,
    /// Where each instance is declared, for messages.
    pub declared: BTreeMap<InstancePath, Span>,
}
