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

    /// Whether all elements from `first` to `last` are in it.
    pub(crate) fn contains_all(&self, var: VarId, first: usize, last: usize) -> bool {
        let mut at = first;
        let list = self.intervals.get(&var).map_or(&[][..], Vec::as_slice);
        while at <= last {
            let ends = list.iter().filter(|(from, to)| (*from..=*to).contains(&at));
            match ends.map(|(_, to)| *to).max() {
                Some(to) => at = to + 1,
                None => return false,
            }
        }
        true
    }

    /// Whether a cell is in it.
    pub(crate) fn contains(&self, cell: &Cell) -> bool {
        self.intervals.get(&cell.0).is_some_and(|list| {
            list.iter()
                .any(|&(first, last)| (first..=last).contains(&cell.1))
        })
    }
}
