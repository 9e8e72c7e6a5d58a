//! The tree of instances, and what flatten knows of variables and parameters until they are lowered.

use crate::dimension::Dim;
use crate::names::FileIndex;
use crate::turns::Turns;
use crate::zero::Zero;
use hyde_diag::{InstancePath, Span};
use hyde_ir::{ClockId, ExprId, Index, ParamId, VarId};
use hyde_syntax::ast::{Class, Element, Expr};
use std::collections::BTreeMap;

/// An instance by its number.
pub(crate) type InstanceId = usize;
/// A discretised domain by its number.
pub(crate) type DomainId = usize;

/// A component, connector or clocked part of the model.
pub(crate) struct Instance<'a> {
    pub(crate) path: InstancePath,
    pub(crate) file: FileIndex,
    pub(crate) class: &'a Class,
    pub(crate) parent: Option<InstanceId>,
    /// Of a clocked part: the model around it, where names are looked up that are not its own.
    pub(crate) outer: Option<InstanceId>,
    /// The partition its variables belong to.
    pub(crate) clock: Option<ClockId>,
    pub(crate) members: BTreeMap<&'a str, Member>,
    /// Its elements, those of its bases first, each with the file it is written in.
    pub(crate) elements: Vec<(FileIndex, &'a Element)>,
    pub(crate) span: Span,
}

/// What a name within an instance stands for.
#[derive(Clone)]
pub(crate) enum Member {
    Variable(VarId),
    Parameter(ParamId),
    Instance(InstanceId),
    Instances(std::rc::Rc<[InstanceId]>),
    Domain(DomainId),
}

/// An expression with the instance in whose scope it stands.
#[derive(Clone)]
pub(crate) struct Binding<'a> {
    pub(crate) expr: &'a Expr,
    pub(crate) scope: InstanceId,
    /// It stands in the experiment, so that the records' columns can be read.
    pub(crate) records: bool,
    /// The elements of arrays of components that it is for, the outermost first.
    pub(crate) elements: Vec<Position>,
    pub(crate) span: Span,
}

impl<'a> Binding<'a> {
    /// The scope in which the expression is read.
    pub(crate) fn scope_for(&self, setting: Setting) -> Scope<'a> {
        Scope {
            records: self.records,
            ..Scope::new(self.scope, setting)
        }
    }
}

/// An element of an array of components.
#[derive(Clone, Copy)]
pub(crate) struct Position {
    /// From 0.
    pub(crate) at: usize,
    /// How many there are.
    pub(crate) of: usize,
}

/// For what whole arrays in an expression stand.
#[derive(Clone, Copy)]
pub(crate) enum Elementwise {
    /// For all elements: that of the counter of a range equation, from 0; how many there are.
    Range(usize),
    /// For one of them.
    One(Position),
}

impl Elementwise {
    /// How many elements there are.
    pub(crate) fn len(self) -> usize {
        match self {
            Self::Range(len) => len,
            Self::One(position) => position.of,
        }
    }
}

/// What flatten knows of a variable beside what the flat model holds.
pub(crate) struct VariableNotes<'a> {
    pub(crate) instance: InstanceId,
    pub(crate) dim: Dim,
    pub(crate) binding: Option<Binding<'a>>,
    pub(crate) start: Option<Binding<'a>>,
    /// `min` and `max`.
    pub(crate) bounds: [Option<Binding<'a>>; 2],
    /// Of whole numbers.
    pub(crate) integer: bool,
    /// It is the difference of two temperatures.
    pub(crate) difference: bool,
    /// Which elements are fixed, where some are and some are not.
    pub(crate) fixed_elements: Vec<bool>,
    pub(crate) field: Option<Field>,
}

/// What flatten knows of a parameter beside what the flat model holds.
pub(crate) struct ParameterNotes<'a> {
    /// The instance that declares it.
    pub(crate) of: InstanceId,
    pub(crate) dim: Dim,
    pub(crate) binding: Option<Binding<'a>>,
    pub(crate) state: Lowering,
    pub(crate) boolean: bool,
    /// `min` and `max`.
    pub(crate) bounds: [Option<Binding<'a>>; 2],
    /// `in a .. b`, in names of this instance.
    pub(crate) within: Option<&'a hyde_syntax::ast::Range>,
    /// `~ ±0.1 [mm]`.
    pub(crate) prior: Option<&'a hyde_syntax::ast::Prior>,
}

impl ParameterNotes<'_> {
    /// Those of a parameter that the experiment has and that gets its value as it is made.
    pub(crate) fn made(dim: Dim) -> Self {
        Self {
            of: 0,
            dim,
            binding: None,
            state: Lowering::Done,
            boolean: false,
            bounds: [None, None],
            within: None,
            prior: None,
        }
    }
}

/// How far a parameter's binding is lowered.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Lowering {
    Waiting,
    InProgress,
    Done,
}

/// A field: its domain, and where its values lie.
#[derive(Clone, Copy)]
pub(crate) struct Field {
    pub(crate) domain: DomainId,
    /// Values between the nodes (a flux) rather than at them.
    pub(crate) flux: bool,
    /// The fluxes through the left and the right end, once a field equation has asked for them.
    pub(crate) traces: Option<(VarId, VarId)>,
}

/// A domain with its mesh: `cells` equal cells between `from` and `to`.
pub(crate) struct Domain<'a> {
    pub(crate) instance: InstanceId,
    pub(crate) name: &'a str,
    pub(crate) coordinate: &'a str,
    pub(crate) from: &'a Expr,
    pub(crate) to: &'a Expr,
    pub(crate) cells: usize,
    pub(crate) averaged: bool,
    pub(crate) span: Span,
    /// Lower end and cell length once lowered, with their dimension.
    pub(crate) mesh: Option<(ExprId, ExprId, Dim)>,
    /// The weights of its nodes at each place that moves.
    pub(crate) weights: Vec<WeightArray>,
}

/// The weights of the nodes of a domain at a place that moves, from the node before the first to the one behind the last.
#[derive(Clone, Copy)]
pub(crate) struct WeightArray {
    /// The place's distance from the first node in cells.
    pub(crate) place: ExprId,
    pub(crate) array: VarId,
    /// Their derivatives by the place, if they are asked for.
    pub(crate) slopes: Option<VarId>,
    pub(crate) span: Span,
}

/// What a counter of a `for` equation stands for while its body is lowered.
#[derive(Clone, Copy)]
pub(crate) enum Counter {
    /// The counter of the range equation.
    Symbolic,
    /// A number: the loop is unrolled.
    Fixed(i32),
}

/// Where a field expression is evaluated.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum FieldPlace {
    /// Nowhere: a field has no single value.
    Nowhere,
    /// At nodes.
    Node(DomainId, Index),
    /// In the middle of cells: cell j lies between nodes j-1 and j.
    Cell(DomainId, Index),
}

/// What the expression is for: it decides what may stand in it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Setting {
    /// A continuous equation: relations are events.
    Equation,
    /// A guard or condition: relations are root functions of it.
    Condition,
    /// What an event sets: `pre` is the value before it.
    Action,
    /// A clocked equation.
    Clocked,
    /// A parameter's value or a start value: parameters alone.
    Parameter,
    /// A measured or reported quantity, or what a clocked part samples: read only.
    Report,
    /// A measure or expectation: numbers over reductions of a whole run.
    Measure,
}

/// Where an expression stands.
#[derive(Clone)]
pub(crate) struct Scope<'a> {
    pub(crate) instance: InstanceId,
    pub(crate) setting: Setting,
    pub(crate) counters: Vec<(&'a str, Counter)>,
    /// Mode parameters in scope.
    pub(crate) locals: Vec<(&'a str, VarId)>,
    /// In a function: its inputs and variables, and nothing else.
    pub(crate) values: Option<Vec<(&'a str, Typed)>>,
    pub(crate) place: FieldPlace,
    /// Whole arrays are read element by element.
    pub(crate) elementwise: Option<Elementwise>,
    /// The records of the experiment can be read.
    pub(crate) records: bool,
    /// Whether it is the recorded side of a measured channel: readings may be missing there.
    pub(crate) measured: bool,
}

impl Scope<'_> {
    pub(crate) fn new(instance: InstanceId, setting: Setting) -> Self {
        Self {
            instance,
            setting,
            counters: Vec::new(),
            locals: Vec::new(),
            values: None,
            place: FieldPlace::Nowhere,
            elementwise: None,
            records: false,
            measured: false,
        }
    }

    pub(crate) fn at(&self, place: FieldPlace) -> Self {
        Self {
            place,
            ..self.clone()
        }
    }

    pub(crate) fn elements(&self, elementwise: Elementwise) -> Self {
        Self {
            elementwise: Some(elementwise),
            ..self.clone()
        }
    }

    pub(crate) fn with(&self, setting: Setting) -> Self {
        Self {
            setting,
            ..self.clone()
        }
    }
}

/// A lowered expression.
#[derive(Clone, Debug)]
pub(crate) struct Typed {
    pub(crate) id: ExprId,
    pub(crate) dim: Dim,
    /// A truth rather than a number.
    pub(crate) truth: bool,
    /// A bare number without a unit.
    pub(crate) bare: bool,
    /// What is known of turns in it.
    pub(crate) turns: Turns,
    /// What is known of its zero point.
    pub(crate) zero: Zero,
    /// Of a literal that counts from a zero point: what it is as a difference, SI. 5 of `5 [degC]`.
    pub(crate) difference: Option<f64>,
    pub(crate) span: Span,
}
