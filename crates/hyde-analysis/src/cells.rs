//! [`Cells`]: a set of elements of variables, kept as intervals, so that an array of any length costs one entry.

use crate::system::Cell;
use hyde_ir::VarId;
use std::collections::BTreeMap;

/// A set of cells.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cells {
    intervals: BTreeMap<VarId, Vec<(usize, usize)>>,
}

impl Cells {
    /// Adds the elements from `first` to `last`.
    pub(crate) fn insert(&mut self, var: VarId, first: usize, last: usize) {
        let list = self.intervals.entry(var).or_default();
        if !list.iter().any(|&(from, to)| from <= first && last <= to) {
            list.push((first, last));
        }
    }

    /// Whether a cell is in it.
    pub(crate) fn contains(&self, cell: &Cell) -> bool {
        self.intervals.get(&cell.0).is_some_and(|list| {
            list.iter()
                .any(|&(first, last)| (first..=last).contains(&cell.1))
        })
    }
}
