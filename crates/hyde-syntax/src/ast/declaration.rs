//! Declarations and modifications.

use super::{Argument, Expr, Name, Range, Reference, UnitText};
use hyde_diag::Span;

/// The words before a declaration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Prefix {
    /// `parameter`: keeps one value during a run.
    Parameter,
    /// `constant`: has one value for ever.
    Constant,
    /// `final`: may not be modified.
    Final,
    /// `flow`: the values of connected ones sum to zero.
    Flow,
    /// `input`: set from outside.
    Input,
    /// `output`: read from outside.
    Output,
    /// `replaceable`: its model may be redeclared.
    Replaceable,
    /// `site`: effects may change it.
    Site,
    /// `field`: has a value at every point of a domain.
    Field,
    /// `size`: a parameter at whose neutral value an effect vanishes.
    Size,
    /// `shape`: a parameter that means nothing where the effect has vanished.
    Shape,
}

impl Prefix {
    /// The word as written.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Parameter => "parameter",
            Self::Constant => "constant",
            Self::Final => "final",
            Self::Flow => "flow",
            Self::Input => "input",
            Self::Output => "output",
            Self::Replaceable => "replaceable",
            Self::Site => "site",
            Self::Field => "field",
            Self::Size => "size",
            Self::Shape => "shape",
        }
    }
}

/// `prefixes Type[dims] a, b;`
#[derive(Clone, Debug, PartialEq)]
pub struct Declaration {
    /// The words before the type.
    pub prefixes: Vec<Prefix>,
    /// The type.
    pub type_name: Reference,
    /// Dimensions after the type.
    pub dims: Vec<Expr>,
    /// What is declared.
    pub declarators: Vec<Declarator>,
    /// Its place.
    pub span: Span,
}

/// One declared name.
#[derive(Clone, Debug, PartialEq)]
pub struct Declarator {
    /// The name.
    pub name: Name,
    /// Dimensions after the name.
    pub dims: Vec<Expr>,
    /// Changes to the component, or `start` and `fixed` of a variable.
    pub changes: Vec<Change>,
    /// `on bar`, of a field.
    pub domain: Option<Name>,
    /// `= e`
    pub binding: Option<Expr>,
    /// `~ ±8%`
    pub prior: Option<Prior>,
    /// `from "datasheet"`
    pub source: Option<String>,
    /// `in 0 .. 1 [kN]`
    pub within: Option<Range>,
    /// `over (place = a.s, speed = v)`: the variables that a law of a site is a function of.
    pub over: Vec<Argument>,
    /// Its documentation.
    pub doc: Option<String>,
}

impl Declarator {
    /// Whether something other than the attributes of a variable is modified: then it is a component.
    #[must_use]
    pub fn is_modified(&self) -> bool {
        self.changes
            .iter()
            .any(|change| !matches!(change.target.as_word(), Some("start" | "fixed" | "state")))
    }
}

/// `~ ±8%`, `~ ±0.1 [mm]`
#[derive(Clone, Debug, PartialEq)]
pub struct Prior {
    /// The number.
    pub value: f64,
    /// Whether it is in percent of the value.
    pub percent: bool,
    /// Its unit, if not.
    pub unit: Option<UnitText>,
    /// Its place.
    pub span: Span,
}

/// A modification: `R = 2`, `contact.k = 1e8`, `redeclare Contact contact(…)`.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// What is changed.
    pub target: Reference,
    /// The new model of a replaceable component.
    pub redeclare: Option<Reference>,
    /// Applies to each element of an array.
    pub each: bool,
    /// May not be changed further.
    pub is_final: bool,
    /// Nested changes.
    pub changes: Vec<Change>,
    /// The new value.
    pub value: Option<Expr>,
    /// Its prior.
    pub prior: Option<Prior>,
    /// Its source.
    pub source: Option<String>,
}
