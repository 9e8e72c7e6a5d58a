//! [`Lanes`]: a vector of whole groups of four values, which the processor works on at once.
//!
//! What fills up the last group is zero, so a pass has no rest to treat, and a vector of a few unknowns is a group or two.

use std::ops::{Deref, DerefMut};

/// Values of a group.
pub(super) const LANES: usize = 4;

/// Values that are worked on at once. A pass takes a copy of each group, and writes what becomes of it when it is done: then
/// the compiler sees that nothing else changes meanwhile.
pub(super) type Group = [f64; LANES];

/// A vector; seen as a slice it has its own length.
#[derive(Clone)]
pub(super) struct Lanes {
    n: usize,
    values: Vec<f64>,
}

impl Lanes {
    /// `n` values, all zero.
    pub(super) fn zeros(n: usize) -> Self {
        Self {
            n,
            values: vec![0.0; n.next_multiple_of(LANES)],
        }
    }

    /// All groups; what fills up the last is zero, and must remain so.
    #[inline(always)]
    pub(super) fn groups(&self) -> &[Group] {
        self.values.as_chunks().0
    }

    /// The same, to write to.
    #[inline(always)]
    pub(super) fn groups_mut(&mut self) -> &mut [Group] {
        self.values.as_chunks_mut().0
    }

    /// All values of whole groups; what fills up the last is zero, and must remain so.
    #[inline(always)]
    pub(super) fn whole(&self) -> &[f64] {
        &self.values
    }

    /// The same, to write to.
    #[inline(always)]
    pub(super) fn whole_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }
}

impl From<&[f64]> for Lanes {
    fn from(values: &[f64]) -> Self {
        let mut lanes = Self::zeros(values.len());
        lanes.copy_from_slice(values);
        lanes
    }
}

impl Deref for Lanes {
    type Target = [f64];

    #[inline]
    fn deref(&self) -> &[f64] {
        &self.values[..self.n]
    }
}

impl DerefMut for Lanes {
    #[inline]
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[..self.n]
    }
}
