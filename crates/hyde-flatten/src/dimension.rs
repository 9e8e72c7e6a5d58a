//! Dimensions of expressions, known and still unknown, and the constraints between them.
//!
//! A dimension is a known part times powers of unknown ones ([`Dim::Of`]): a `Real` without a unit, a record's column
//! without one. Every `+`, `=`, comparison, binding and connection demands that two of them agree. What can be decided
//! is decided at once; the rest waits until the end of flatten, where a constraint with one unknown left determines it.
//! What nothing determines is a pure number (U2).

pub(crate) mod constraints;

use hyde_units::{Dimension, Exponent};

/// An unknown dimension.
pub(crate) type Unknown = usize;

/// The dimension of an expression.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Dim {
    /// A literal 0: fits any (U2).
    Any,
    /// Known part and powers of unknowns.
    Of(Dimension, Vec<(Unknown, Exponent)>),
}

impl Dim {
    pub(crate) const NUMBER: Self = Self::Of(Dimension::DIMENSIONLESS, Vec::new());

    /// A pure number of which it is not known whether it counts angles: `pi`.
    pub(crate) fn neutral_number() -> Self {
        let torque = Dimension::si([1, 2, -2, 0, 0, 0, 0], 0);
        let neutral = hyde_units::parse_unit("N.m").map_or(torque, |unit| unit.dimension);
        Self::known(neutral.divide(neutral))
    }

    pub(crate) fn known(dimension: Dimension) -> Self {
        Self::Of(dimension, Vec::new())
    }

    pub(crate) fn unknown(unknown: Unknown) -> Self {
        Self::Of(Dimension::DIMENSIONLESS, vec![(unknown, Exponent::ONE)])
    }

    pub(crate) fn as_known(&self) -> Option<Dimension> {
        match self {
            Self::Of(dimension, unknowns) if unknowns.is_empty() => Some(*dimension),
            Self::Of(..) | Self::Any => None,
        }
    }

    pub(crate) fn multiply(&self, other: &Self) -> Self {
        self.combine(other, false)
    }

    pub(crate) fn divide(&self, other: &Self) -> Self {
        self.combine(other, true)
    }

    /// `None` where an exponent cannot be kept exactly.
    pub(crate) fn power(&self, exponent: Exponent) -> Option<Self> {
        match self {
            Self::Any => Some(Self::Any),
            Self::Of(dimension, unknowns) => {
                let powers = unknowns.iter().map(|&(u, e)| Some((u, e.times(exponent)?)));
                Some(Self::Of(
                    dimension.power(exponent)?,
                    powers.collect::<Option<Vec<_>>>()?,
                ))
            }
        }
    }

    /// As the dimension of a product or a power: its angle matches any.
    pub(crate) fn composed(&self) -> Self {
        match self {
            Self::Any => Self::Any,
            Self::Of(dimension, unknowns) => Self::Of(dimension.composed(), unknowns.clone()),
        }
    }

    fn combine(&self, other: &Self, inverse: bool) -> Self {
        let (Self::Of(a, left), Self::Of(b, right)) = (self, other) else {
            return Self::Any;
        };
        let known = if inverse {
            a.divide(*b)
        } else {
            a.multiply(*b)
        };
        let mut unknowns = left.clone();
        for &(unknown, exponent) in right {
            let exponent = if inverse { -exponent } else { exponent };
            match unknowns.iter_mut().find(|(u, _)| *u == unknown) {
                Some((_, e)) => *e = *e + exponent,
                None => unknowns.push((unknown, exponent)),
            }
        }
        unknowns.retain(|(_, e)| !e.is_zero());
        Self::Of(known, unknowns)
    }
}
