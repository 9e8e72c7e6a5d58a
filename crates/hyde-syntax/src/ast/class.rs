//! Models, connectors, effects and functions, and what may stand in them.

use super::{
    Argument, Change, Declaration, Equation, Expr, Modes, Name, Range, Reference, UnitText,
};
use hyde_diag::Span;

/// What kind of class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClassKind {
    /// `model`
    Model,
    /// `connector`
    Connector,
    /// `effect`
    Effect,
    /// `function`
    Function,
}

impl ClassKind {
    /// The word as written.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Model => "model",
            Self::Connector => "connector",
            Self::Effect => "effect",
            Self::Function => "function",
        }
    }
}

/// A model, connector or effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Class {
    /// Which.
    pub kind: ClassKind,
    /// Its name.
    pub name: Name,
    /// Its documentation.
    pub doc: Option<String>,
    /// What is in it.
    pub body: ClassBody,
    /// From the keyword to the end.
    pub span: Span,
}

/// The two forms of a class.
#[derive(Clone, Debug, PartialEq)]
pub enum ClassBody {
    /// Written out.
    Long {
        /// `on Guide`: the type an effect is for.
        host: Option<Reference>,
        /// Its elements.
        elements: Vec<Element>,
    },
    /// `model A = B(R = 2) with E(dF = 1) on guide;`, `model C = fmu("controller.fmu", Kp = 2);`
    Short {
        /// The model it is; of an FMU `fmu`, until who reads files has put in the model of its interface.
        base: Reference,
        /// The file of an FMU as written, and where.
        fmu: Option<(String, Span)>,
        /// With these changes.
        changes: Vec<Change>,
        /// And these effects.
        effects: Vec<EffectUse>,
    },
}

/// `Stribeck(dF = 150 [N]) on guide`
#[derive(Clone, Debug, PartialEq)]
pub struct EffectUse {
    /// The effect.
    pub effect: Reference,
    /// With these changes.
    pub changes: Vec<Change>,
    /// Where.
    pub sites: Vec<Reference>,
}

/// An element of a class.
#[derive(Clone, Debug, PartialEq)]
pub enum Element {
    /// `extends Base(R = 2);`
    Extends(Reference, Vec<Change>),
    /// `parameter Resistance R = 0.35 [ohm];`
    Declaration(Declaration),
    /// `domain bar(x in 0 .. len);`
    Domain(Domain),
    /// `discretize bar by fem(n = 24);`
    Discretize(Discretize),
    /// `modes initial stuck { … }`
    Modes(Modes),
    /// `clocked cnc(1 [ms]) … end cnc;`
    Clocked(Clocked),
    /// An equation.
    Equation(Equation),
    /// An equation of an `initial equation` section.
    InitialEquation(Equation),
    /// `wrap grip by grip + dF;`
    Wrap(Reference, Expr),
    /// `add a.tau = …;`
    Add(Equation),
    /// `replace contact by GapContact(gap = gap);`
    Replace(Reference, Reference, Vec<Change>),
    /// `signature velocity, angle(N);`
    Signature(Vec<(Name, Vec<Argument>)>),
    /// `confounds LuGre;`
    Confounds(Vec<Reference>),
    /// `measure Length peak = max(abs(e));`
    Measure(Measure),
    /// `stored Energy kinetic = M*v^2/2;`
    Account(AccountKind, Measure),
}

/// What an entry of the energy ledger says of its component.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AccountKind {
    /// `stored`: an energy that it has.
    Stored,
    /// `dissipated`: a power that it turns into heat.
    Dissipated,
    /// `supplied`: a power that it has from outside the model.
    Supplied,
}

impl AccountKind {
    /// The word as written.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Stored => "stored",
            Self::Dissipated => "dissipated",
            Self::Supplied => "supplied",
        }
    }
}

/// `domain bar(x in 0 .. len);`
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    /// Its name.
    pub name: Name,
    /// The coordinate.
    pub coordinate: Name,
    /// Its bounds.
    pub range: Range,
}

/// `discretize bar by fem(n = 24);`
#[derive(Clone, Debug, PartialEq)]
pub struct Discretize {
    /// The domain.
    pub domain: Name,
    /// The method.
    pub method: Name,
    /// Its arguments.
    pub arguments: Vec<Argument>,
}

/// `clocked cnc(1 [ms], delay = 2 [ms]) … end cnc;`
#[derive(Clone, Debug, PartialEq)]
pub struct Clocked {
    /// Its name.
    pub name: Name,
    /// Period, delay, phase.
    pub arguments: Vec<Argument>,
    /// What is in it.
    pub elements: Vec<Element>,
    /// Its place.
    pub span: Span,
}

/// `measure Length peak = max(abs(e)) in [um] "doc";`
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Its type.
    pub type_name: Reference,
    /// Its name.
    pub name: Name,
    /// Its value.
    pub value: Expr,
    /// The unit it is shown in, where that is said.
    pub unit: Option<UnitText>,
    /// Its documentation.
    pub doc: Option<String>,
}
