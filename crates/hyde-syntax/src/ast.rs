//! The tree of a source file: what was written. Names are text, units are text, nothing is checked but the syntax.
//!
//! A [`File`] has items; a [`Class`] has [`Element`]s; an [`Equation`] has [`Expr`]essions. Whatever a message may point
//! at carries its [`hyde_diag::Span`].

mod class;
mod declaration;
mod declared;
mod equation;
mod experiment;
mod expression;
mod file;
mod modes;
mod name;
mod study;
mod walk;

pub use class::{
    AccountKind, Class, ClassBody, ClassKind, Clocked, Discretize, Domain, EffectUse, Element,
    Measure,
};
pub use declaration::{Change, Declaration, Declarator, Prefix, Prior};
pub use declared::Declared;
pub use equation::{Equation, EquationKind, Place};
pub use experiment::{
    Bode, Channel, Drive, Experiment, ExperimentItem, Figure, Ideal, LayoutSetting, Margins,
    RecordItem,
};
pub use expression::{Argument, Binary, Comprehension, Expr, ExprKind, Range, Unary};
pub use file::{File, Import, Item, TypeItem};
pub use modes::{Exit, Mode, Modes};
pub use name::{Name, Part, Reference, UnitText};
pub use study::{Label, SettingValue, Study, StudyItem, StudyKind, Variation, Varied};
