//! The dimension of a quantity: exponents of the base units, and of the radian beside them.

use crate::Exponent;

/// The SI base units, in the order of the exponents of a [`Dimension`] and of its printed text.
pub(crate) const BASE_UNITS: [&str; 7] = ["kg", "m", "A", "s", "K", "mol", "cd"];

/// The exponent of the angle (rad), which SI does not count: it decides warnings, never errors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum AngleExponent {
    /// The angle enters with this exponent: 1 for rad/s, 0 for Hz, -1 for mm/rev.
    Known(Exponent),
    /// The exponent that the factors of a product add up to; it matches any. The speed of a point is `w*r` and its
    /// acceleration `w^2*r`: the radian is 1 there, and only the physics says so.
    Composed(Exponent),
    /// Unknown and matches any: torque, inertia and their like, and every product that has one in it.
    Neutral,
}

/// How two dimensions compare where they should be the same: in `+ - =`, `connect`, arguments of functions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Agreement {
    /// They agree.
    Same,
    /// They agree but for two known, different angle exponents: Hz with rad/s. Worth a warning.
    AngleDiffers,
    /// They do not agree: an error.
    Different,
}

/// Exponents of kg, m, A, s, K, mol and cd, and of the angle.
///
/// Two dimensions are `==` if they are identical, a neutral angle being unlike a known one; use
/// [`agreement`](Self::agreement) to ask whether two quantities may be added.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Dimension {
    pub(crate) base: [Exponent; 7],
    pub(crate) angle: AngleExponent,
}

impl Dimension {
    /// A bare number.
    pub const DIMENSIONLESS: Self = Self::si([0, 0, 0, 0, 0, 0, 0], 0);
    /// An angle, in rad.
    pub const ANGLE: Self = Self::si([0, 0, 0, 0, 0, 0, 0], 1);
    /// A time, in s.
    pub const TIME: Self = Self::si([0, 0, 0, 1, 0, 0, 0], 0);
    /// Turns per second, s-1.
    pub const FREQUENCY: Self = Self::si([0, 0, 0, -1, 0, 0, 0], 0);
    /// A length, in m.
    pub const LENGTH: Self = Self::si([0, 1, 0, 0, 0, 0, 0], 0);
    /// An energy, in J. Its angle is open: torque times angle is one, and so is force times length.
    pub const ENERGY: Self = Self::neutral([1, 2, 0, -2, 0, 0, 0]);
    /// A power, in W; its angle is open.
    pub const POWER: Self = Self::neutral([1, 2, 0, -3, 0, 0, 0]);

    const fn neutral(base: [i16; 7]) -> Self {
        Self {
            angle: AngleExponent::Neutral,
            ..Self::si(base, 0)
        }
    }

    /// The dimension with whole exponents of kg, m, A, s, K, mol, cd, and of rad.
    #[must_use]
    pub const fn si(base: [i16; 7], angle: i16) -> Self {
        let mut exponents = [Exponent::ZERO; 7];
        let mut i = 0;
        while i < base.len() {
            exponents[i] = Exponent::integer(base[i]);
            i += 1;
        }
        Self {
            base: exponents,
            angle: AngleExponent::Known(Exponent::integer(angle)),
        }
    }

    /// The exponent of the angle.
    #[must_use]
    pub const fn angle(self) -> AngleExponent {
        self.angle
    }

    /// Whether it is a bare number or an angle to whatever power.
    #[must_use]
    pub fn is_dimensionless(self) -> bool {
        self.base.iter().all(|exponent| exponent.is_zero())
    }

    /// The exponents of kg, m, s, A, K, mol, cd and rad, if all are whole. An angle that is open has none.
    #[must_use]
    pub fn si_exponents(self) -> Option<[i32; 8]> {
        let [kg, m, a, s, k, mol, cd] = self.base;
        let rad = match self.angle {
            AngleExponent::Known(exponent) => exponent,
            AngleExponent::Composed(_) | AngleExponent::Neutral => Exponent::ZERO,
        };
        let mut found = [0; 8];
        for (place, exponent) in found.iter_mut().zip([kg, m, s, a, k, mol, cd, rad]) {
            *place = exponent.as_integer()?;
        }
        Some(found)
    }

    /// The dimension of a product.
    #[must_use]
    pub fn multiply(self, other: Self) -> Self {
        self.combine(other, |a, b| a + b)
    }

    /// The dimension of a quotient.
    #[must_use]
    pub fn divide(self, other: Self) -> Self {
        self.combine(other, |a, b| a - b)
    }

    /// The dimension of a power; none if an exponent would not be exact. The power 0 is a bare number.
    #[must_use]
    pub fn power(self, exponent: Exponent) -> Option<Self> {
        if exponent.is_zero() {
            return Some(Self::DIMENSIONLESS);
        }
        self.scaled(|known| known.times(exponent))
    }

    /// The dimension that has this one as its power; none if an exponent would not be exact.
    #[must_use]
    pub fn root(self, exponent: Exponent) -> Option<Self> {
        self.scaled(|known| known.over(exponent))
    }

    /// As the dimension of a product or a power: its angle matches any.
    #[must_use]
    pub fn composed(self) -> Self {
        match self.angle {
            AngleExponent::Known(exponent) => Self {
                angle: AngleExponent::Composed(exponent),
                ..self
            },
            AngleExponent::Composed(_) | AngleExponent::Neutral => self,
        }
    }

    fn scaled(self, change: impl Fn(Exponent) -> Option<Exponent>) -> Option<Self> {
        let mut result = self;
        for base in &mut result.base {
            *base = change(*base)?;
        }
        result.angle = match self.angle {
            AngleExponent::Known(angle) => AngleExponent::Known(change(angle)?),
            AngleExponent::Composed(angle) => AngleExponent::Composed(change(angle)?),
            AngleExponent::Neutral => AngleExponent::Neutral,
        };
        Some(result)
    }

    /// The dimension of a square root; none if an exponent would not be exact.
    #[must_use]
    pub fn sqrt(self) -> Option<Self> {
        self.power(Exponent::HALF)
    }

    /// Whether two sides that should be the same are.
    #[must_use]
    pub fn agreement(self, other: Self) -> Agreement {
        if self.base != other.base {
            return Agreement::Different;
        }
        match (self.angle, other.angle) {
            (AngleExponent::Known(a), AngleExponent::Known(b)) if a != b => Agreement::AngleDiffers,
            (AngleExponent::Known(_), AngleExponent::Known(_))
            | (AngleExponent::Composed(_) | AngleExponent::Neutral, _)
            | (_, AngleExponent::Composed(_) | AngleExponent::Neutral) => Agreement::Same,
        }
    }

    /// The dimension as a unit gives it: the kinds of the rotating drive do not say how often the angle is in them.
    ///
    /// A torque is in N.m and in N.m/rad times rad; so is a motor constant in N.m/A and in V.s/rad. A quantity
    /// declared in one of these units is neutral, and so is all that is computed from it.
    pub(crate) fn of_unit(self) -> Self {
        let neutral = ANGLE_NEUTRAL
            .iter()
            .any(|base| Self::si(*base, 0).base == self.base);
        if neutral {
            Self {
                angle: AngleExponent::Neutral,
                ..self
            }
        } else {
            self
        }
    }

    fn combine(self, other: Self, op: impl Fn(Exponent, Exponent) -> Exponent) -> Self {
        let angle = match (self.angle, other.angle) {
            (AngleExponent::Neutral, _) | (_, AngleExponent::Neutral) => AngleExponent::Neutral,
            (AngleExponent::Known(a), AngleExponent::Known(b)) => AngleExponent::Known(op(a, b)),
            (
                AngleExponent::Known(a) | AngleExponent::Composed(a),
                AngleExponent::Known(b) | AngleExponent::Composed(b),
            ) => AngleExponent::Composed(op(a, b)),
        };
        Self {
            base: std::array::from_fn(|i| op(self.base[i], other.base[i])),
            angle,
        }
    }
}

/// Base exponents of the kinds whose units say nothing of the angle.
const ANGLE_NEUTRAL: [[i16; 7]; 5] = [
    [1, 2, 0, -2, 0, 0, 0], // torque, energy, rotational stiffness: N.m, J, N.m/rad
    [1, 2, 0, 0, 0, 0, 0],  // moment of inertia: kg.m2
    [1, 2, 0, -1, 0, 0, 0], // rotational damping, angular momentum: N.m.s/rad
    [1, 3, 0, -2, 0, 0, 0], // torsional rigidity: N.m2
    [1, 2, -1, -2, 0, 0, 0], // motor constant, flux linkage: N.m/A, V.s/rad
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_unit;

    fn unit(text: &str) -> Dimension {
        parse_unit(text).unwrap().dimension
    }

    #[test]
    fn angles_warn_and_the_rest_errs() {
        assert_eq!(unit("Hz").agreement(unit("rad/s")), Agreement::AngleDiffers);
        assert_eq!(unit("Hz").agreement(unit("1/s")), Agreement::Same);
        assert_eq!(unit("rpm").agreement(unit("rad/s")), Agreement::Same);
        assert_eq!(unit("m").agreement(unit("m/rad")), Agreement::AngleDiffers);
        assert_eq!(
            unit("m").agreement(unit("mm/rev").multiply(unit("rad"))),
            Agreement::Same
        );
        assert_eq!(unit("N").agreement(unit("N.m")), Agreement::Different);
        assert_eq!(
            unit("rad").agreement(Dimension::DIMENSIONLESS),
            Agreement::AngleDiffers
        );
    }

    #[test]
    fn torque_inertia_and_motor_constants_match_any_angle() {
        let torque = unit("N.m");
        assert_eq!(torque.angle(), AngleExponent::Neutral);
        assert_eq!(
            unit("N.m/rad").multiply(unit("rad")).agreement(torque),
            Agreement::Same
        );
        assert_eq!(unit("N.m/rad"), torque);
        assert_eq!(
            unit("kg.m2").multiply(unit("rad/s2")).agreement(torque),
            Agreement::Same
        );
        assert_eq!(
            unit("N.m.s/rad").multiply(unit("rad/s")).agreement(torque),
            Agreement::Same
        );
        assert_eq!(unit("V.s/rad").agreement(unit("N.m/A")), Agreement::Same);
        assert_eq!(unit("N.m2").angle(), AngleExponent::Neutral);
        let power = torque.multiply(unit("rad/s"));
        assert_eq!(power.agreement(unit("W")), Agreement::Same);
        assert_eq!(power.angle(), AngleExponent::Neutral);
    }

    #[test]
    fn power_voltage_and_force_know_their_angle() {
        for text in [
            "W", "V", "ohm", "H", "N", "Pa", "kg", "A.s", "m/s2", "Wb.A/m2",
        ] {
            assert_eq!(
                unit(text).angle(),
                AngleExponent::Known(Exponent::ZERO),
                "{text}"
            );
        }
    }

    #[test]
    fn a_product_is_not_neutral_only_because_it_looks_like_a_torque() {
        let energy = unit("kg").multiply(unit("m/s")).multiply(unit("m/s"));
        assert_eq!(energy.angle(), AngleExponent::Known(Exponent::ZERO));
        assert_eq!(energy.agreement(unit("J")), Agreement::Same);
    }

    #[test]
    fn powers_are_exact_or_refused() {
        assert_eq!(unit("m2").sqrt(), Some(Dimension::LENGTH));
        assert_eq!(
            unit("1/s").power(Exponent::integer(-1)),
            Some(Dimension::TIME)
        );
        assert_eq!(
            unit("N.m").power(Exponent::ZERO),
            Some(Dimension::DIMENSIONLESS)
        );
        assert_eq!(unit("N.m").sqrt().unwrap().angle(), AngleExponent::Neutral);
        let sixteenth = Exponent::ratio(1, 16).unwrap();
        assert_eq!(unit("m").power(sixteenth).unwrap().sqrt(), None);
    }
}
