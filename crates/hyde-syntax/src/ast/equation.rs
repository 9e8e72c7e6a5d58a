//! Equations, and what may stand among them.

use super::{Expr, Name, Reference};
use hyde_diag::Span;

/// An equation or what stands among equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// What it is.
    pub kind: EquationKind,
    /// Its place.
    pub span: Span,
}

/// The kinds of equations.
#[derive(Clone, Debug, PartialEq)]
pub enum EquationKind {
    /// `a = b indomain bar load(x, F);`
    Equality {
        /// Left side.
        lhs: Expr,
        /// Right side.
        rhs: Expr,
        /// Where it holds, for equations of fields.
        place: Option<Place>,
    },
    /// `connect(a, b, c);`
    Connect(Vec<Reference>),
    /// `for i in 1:n loop … end for;`
    For {
        /// The counter.
        counter: Name,
        /// First value.
        first: Expr,
        /// Last value.
        last: Expr,
        /// What holds for each.
        equations: Vec<Equation>,
    },
    /// `if a then … else … end if;`
    If {
        /// Conditions with their equations.
        branches: Vec<(Expr, Vec<Equation>)>,
        /// The equations where no condition holds.
        otherwise: Vec<Equation>,
    },
    /// `when a then … elsewhen b then … end when;`
    When(Vec<(Expr, Vec<Equation>)>),
    /// `assert(a, "message");`
    Assert(Expr, String),
    /// `reinit(x, e);`
    Reinit(Reference, Expr),
}

/// `indomain bar`, `indomain bar.left`, with loads.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// The domain.
    pub domain: Name,
    /// `left` or `right`.
    pub end: Option<Name>,
    /// Position and force of each point load.
    pub loads: Vec<(Expr, Expr)>,
}
