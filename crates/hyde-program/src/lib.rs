//! The contract between the compiler and the runtime: a [`Program`] is a hybrid DAE that can be run.
//!
//! ```text
//! 0 = F(t, y, y', z, u, p)      one residual an unknown; y' of states only
//! g(t, y, y', z, u, p)          root functions of the relations
//! ```
//! The solver's vector `y` holds states and implicit algebraic variables. The memory `z` holds what changes at events
//! only: truths of relations (1 or 0, first, in their order), modes of automata (a number each), discrete, clocked and
//! held variables. `u` holds two values a record column at the current time: read linearly, and held. `p` holds the
//! parameters, then what is derived from them alone.
//!
//! What events do to memory and states is the same for all who run a program: [`Program::firing`] and its neighbours.
//!
//! What a program takes over as it is in the IR, a [`Method`] or the [`Firmness`] of a start, is the type of the IR.
//!
//! Numbers come from [`Kernels`], everything about them from the tables of the [`Program`]. There are three implementers
//! of the trait: machine code, the interpreter of the IR, and problems written by hand for tests. A kernel has no state:
//! equal arguments give equal results, from any thread.
//!
//! One layout and one sparsity serve all modes. Every unknown, relation and reaction has the [`hyde_diag::Origin`]s it
//! comes from, so that whatever fails at run time can be named in the words of the model.

mod event;
mod experiment;
mod foreign;
mod given;
mod jacobian;
mod kernels;
mod ledger;
mod program;
mod reacting;

pub use event::{Assignment, Clock, Delay, InitialCondition, Pin, Reaction, Relation};
pub use experiment::{
    Bode, Curve, Cut, Experiment, Figure, FigureKind, Flow, Measure, Measured, MeasuredResponse,
    Moment, RecordedResponse, Reduction, Replayed, ScaledColumn, Stepped,
};
pub use foreign::{Foreign, ForeignInstance, ForeignPart, ForeignTick, Stopped};
pub use given::{Given, Misfit};
pub use hyde_ir::Prior;
pub use hyde_ir::dae::{
    Automaton, Firmness, Function, Hold, ReactionKind, RelationUse, Selection, Target,
};
pub use hyde_ir::flat::{AccountKind, Method, PortKind, Preparation, ReductionKind};
pub use jacobian::{Jacobian, JacobianEntry};
pub use kernels::{Coefficients, Constant, Kernels, Point, SomeRows, TickWrt, Workspace};
pub use ledger::{Account, Ledger, Port};
pub use program::{
    Column, Derivatives, Output, Parameter, PartialEntry, Program, RecordValue, RecordValueKind,
    UnknownBlock, Wrt,
};
