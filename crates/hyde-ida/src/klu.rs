//! LU factorization of a sparse matrix by KLU, with the symbolic analysis and the pivots kept.
//!
//! T. A. Davis and E. Palamadai Natarajan, Algorithm 907: KLU, ACM Trans. Math. Softw. 37 (2010), and the KLU user
//! guide. SUNDIALS has an interface of its own to KLU; this one differs in that a restart of IDA keeps the analysis
//! and the pivots, that a matrix whose pivots do not serve any more gets new ones at once, which matters when a mode of
//! the model has changed, and that the unknown without a pivot is known.
//!
//! KLU chooses the pivots. With the same pivots the next matrices are factored and solved by [`FixedPivots`].

use std::ptr;

use sundials_sys as sys;
// Its build script finds the library; without a use of the crate the linker would not see it.
use suitesparse_sys as _;

use crate::fixed_pivots::{Extracted, FixedPivots, Values};
use crate::interleave::interleaved;
use crate::{Error, Pattern, Singular};

/// Below this reciprocal growth of the entries while factoring, the old pivots are given up: half of the digits of the
/// solution may be lost then (user guide, `klu_rgrowth`).
const SMALLEST_RECIPROCAL_GROWTH: f64 = 1e-8;

/// The same for the first matrix in another order than KLU's, in which the pivots were not chosen.
const SMALLEST_OF_ANOTHER_ORDER: f64 = 1e-3;

/// A pattern's analysis and, after `factor`, a matrix's factors: KLU's own or those with its pivots.
#[derive(Debug)]
pub(crate) struct KluFactors {
    common: sys::klu_l_common,
    symbolic: *mut sys::klu_l_symbolic,
    numeric: *mut sys::klu_l_numeric,
    /// The factors of the matrix factored last; none before the first, and where KLU's serve.
    fixed: Option<Box<FixedPivots>>,
    /// How often pivots were chosen.
    choices: u64,
}

/// How the pivots were found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pivots {
    New,
    Kept,
}

// SAFETY: the analysis and the factors are heap memory that only this value points to, and KLU keeps no state outside
// them and `common`.
unsafe impl Send for KluFactors {}

impl KluFactors {
    /// Analyses the pattern: block triangular form and an ordering that keeps the factors sparse.
    pub(crate) fn new(pattern: &Pattern) -> Result<Self, Error> {
        let mut common = std::mem::MaybeUninit::<sys::klu_l_common>::zeroed();
        // SAFETY: `klu_l_defaults` fills all of the struct, for which all zero bits are a value: numbers and pointers.
        let mut common = unsafe {
            sys::klu_l_defaults(common.as_mut_ptr());
            common.assume_init()
        };
        let (starts, rows) = indices(pattern);
        // SAFETY: a `Pattern` is n columns with ascending rows inside the matrix, which KLU reads and does not write.
        let symbolic =
            unsafe { sys::klu_l_analyze(pattern.n() as i64, starts, rows, &raw mut common) };
        if symbolic.is_null() {
            return Err(Error::OutOfMemory);
        }
        Ok(Self {
            common,
            symbolic,
            numeric: ptr::null_mut(),
            fixed: None,
            choices: 0,
        })
    }

    /// Factors the matrix with these values; the pattern must be the one analysed.
    pub(crate) fn factor(&mut self, pattern: &Pattern, values: &[f64]) -> Result<Pivots, Singular> {
        if let Some(fixed) = &mut self.fixed
            && fixed.factor(values, SMALLEST_RECIPROCAL_GROWTH)
        {
            return Ok(Pivots::Kept);
        }
        self.choose_pivots(pattern, values)?;
        let found = self.extract(pattern.n());
        let serving = |found: &Extracted, growth: f64| {
            let mut fixed = Box::new(FixedPivots::new(pattern, found)?);
            fixed.factor(values, growth).then_some(fixed)
        };
        // Where neither order is of use even for this matrix, KLU's own factors serve.
        self.fixed = interleaved(&found)
            .and_then(|found| serving(&found, SMALLEST_OF_ANOTHER_ORDER))
            .or_else(|| serving(&found, SMALLEST_RECIPROCAL_GROWTH));
        if self.fixed.is_some() {
            self.free_numeric();
        }
        Ok(Pivots::New)
    }

    /// Factors the matrix with these values by KLU.
    fn choose_pivots(&mut self, pattern: &Pattern, values: &[f64]) -> Result<(), Singular> {
        self.fixed = None;
        self.choices += 1;
        self.free_numeric();
        let (starts, rows) = indices(pattern);
        // SAFETY: pattern and values belong together (checked by the caller) and are only read; `symbolic` is theirs.
        self.numeric = unsafe {
            sys::klu_l_factor(
                starts,
                rows,
                values.as_ptr().cast_mut(),
                self.symbolic,
                &raw mut self.common,
            )
        };
        if self.numeric.is_null() {
            let unknown = usize::try_from(self.common.singular_col)
                .unwrap_or(0)
                .min(pattern.n() - 1);
            return Err(Singular { unknown });
        }
        Ok(())
    }

    /// Exchanges the factors for those of another matrix, told by when their pivots were chosen. Returns whether there are
    /// any: not where others were chosen since, or KLU's own factors serve, which stay.
    pub(crate) fn exchange(&mut self, aside: &mut (u64, Values)) -> bool {
        let chosen = std::mem::replace(&mut aside.0, 0);
        if let Some(fixed) = &mut self.fixed {
            fixed.exchange(&mut aside.1);
            aside.0 = self.choices;
        }
        aside.0 != 0 && chosen == self.choices
    }

    /// Replaces `b` by the solution; the last `factor` must have succeeded.
    pub(crate) fn solve(&mut self, b: &mut [f64]) {
        if let Some(fixed) = &mut self.fixed {
            fixed.solve(b);
            return;
        }
        // SAFETY: there are factors, and `b` has as many entries as the matrix has rows (both checked by the caller);
        // without factors KLU would do nothing.
        unsafe {
            let n = b.len() as i64;
            sys::klu_l_solve(
                self.symbolic,
                self.numeric,
                n,
                1,
                b.as_mut_ptr(),
                &raw mut self.common,
            );
        }
    }

    /// An estimate of 1 over the condition number, in the 1-norm, of the matrix with these values, by factors of its own; 0
    /// if it is singular.
    pub(crate) fn reciprocal_condition(&mut self, pattern: &Pattern, values: &[f64]) -> f64 {
        if self.choose_pivots(pattern, values).is_err() {
            return 0.0;
        }
        let (starts, _) = indices(pattern);
        // SAFETY: as in `factor`; the values are those of the factors.
        unsafe {
            let values = values.as_ptr().cast_mut();
            sys::klu_l_condest(
                starts,
                values,
                self.symbolic,
                self.numeric,
                &raw mut self.common,
            );
        }
        1.0 / self.common.condest
    }

    /// Order, pivots and patterns of the factors that KLU has found of a matrix of `n` rows.
    fn extract(&mut self, n: usize) -> Extracted {
        let room = |len: i64| vec![0_i64; usize::try_from(len).unwrap_or(0)];
        // SAFETY: `klu_l_factor` has succeeded, so it points to a complete struct.
        let numeric = unsafe { &*self.numeric };
        let starts = || vec![0_i64; n + 1];
        let mut found = Extracted {
            lower: (starts(), room(numeric.lnz)),
            upper: (starts(), room(numeric.unz)),
            above: (starts(), room(numeric.nzoff)),
            row_at: vec![0; n],
            column_at: vec![0; n],
            blocks: room(numeric.nblocks + 1),
            scale: vec![1.0; n],
        };
        // A pattern is not written without its values, which are not of interest here.
        let most = found.lower.1.len().max(found.upper.1.len());
        let mut values = vec![0.0; most.max(found.above.1.len())];
        // SAFETY: every array has the length that the user guide asks for, that of the values for each of the three.
        unsafe {
            sys::klu_l_extract(
                self.numeric,
                self.symbolic,
                found.lower.0.as_mut_ptr(),
                found.lower.1.as_mut_ptr(),
                values.as_mut_ptr(),
                found.upper.0.as_mut_ptr(),
                found.upper.1.as_mut_ptr(),
                values.as_mut_ptr(),
                found.above.0.as_mut_ptr(),
                found.above.1.as_mut_ptr(),
                values.as_mut_ptr(),
                found.row_at.as_mut_ptr(),
                found.column_at.as_mut_ptr(),
                found.scale.as_mut_ptr(),
                found.blocks.as_mut_ptr(),
                &raw mut self.common,
            );
        }
        found
    }

    fn free_numeric(&mut self) {
        // SAFETY: KLU accepts a null pointer and leaves one.
        unsafe { sys::klu_l_free_numeric(&raw mut self.numeric, &raw mut self.common) };
    }
}

impl Drop for KluFactors {
    fn drop(&mut self) {
        self.free_numeric();
        // SAFETY: the analysis is not used after this.
        unsafe { sys::klu_l_free_symbolic(&raw mut self.symbolic, &raw mut self.common) };
    }
}

/// The pattern as KLU's parameters, which are not `const` but only read.
fn indices(pattern: &Pattern) -> (*mut i64, *mut i64) {
    (
        pattern.column_starts().as_ptr().cast_mut(),
        pattern.rows().as_ptr().cast_mut(),
    )
}
