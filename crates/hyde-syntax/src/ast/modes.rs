//! Modes and their exits.

use super::{Argument, Equation, Expr, Name, Reference};
use hyde_diag::Span;

/// `modes initial stuck { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Its name, if it has one.
    pub name: Option<Name>,
    /// The first mode.
    pub initial: Name,
    /// Values of the first mode's parameters.
    pub arguments: Vec<Argument>,
    /// The modes.
    pub modes: Vec<Mode>,
    /// Its place.
    pub span: Span,
}

/// `mode slip(Real s) { … }`
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Its name.
    pub name: Name,
    /// Its parameters: type and name.
    pub parameters: Vec<(Reference, Name)>,
    /// Its equations.
    pub equations: Vec<Equation>,
    /// `enter { … }`: what every exit into it sets.
    pub enter: Vec<Equation>,
    /// `leave { … }`: what every exit from it sets.
    pub leave: Vec<Equation>,
    /// Its exits.
    pub exits: Vec<Exit>,
}

/// `exit s*w < 0 -> stuck;`
#[derive(Clone, Debug, PartialEq)]
pub struct Exit {
    /// The guard.
    pub guard: Expr,
    /// The mode entered.
    pub target: Name,
    /// Values of its parameters.
    pub arguments: Vec<Argument>,
    /// `impact`
    pub impact: bool,
    /// `{ reinit(v, 0); }`
    pub actions: Vec<Equation>,
    /// Its place.
    pub span: Span,
}
