//! The names that an element of a class declares.

use super::{AccountKind, Clocked, Declaration, Declarator, Domain, Element, Measure, Modes, Name};

/// What a name of an element is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Declared<'a> {
    /// A variable, a parameter, a connector or a part.
    Variable(&'a Declaration, &'a Declarator),
    /// A domain.
    Domain(&'a Domain),
    /// The coordinate of a domain.
    Coordinate(&'a Domain),
    /// A named block of modes.
    Modes(&'a Modes),
    /// A clocked part.
    Clocked(&'a Clocked),
    /// A measure, or an entry of the energy ledger.
    Measure(&'a Measure, Option<AccountKind>),
}

impl Element {
    /// The names that the element declares in its class, in the order written; those inside clocked parts and modes are not
    /// names of the class.
    #[must_use]
    pub fn declared(&self) -> Vec<(&Name, Declared<'_>)> {
        match self {
            Self::Declaration(own) => {
                let names = own.declarators.iter();
                names
                    .map(|name| (&name.name, Declared::Variable(own, name)))
                    .collect()
            }
            Self::Domain(own) => vec![
                (&own.name, Declared::Domain(own)),
                (&own.coordinate, Declared::Coordinate(own)),
            ],
            Self::Modes(own) => {
                let name = own.name.iter();
                name.map(|name| (name, Declared::Modes(own))).collect()
            }
            Self::Clocked(own) => vec![(&own.name, Declared::Clocked(own))],
            Self::Measure(own) => vec![(&own.name, Declared::Measure(own, None))],
            Self::Account(kind, own) => vec![(&own.name, Declared::Measure(own, Some(*kind)))],
            Self::Extends(..)
            | Self::Discretize(_)
            | Self::Equation(_)
            | Self::InitialEquation(_)
            | Self::Wrap(..)
            | Self::Add(_)
            | Self::Replace(..)
            | Self::Signature(_)
            | Self::Confounds(_) => Vec::new(),
        }
    }
}
