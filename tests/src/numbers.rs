//! Numbers that a seed makes (Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, OOPSLA 2014).

/// A stream of numbers.
pub(crate) struct Numbers(u64);

impl Numbers {
    pub(crate) fn of(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x2545_F491_4F6C_DD1D) ^ 0x9E37_79B9)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Evenly between two bounds, with six digits.
    pub(crate) fn between(&mut self, from: f64, to: f64) -> f64 {
        let part = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        let value = from + part * (to - from);
        (value * 1e6).round() / 1e6
    }

    /// One of so many.
    pub(crate) fn one_of(&mut self, count: u64) -> u64 {
        self.next() % count
    }
}
