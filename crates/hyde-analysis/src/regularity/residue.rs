//! Numbers modulo the prime 2^61 - 1: exact sums and products, so that what cancels is told from what is small.
//!
//! A double is an integer times a power of two, and 2^61 is 1 here: every finite double has its residue. Rank over a
//! prime field with random numbers for what is not known: Schwartz, J. ACM 27 (1980) 701.

/// The prime.
const P: u64 = (1 << 61) - 1;

/// A number modulo the prime.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Residue(u64);

impl Residue {
    pub(crate) const ZERO: Self = Self(0);
    pub(crate) const ONE: Self = Self(1);

    /// The residue of a finite double.
    pub(crate) fn of(value: f64) -> Option<Self> {
        if !value.is_finite() {
            return None;
        }
        let bits = value.to_bits();
        let exponent = i64::try_from((bits >> 52) & 0x7ff).unwrap_or(0);
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, power) = match exponent {
            0 => (fraction, -1074),
            _ => (fraction | (1 << 52), exponent - 1075),
        };
        let shift = power.rem_euclid(61);
        let whole = Self(mantissa).times(Self(1 << shift));
        Some(if value < 0.0 {
            Self::ZERO.minus(whole)
        } else {
            whole
        })
    }

    pub(crate) fn plus(self, other: Self) -> Self {
        Self((self.0 + other.0) % P)
    }

    pub(crate) fn minus(self, other: Self) -> Self {
        Self((self.0 + P - other.0) % P)
    }

    pub(crate) fn times(self, other: Self) -> Self {
        // 2^61 is 1: the high bits are added to the low ones.
        let product = u128::from(self.0) * u128::from(other.0);
        let low = u64::try_from(product & u128::from(P)).unwrap_or(0);
        let high = u64::try_from(product >> 61).unwrap_or(0);
        Self((low + high) % P)
    }

    /// `None` of zero. By Fermat: a^(P-2) is 1/a.
    pub(crate) fn inverse(self) -> Option<Self> {
        if self == Self::ZERO {
            return None;
        }
        let (mut result, mut base, mut power) = (Self::ONE, self, P - 2);
        while power > 0 {
            if power & 1 == 1 {
                result = result.times(base);
            }
            base = base.times(base);
            power >>= 1;
        }
        Some(result)
    }
}

/// Numbers without relation to each other, the same in every run (splitmix64: Steele, Lea and Flood, OOPSLA 2014).
pub(crate) struct Generic(u64);

impl Generic {
    pub(crate) fn new() -> Self {
        Self(0x68_79_64_65)
    }

    /// The next one; not zero.
    pub(crate) fn next(&mut self) -> Residue {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        Residue(1 + (z ^ (z >> 31)) % (P - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn doubles_keep_their_sums_and_products() {
        let of = |value: f64| Residue::of(value).unwrap();
        // All exact in doubles, so exact here: 0.375 * -12 = -4.5, 2^-200 * 2^200 = 1.
        assert_eq!(of(0.375).times(of(-12.0)), of(-4.5));
        assert_eq!(of(0.375).plus(of(-12.0)), of(-11.625));
        assert_eq!(of(2_f64.powi(-200)).times(of(2_f64.powi(200))), of(1.0));
        assert_eq!(of(7.0).inverse().unwrap().times(of(7.0)), Residue::ONE);
        // A third is no double: three of them are not 1.
        assert_ne!(of(1.0 / 3.0).times(of(3.0)), Residue::ONE);
        assert!(Residue::of(f64::NAN).is_none() && Residue::ZERO.inverse().is_none());
    }
}
