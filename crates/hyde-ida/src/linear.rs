//! Linear systems with a fixed pattern: dense for a few unknowns, KLU for more.

use crate::dense::DenseFactors;
use crate::fixed_pivots::Values;
use crate::klu::{KluFactors, Pivots};
use crate::{Error, Pattern, Statistics};

/// Up to this many unknowns `Auto` is dense (measured on a torsional shaft).
const LARGEST_DENSE: usize = 12;

/// How linear systems are solved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearMethod {
    /// Dense for few unknowns, else KLU.
    #[default]
    Auto,
    /// Dense LU with partial pivoting.
    Dense,
    /// Sparse LU by KLU.
    Klu,
}

/// A solver of linear systems `A x = b` whose matrices all have one pattern; IDA uses it, and it stands alone.
#[derive(Debug)]
pub struct SparseSolver {
    pattern: Pattern,
    factors: Factors,
    /// Whether the last `factor` succeeded.
    factored: bool,
    pub(crate) counts: FactorCounts,
}

/// Factors of a matrix that may come back: see [`SparseSolver::exchange`].
#[derive(Debug, Default)]
pub struct SetAside {
    dense: Option<DenseFactors>,
    /// When the pivots were chosen, and the values.
    sparse: (u64, Values),
}

/// A matrix without an inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Singular {
    /// A column that depends on the others: an unknown the equations do not determine.
    pub unknown: usize,
}

/// How often pivots were chosen and kept.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct FactorCounts {
    factorizations: u64,
    refactorizations: u64,
}

#[derive(Debug)]
enum Factors {
    Dense(DenseFactors),
    Klu(KluFactors),
}

impl SparseSolver {
    /// A solver for matrices of this pattern; analyses it if the method is sparse.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] if the analysis does not fit.
    pub fn new(pattern: Pattern, method: LinearMethod) -> Result<Self, Error> {
        let dense = match method {
            LinearMethod::Auto => pattern.n() <= LARGEST_DENSE,
            LinearMethod::Dense => true,
            LinearMethod::Klu => false,
        };
        let factors = if dense {
            Factors::Dense(DenseFactors::new(&pattern))
        } else {
            Factors::Klu(KluFactors::new(&pattern)?)
        };
        Ok(Self {
            pattern,
            factors,
            factored: false,
            counts: FactorCounts::default(),
        })
    }

    /// The pattern of the matrices.
    #[must_use]
    pub fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Factors the matrix with these values, in the order of the pattern.
    ///
    /// Only a pivot of exactly 0 is called singular. A matrix that is so up to rounding is told by its
    /// [`reciprocal_condition`](Self::reciprocal_condition), which is near 1e-16.
    ///
    /// # Errors
    /// [`Singular`] if an unknown has no pivot.
    ///
    /// # Panics
    /// If `values` does not have the length of the pattern.
    pub fn factor(&mut self, values: &[f64]) -> Result<(), Singular> {
        assert_eq!(
            values.len(),
            self.pattern.n_entries(),
            "one value for each entry of the pattern"
        );
        self.factored = false;
        let pivots = match &mut self.factors {
            Factors::Dense(factors) => factors.factor(values).map(|()| Pivots::New)?,
            Factors::Klu(factors) => factors.factor(&self.pattern, values)?,
        };
        self.factored = true;
        match pivots {
            Pivots::New => self.counts.factorizations += 1,
            Pivots::Kept => self.counts.refactorizations += 1,
        }
        Ok(())
    }

    /// Exchanges the factors for others of this solver that were set aside before: none are lost, and none are copied.
    /// Returns whether there are factors now; if not, the next matrix must be factored first.
    ///
    /// # Panics
    /// If the last [`factor`](Self::factor) did not succeed.
    pub fn exchange(&mut self, aside: &mut SetAside) -> bool {
        self.expect_factors();
        self.factored = match (&mut self.factors, &mut aside.dense) {
            (Factors::Dense(own), Some(other)) => {
                std::mem::swap(own, other);
                true
            }
            (Factors::Dense(own), none) => {
                *none = Some(own.clone());
                false
            }
            (Factors::Klu(own), _) => own.exchange(&mut aside.sparse),
        };
        self.factored
    }

    /// Replaces the right side `b` by the solution, with the matrix factored last.
    ///
    /// # Panics
    /// If the last [`factor`](Self::factor) did not succeed, or `b` does not have an entry for each equation.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.expect_factors();
        assert_eq!(
            b.len(),
            self.pattern.n(),
            "one entry of the right side for each equation"
        );
        match &mut self.factors {
            Factors::Dense(factors) => factors.solve(b),
            Factors::Klu(factors) => factors.solve(b),
        }
    }

    /// 1 over the condition number, in the 1-norm, of the matrix with these values after its rows and then its columns
    /// were scaled to a largest entry of 1, so that the units of equations and unknowns do not count; 0 if singular.
    /// Exact if dense, an estimate by KLU. For diagnosis: it analyses and factors anew and leaves the factors alone.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`] as in [`new`](Self::new).
    ///
    /// # Panics
    /// If `values` does not have the length of the pattern.
    pub fn reciprocal_condition(&self, values: &[f64]) -> Result<f64, Error> {
        assert_eq!(
            values.len(),
            self.pattern.n_entries(),
            "one value for each entry of the pattern"
        );
        let scaled = equilibrate(&self.pattern, values);
        Ok(match &self.factors {
            Factors::Dense(factors) => factors.clone().reciprocal_condition(&scaled),
            Factors::Klu(_) => {
                KluFactors::new(&self.pattern)?.reciprocal_condition(&self.pattern, &scaled)
            }
        })
    }

    fn expect_factors(&self) {
        assert!(
            self.factored,
            "a matrix must be factored before systems with it are solved"
        );
    }
}

/// Divides each row, then each column, by its largest entry.
fn equilibrate(pattern: &Pattern, values: &[f64]) -> Vec<f64> {
    let mut scaled = values.to_vec();
    scale_lines(pattern, &mut scaled, |row, _| row);
    scale_lines(pattern, &mut scaled, |_, column| column);
    scaled
}

fn scale_lines(pattern: &Pattern, values: &mut [f64], line: impl Fn(usize, usize) -> usize) {
    let mut largest = vec![0.0_f64; pattern.n()];
    for (row, column, entry) in pattern.entries() {
        let largest = &mut largest[line(row, column)];
        *largest = largest.max(values[entry].abs());
    }
    for (row, column, entry) in pattern.entries() {
        // A line of zeros stays one.
        values[entry] /= largest[line(row, column)].max(f64::MIN_POSITIVE);
    }
}

impl FactorCounts {
    pub(crate) fn write_to(self, statistics: &mut Statistics) {
        statistics.factorizations = self.factorizations;
        statistics.refactorizations = self.refactorizations;
    }
}

impl std::fmt::Display for Singular {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            f,
            "the matrix is singular: unknown {} has no pivot",
            self.unknown
        )
    }
}

impl std::error::Error for Singular {}
