//! Exact rational exponents of the base units, so that `sqrt` of an area is a length and nothing is rounded.

use std::fmt;
use std::ops::{Add, Neg, Sub};

/// An exact rational exponent such as `2`, `-1` or `1/2`.
///
/// It is kept in parts of 5040, the least number that all of 1 to 10 and 16 divide: four square roots on end, and
/// every root up to the tenth, are exact. The largest exponent is about 400 000, the least as far below 0; sums saturate there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Exponent(i32);

const PARTS: i32 = 5040;
/// So that what is above and below a line of a fraction saturates alike.
const LARGEST: i32 = i32::MAX;

impl Exponent {
    /// The exponent 0.
    pub const ZERO: Self = Self(0);
    /// The exponent 1.
    pub const ONE: Self = Self(PARTS);
    /// The exponent 1/2.
    pub const HALF: Self = Self(PARTS / 2);

    /// A whole exponent.
    #[must_use]
    pub const fn integer(n: i16) -> Self {
        Self(n as i32 * PARTS)
    }

    /// The exponent `n/d`; none if `d` is 0 or the ratio is not a whole number of parts.
    #[must_use]
    pub fn ratio(n: i32, d: i32) -> Option<Self> {
        let parts = i64::from(n) * i64::from(PARTS);
        let d = i64::from(d);
        if d == 0 || parts % d != 0 {
            return None;
        }
        Self::of_parts(parts / d)
    }

    /// The exponent that a number literal means: `0.5` is 1/2, `0.3333333333333333` is 1/3.
    ///
    /// None for a number that is no such ratio (to 1e-12 of itself), infinite, or not a number.
    #[must_use]
    pub fn from_f64(value: f64) -> Option<Self> {
        let parts = value * f64::from(PARTS);
        let whole = parts.round();
        let near = (parts - whole).abs() <= 1e-12 * parts.abs();
        (near && whole.abs() < f64::from(LARGEST)).then_some(Self(whole as i32))
    }

    /// The product, as in `(m^a)^b`; none if it is not a whole number of parts or too large.
    #[must_use]
    pub fn times(self, other: Self) -> Option<Self> {
        let parts = i64::from(self.0) * i64::from(other.0);
        if parts % i64::from(PARTS) != 0 {
            return None;
        }
        Self::of_parts(parts / i64::from(PARTS))
    }

    /// The quotient, as in the root of `m^a` that is raised to b; none if it is not a whole number of parts or too large.
    #[must_use]
    pub fn over(self, other: Self) -> Option<Self> {
        let parts = i64::from(self.0) * i64::from(PARTS);
        let divisor = i64::from(other.0);
        if divisor == 0 || parts % divisor != 0 {
            return None;
        }
        Self::of_parts(parts / divisor)
    }

    /// None if it is too large.
    fn of_parts(parts: i64) -> Option<Self> {
        let parts = i32::try_from(parts).ok()?;
        (parts >= -LARGEST).then_some(Self(parts))
    }

    /// Whether it is 0.
    #[must_use]
    pub const fn is_zero(self) -> bool {
        self.0 == 0
    }

    /// Whether it is below 0.
    #[must_use]
    pub const fn is_negative(self) -> bool {
        self.0 < 0
    }

    /// The nearest double.
    #[must_use]
    pub fn to_f64(self) -> f64 {
        f64::from(self.0) / f64::from(PARTS)
    }

    /// The whole number it is, if it is one.
    #[must_use]
    pub const fn as_integer(self) -> Option<i32> {
        if self.0 % PARTS == 0 {
            Some(self.0 / PARTS)
        } else {
            None
        }
    }
}

impl Add for Exponent {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0).max(-LARGEST))
    }
}

impl Sub for Exponent {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0.saturating_sub(other.0).max(-LARGEST))
    }
}

impl Neg for Exponent {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

/// `2`, `-1`, `1/2`: in lowest terms.
impl fmt::Display for Exponent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let divisor = greatest_common_divisor(self.0.unsigned_abs(), PARTS.unsigned_abs());
        let sign = if self.is_negative() { "-" } else { "" };
        write!(f, "{sign}{}", self.0.unsigned_abs() / divisor)?;
        match PARTS.unsigned_abs() / divisor {
            1 => Ok(()),
            denominator => write!(f, "/{denominator}"),
        }
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 {
        a
    } else {
        greatest_common_divisor(b, a % b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_in_lowest_terms() {
        let text = |n, d| Exponent::ratio(n, d).unwrap().to_string();
        assert_eq!(text(2, 1), "2");
        assert_eq!(text(-3, 3), "-1");
        assert_eq!(text(2, 4), "1/2");
        assert_eq!(text(-7, 16), "-7/16");
        assert_eq!(Exponent::ZERO.to_string(), "0");
    }

    #[test]
    fn roots_are_exact_or_refused() {
        let third = Exponent::ratio(1, 3).unwrap();
        assert_eq!(third + third + third, Exponent::ONE);
        assert_eq!(third.times(Exponent::integer(3)), Some(Exponent::ONE));
        let sixteenth = Exponent::ratio(1, 16).unwrap();
        assert_eq!(sixteenth.times(Exponent::HALF), None);
        assert_eq!(Exponent::ratio(1, 11), None);
        assert_eq!(Exponent::ratio(1, 0), None);
    }

    #[test]
    fn sums_saturate_alike_on_both_sides() {
        let large = Exponent::ratio(400_000, 1).unwrap();
        assert_eq!(-(large + large), Exponent::ZERO - large - large);
        assert_eq!(Exponent::ratio(i32::MIN, PARTS), None);
    }

    #[test]
    fn quotients_are_exact_or_refused() {
        let exponent = |value| Exponent::from_f64(value).unwrap();
        assert_eq!(exponent(2.6).over(exponent(1.3)), Some(exponent(2.0)));
        assert_eq!(Exponent::ZERO.over(exponent(1.3)), Some(Exponent::ZERO));
        assert_eq!(Exponent::ONE.over(exponent(-2.0)), Some(exponent(-0.5)));
        assert_eq!(Exponent::ONE.over(exponent(1.3)), None);
        assert_eq!(Exponent::ONE.over(Exponent::ZERO), None);
    }

    #[test]
    fn literals_become_ratios() {
        assert_eq!(Exponent::from_f64(0.5), Some(Exponent::HALF));
        assert_eq!(Exponent::from_f64(1.0 / 3.0), Exponent::ratio(1, 3));
        assert_eq!(Exponent::from_f64(-2.5), Exponent::ratio(-5, 2));
        assert_eq!(Exponent::from_f64(0.0), Some(Exponent::ZERO));
        for wrong in [std::f64::consts::PI, f64::NAN, f64::INFINITY, 1e9] {
            assert_eq!(Exponent::from_f64(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn sums_saturate_and_products_refuse() {
        let large = Exponent(i32::MAX);
        assert_eq!(large + Exponent::ONE, large);
        assert_eq!(large.times(Exponent::integer(2)), None);
        assert_eq!(Exponent::integer(i16::MAX).as_integer(), Some(32767));
    }
}
