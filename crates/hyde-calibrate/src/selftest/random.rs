//! [`Random`]: numbers by seed and purpose: a case has the same ones whoever runs it, and in whatever order.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// Random numbers of one purpose.
pub(super) struct Random(ChaCha8Rng);

impl Random {
    /// Those of a seed for a purpose.
    pub(super) fn new(seed: u64, purpose: &str) -> Self {
        let mut numbers = ChaCha8Rng::seed_from_u64(seed);
        numbers.set_stream(hash(purpose));
        Self(numbers)
    }

    /// Uniform, at least 0, below 1.
    pub(super) fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between two numbers.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// 1 or -1.
    pub(super) fn sign(&mut self) -> f64 {
        if self.uniform() < 0.5 { 1.0 } else { -1.0 }
    }

    /// Normal, of mean 0 and variance 1 (Box and Muller, Ann. Math. Stat. 29, 1958, 610).
    pub(super) fn normal(&mut self) -> f64 {
        let (a, b) = (1.0 - self.uniform(), self.uniform());
        (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos()
    }
}

/// A number of a text (Fowler, Noll and Vo, FNV-1a, 64 bits).
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn normal_numbers_have_the_moments_of_the_distribution() {
        let mut random = Random::new(1, "moments");
        let n = 40_000;
        let all: Vec<f64> = (0..n).map(|_| random.normal()).collect();
        let moment = |k: i32| all.iter().map(|x| x.powi(k)).sum::<f64>() / f64::from(n);
        // Five deviations of each: sqrt(1/n), sqrt(2/n), sqrt(96/n).
        assert!(moment(1).abs() < 0.025, "{}", moment(1));
        assert!((moment(2) - 1.0).abs() < 0.036, "{}", moment(2));
        assert!((moment(4) - 3.0).abs() < 0.245, "{}", moment(4));
    }

    #[test]
    fn purposes_have_numbers_of_their_own() {
        let first = |seed, purpose| Random::new(seed, purpose).uniform().to_bits();
        assert_eq!(first(1, "noise"), first(1, "noise"));
        assert_ne!(first(1, "noise"), first(1, "sizes"));
        assert_ne!(first(1, "noise"), first(2, "noise"));
    }
}
