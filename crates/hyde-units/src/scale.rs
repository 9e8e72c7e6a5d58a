//! The factor of a unit, kept as an exact ratio and a power of pi, so that conversion rounds as little as it can.

use crate::Exponent;
use std::f64::consts::PI;

/// The factor from a unit to SI: `numerator / denominator * pi^pi`.
///
/// A tenth cannot be written in binary, a division by ten can be rounded correctly. So a prefix below one is a
/// denominator, and `350 [mm]` is the double nearest to 0.35. Numerator and denominator are whole numbers
/// without a common factor, except where a unit was raised to a fraction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    numerator: f64,
    denominator: f64,
    pi: i32,
}

/// Largest number up to which every whole number is a double.
const EXACT: f64 = 9_007_199_254_740_992.0;

impl Scale {
    /// The factor 1.
    pub const ONE: Self = Self::ratio(1.0, 1.0);

    /// The factor `numerator / denominator`, both whole.
    #[must_use]
    pub const fn ratio(numerator: f64, denominator: f64) -> Self {
        Self {
            numerator,
            denominator,
            pi: 0,
        }
    }

    /// The factor `pi * numerator / denominator`, both whole.
    #[must_use]
    pub const fn of_pi(numerator: f64, denominator: f64) -> Self {
        Self {
            numerator,
            denominator,
            pi: 1,
        }
    }

    /// The factor as one double.
    #[must_use]
    pub fn factor(self) -> f64 {
        self.apply(1.0)
    }

    /// Whether the factor is exactly 1.
    #[must_use]
    pub fn is_one(self) -> bool {
        self == Self::ONE
    }

    /// `value` times the factor.
    #[must_use]
    pub fn apply(self, value: f64) -> f64 {
        let rational = value * self.numerator / self.denominator;
        if self.pi >= 0 {
            rational * pi_to(self.pi)
        } else {
            rational / pi_to(-self.pi)
        }
    }

    /// `value` over the factor.
    #[must_use]
    pub fn remove(self, value: f64) -> f64 {
        let rational = value * self.denominator / self.numerator;
        if self.pi >= 0 {
            rational / pi_to(self.pi)
        } else {
            rational * pi_to(-self.pi)
        }
    }

    /// The product of two factors.
    #[must_use]
    pub fn multiply(self, other: Self) -> Self {
        Self {
            numerator: self.numerator * other.numerator,
            denominator: self.denominator * other.denominator,
            pi: self.pi + other.pi,
        }
        .reduced()
    }

    /// One over the factor.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self {
            numerator: self.denominator,
            denominator: self.numerator,
            pi: -self.pi,
        }
    }

    /// The power of the factor: exact for whole exponents while the numbers stay below 2^53.
    #[must_use]
    pub fn power(self, exponent: Exponent) -> Self {
        let Some(n) = exponent.as_integer() else {
            return Self::ratio(self.factor().powf(exponent.to_f64()), 1.0);
        };
        let base = if n < 0 { self.inverse() } else { self };
        if base.is_one() {
            return Self::ONE;
        }
        (0..n.unsigned_abs()).fold(Self::ONE, |product, _| product.multiply(base))
    }

    /// Whether it is a number at all: a high power of a prefix can leave the range of doubles.
    pub(crate) fn is_usable(self) -> bool {
        [self.numerator, self.denominator, self.factor()]
            .iter()
            .all(|part| part.is_normal())
    }

    fn reduced(self) -> Self {
        let whole = |x: f64| (1.0..=EXACT).contains(&x) && x.fract() == 0.0;
        if !whole(self.numerator) || !whole(self.denominator) {
            return self;
        }
        let divisor = greatest_common_divisor(self.numerator, self.denominator);
        Self {
            numerator: self.numerator / divisor,
            denominator: self.denominator / divisor,
            pi: self.pi,
        }
    }
}

/// Multiplied out, because the precision of `powi` is not specified.
fn pi_to(n: i32) -> f64 {
    (0..n).fold(1.0, |product, _| product * PI)
}

/// Of two whole doubles up to 2^53, for which `%` is exact.
fn greatest_common_divisor(a: f64, b: f64) -> f64 {
    if b == 0.0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "exactness is the contract of a scale")]
mod tests {
    use super::*;

    #[test]
    fn division_gives_the_nearest_double() {
        let milli = Scale::ratio(1.0, 1000.0);
        for value in 1..10_000 {
            let text = format!("{value}e-3");
            assert_eq!(milli.apply(f64::from(value)), text.parse::<f64>().unwrap());
        }
    }

    #[test]
    fn products_are_reduced() {
        let kilometre = Scale::ratio(1000.0, 1.0);
        let hour = Scale::ratio(3600.0, 1.0);
        let speed = kilometre.multiply(hour.inverse());
        assert_eq!(speed, Scale::ratio(5.0, 18.0));
        assert_eq!(speed.apply(36.0), 10.0);
    }

    #[test]
    fn powers_of_pi_cancel() {
        let turn = Scale::of_pi(2.0, 1.0);
        let degree = Scale::of_pi(1.0, 180.0);
        assert_eq!(degree.multiply(turn.inverse()), Scale::ratio(1.0, 360.0));
        assert_eq!(degree.apply(90.0), std::f64::consts::FRAC_PI_2);
        assert_eq!(turn.remove(turn.apply(0.25)), 0.25);
    }

    #[test]
    fn powers_are_exact_for_whole_exponents() {
        let centi = Scale::ratio(1.0, 100.0);
        assert_eq!(centi.power(Exponent::integer(4)), Scale::ratio(1.0, 1e8));
        assert_eq!(centi.power(Exponent::integer(-2)), Scale::ratio(1e4, 1.0));
        assert_eq!(centi.power(Exponent::HALF).factor(), 0.1);
        assert!(
            !Scale::ratio(1.0, 1e15)
                .power(Exponent::integer(90))
                .is_usable()
        );
    }
}
