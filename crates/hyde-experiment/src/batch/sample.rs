//! Points in the unit interval by seed, dimension and number of the case: the same whoever asks, in whatever order.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

/// How ranges are filled with points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sampling {
    /// Independent and uniform.
    Random,
    /// One point in each of as many equal strata, in every dimension (McKay, Beckman and Conover 1979).
    Latin,
    /// Sobol's sequence with Owen's scrambling (Burley 2020, Practical Hash-based Owen Scrambling).
    Sobol,
}

/// The most points of a Sobol sequence, and the most dimensions: what the crate's tables hold.
pub(super) const SOBOL_LIMITS: (usize, usize) = (1 << 16, 256);

/// Points of one dimension.
#[derive(Clone, Debug)]
pub(super) struct Points {
    how: Sampling,
    seed: u64,
    dimension: u32,
    /// The stratum of each point; of a Latin hypercube only.
    strata: Vec<u32>,
}

impl Points {
    /// The points of a dimension; `count` of them.
    pub(super) fn new(how: Sampling, seed: u64, dimension: usize, count: usize) -> Self {
        let dimension = u32::try_from(dimension).unwrap_or(u32::MAX);
        let strata = match how {
            Sampling::Random | Sampling::Sobol => Vec::new(),
            Sampling::Latin => permutation(seed, dimension, count),
        };
        Self {
            how,
            seed,
            dimension,
            strata,
        }
    }

    /// Point number `k`, from 0; at least 0, below 1.
    pub(super) fn at(&self, k: usize) -> f64 {
        match self.how {
            Sampling::Random => uniform(self.seed, self.dimension, k),
            Sampling::Latin => {
                let stratum = self.strata.get(k).copied().unwrap_or(0);
                (f64::from(stratum) + uniform(self.seed, self.dimension, k))
                    / self.strata.len() as f64
            }
            Sampling::Sobol => {
                let index = u32::try_from(k).unwrap_or(u32::MAX);
                // Its seed has 32 bits: the two halves of ours.
                let seed = (self.seed ^ (self.seed >> 32)) as u32;
                f64::from(sobol_burley::sample(index, self.dimension, seed))
            }
        }
    }
}

/// Number k of a dimension's stream, with 53 random bits.
fn uniform(seed: u64, dimension: u32, k: usize) -> f64 {
    let mut numbers = ChaCha8Rng::seed_from_u64(seed);
    numbers.set_stream(2 * u64::from(dimension));
    // Two words of 32 bits a number.
    numbers.set_word_pos(2 * k as u128);
    (numbers.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// A random order of 0 .. count (Fisher and Yates).
fn permutation(seed: u64, dimension: u32, count: usize) -> Vec<u32> {
    let mut numbers = ChaCha8Rng::seed_from_u64(seed);
    numbers.set_stream(2 * u64::from(dimension) + 1);
    let mut order: Vec<u32> = (0..u32::try_from(count).unwrap_or(u32::MAX)).collect();
    for last in (1..order.len()).rev() {
        // The bias of the remainder is below count / 2^64.
        let other = (numbers.next_u64() % (last as u64 + 1)) as usize;
        order.swap(last, other);
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and covariance with a second dimension.
    fn moments(how: Sampling, count: usize) -> (f64, f64) {
        let dimension = |d| Points::new(how, 7, d, count);
        let (a, b) = (dimension(0), dimension(1));
        let n = count as f64;
        let mean = (0..count).map(|k| a.at(k)).sum::<f64>() / n;
        let both = (0..count)
            .map(|k| (a.at(k) - 0.5) * (b.at(k) - 0.5))
            .sum::<f64>()
            / n;
        (mean, both)
    }

    #[test]
    fn points_fill_the_square_evenly() {
        for how in [Sampling::Random, Sampling::Latin, Sampling::Sobol] {
            let (mean, both) = moments(how, 4096);
            // Of independent points: deviations 0.29/sqrt(n) = 0.0045 and 1/12/sqrt(n) = 0.0013; five of them.
            assert!((mean - 0.5).abs() < 0.023, "{how:?}: {mean}");
            assert!(both.abs() < 0.0065, "{how:?}: {both}");
        }
    }

    #[test]
    fn a_latin_hypercube_has_one_point_in_each_stratum() {
        let points = Points::new(Sampling::Latin, 1, 3, 1000);
        let mut strata: Vec<usize> = (0..1000)
            .map(|k| (points.at(k) * 1000.0) as usize)
            .collect();
        assert_ne!(strata, (0..1000).collect::<Vec<_>>());
        strata.sort_unstable();
        assert_eq!(strata, (0..1000).collect::<Vec<_>>());
    }

    #[test]
    fn sobol_points_are_stratified_in_powers_of_two() {
        // The first 256 points of a (0, 2)-sequence have one in each elementary interval of 1/16 by 1/16.
        let (a, b) = (
            Points::new(Sampling::Sobol, 9, 0, 256),
            Points::new(Sampling::Sobol, 9, 1, 256),
        );
        let mut cells: Vec<usize> = (0..256)
            .map(|k| (a.at(k) * 16.0) as usize * 16 + (b.at(k) * 16.0) as usize)
            .collect();
        cells.sort_unstable();
        assert_eq!(cells, (0..256).collect::<Vec<_>>());
    }

    #[test]
    fn a_seed_and_a_dimension_have_points_of_their_own() {
        for how in [Sampling::Random, Sampling::Latin, Sampling::Sobol] {
            let at = |seed, dimension| Points::new(how, seed, dimension, 64).at(5).to_bits();
            assert_eq!(at(1, 0), at(1, 0));
            assert_ne!(at(1, 0), at(2, 0));
            assert_ne!(at(1, 0), at(1, 1));
        }
    }
}
