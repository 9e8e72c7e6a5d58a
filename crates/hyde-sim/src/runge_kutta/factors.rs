//! [`Factors`]: those of a step's matrix, and those of other lengths of a step that may come back.
//!
//! Between the ticks of a clock steps have the same few lengths again and again. Where the equations are affine, their factors
//! are those of each stretch as long as no coefficient changes.

use hyde_ida::{Error, LinearMethod, Pattern, SetAside, Singular, SparseSolver};

/// Of so many other lengths factors are kept.
const MOST_ASIDE: usize = 16;
/// Lengths that differ by this part of theirs differ by rounding.
const SAME: f64 = 1e-9;

/// What matrix factors are of: the length of the step in s, and the coefficients of affine equations.
#[derive(Clone, Copy)]
struct Of {
    step_s: f64,
    coefficients: Option<u64>,
}

/// The factors of a step's matrix.
pub(crate) struct Factors {
    linear: SparseSolver,
    /// None where the factors are of no use.
    of: Option<Of>,
    /// Whether lengths come back, and the factors of others, the one used last at the end.
    come_back: bool,
    aside: Vec<(Of, SetAside)>,
}

impl Factors {
    /// No factors yet, of matrices of this pattern. Those of other lengths are kept where lengths `come_back`.
    ///
    /// # Errors
    /// The analysis of the pattern does not fit into the memory.
    pub(crate) fn new(pattern: Pattern, come_back: bool) -> Result<Self, Error> {
        Ok(Self {
            linear: SparseSolver::new(pattern, LinearMethod::Auto)?,
            of: None,
            come_back,
            aside: Vec::new(),
        })
    }

    /// Others of the same pattern, without values.
    pub(super) fn empty(&self) -> Result<Self, Error> {
        Self::new(self.linear.pattern().clone(), false)
    }

    pub(super) fn come_back(&self) -> bool {
        self.come_back
    }

    pub(super) fn pattern(&self) -> &Pattern {
        self.linear.pattern()
    }

    /// The length in s of the step whose factors they are; none if they are of no use.
    pub(super) fn step_s(&self) -> Option<f64> {
        self.of.map(|of| of.step_s)
    }

    /// Whether they are of these coefficients: so one iteration solves a stage.
    pub(super) fn are_of(&self, coefficients: Option<u64>) -> bool {
        coefficients.is_some() && self.of.is_some_and(|of| of.coefficients == coefficients)
    }

    /// All lengths in s whose factors with these coefficients are at hand.
    pub(super) fn lengths_s(&self, coefficients: Option<u64>) -> impl Iterator<Item = f64> {
        let aside = self.aside.iter().map(|(of, _)| of);
        let known =
            aside.filter(move |of| coefficients.is_some() && of.coefficients == coefficients);
        self.of.iter().chain(known).map(|of| of.step_s)
    }

    pub(super) fn forget(&mut self) {
        self.of = None;
    }

    /// Whether there are factors for steps of `h` s: those at hand, or those of affine equations that were set aside.
    pub(super) fn are_for(&mut self, h: f64, coefficients: Option<u64>) -> bool {
        let is_length = |of: &Of| (of.step_s - h).abs() <= SAME * h;
        if self.of.as_ref().is_some_and(is_length) {
            return true;
        }
        let Some(of) = self.of.filter(|_| coefficients.is_some()) else {
            return false;
        };
        let mut others = self.aside.iter();
        let found = others.position(|(of, _)| is_length(of) && of.coefficients == coefficients);
        let Some((others, mut aside)) = found.map(|found| self.aside.remove(found)) else {
            return false;
        };
        let taken = self.linear.exchange(&mut aside);
        self.aside.push((of, aside));
        self.of = taken.then_some(others);
        taken
    }

    /// Factors the matrix of steps of `h` s with these values.
    pub(super) fn factor(
        &mut self,
        h: f64,
        coefficients: Option<u64>,
        matrix: &[f64],
    ) -> Result<(), Singular> {
        if let Some(of) = self.of.take().filter(|_| self.come_back)
            && of.coefficients.is_some()
        {
            let mut aside = match self.aside.len() < MOST_ASIDE {
                true => SetAside::default(),
                false => self.aside.remove(0).1,
            };
            self.linear.exchange(&mut aside);
            self.aside.push((of, aside));
        }
        self.linear.factor(matrix)?;
        self.of = Some(Of {
            step_s: h,
            coefficients,
        });
        Ok(())
    }

    /// Replaces a right side by the solution.
    pub(super) fn solve(&mut self, right: &mut [f64]) {
        self.linear.solve(right);
    }
}
