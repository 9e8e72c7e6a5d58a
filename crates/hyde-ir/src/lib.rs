//! The intermediate representation, described as a language.
//!
//! # Expressions
//! An [`Expr`] is a node in an [`ExprArena`]; equal nodes are one node, so an expression is a directed acyclic graph
//! and common subexpressions are shared by construction. All values are `f64`; truth is 1.0 or 0.0. Inside everything
//! is SI.
//!
//! # Ranges
//! An equation holds for every value of its counter in a [`Range`]; a scalar equation has the range with one value.
//! A reference to a variable carries an affine [`Index`] in that counter. Arrays and discretised fields are therefore
//! one variable and a few equations, whatever their number of cells, from flatten to machine code.
//!
//! # Two stages
//! A [`FlatModel`] is what flatten leaves: every variable and equation of every instance, names gone, ids in their
//! place. A [`Dae`] is what can be solved: unknowns in the order of the solver's vector, one residual an unknown,
//! algebraic variables that have an explicit definition taken out, relations with their root functions, automata,
//! event updates, clocked partitions as ordered assignments, and the initial system.
//!
//! # Who reads what
//! The *solver's vector* `y` holds states and the algebraic variables that no explicit definition takes out; the
//! *memory* `z` everything that changes only at events: truths of relations, modes, discrete, clocked and held
//! variables; `u` the columns of records; `p` parameters and what is derived from them alone; *work* the explicit
//! variables that are arrays. [`Dae::place`] tells where a variable lives.
//!
//! # Laws from records
//! A [`LawShape`] is a function of the language as data: its expressions, and what a search for an unknown law needs to
//! know of its inputs. [`ExprArena::column`] evaluates an expression in every row of a record.
//!
//! This crate transforms nothing beyond what a constructor folds ([`ExprArena`]) and what the derivative of an
//! operation is ([`ExprArena::tangent`], [`ExprArena::gradient`]): IR can be built, differentiated, printed, validated,
//! and evaluated. The evaluator of single operations, [`UnaryOp::apply`] and [`BinaryOp::apply`], is the
//! meaning of the IR: interpreter and machine code agree with it to the last bit.

pub mod dae;
pub mod flat;
pub mod print;

mod below;
mod builtin;
mod columns;
mod counter;
mod differentiate;
mod evaluate;
mod expr;
mod id;
mod law;
mod validate;
mod variable;

pub use builtin::{BinaryOp, UnaryOp, sine_and_cosine};
pub use columns::Along;
pub use dae::Dae;
pub use expr::{Expr, ExprArena, Index, Memo, Number, Range};
pub use flat::FlatModel;
pub use id::{
    AutomatonId, ClockId, ColumnId, DefinitionId, DelayId, ExprId, Id, IdVec, ParamId, RelationId,
    UnknownId, VarId,
};
pub use law::{
    LawAxis, LawConstant, LawInput, LawPiece, LawRole, LawShape, LawState, LawStep, LawText,
    LawUnit,
};
pub use validate::{validate_dae, validate_flat};
pub use variable::{
    Column, Interpolation, Parameter, Prior, Quantity, Role, StateChoice, Variable, VariableKind,
};
