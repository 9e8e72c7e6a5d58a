//! Arrays with their middle left out: what holds of a field of 20 cells holds of one of 100 000.
//!
//! All that an equation says of an array is said at some places: the ends of its ranges, and elements that are named. Between
//! two such places the equations are the same from cell to cell, and a stretch longer than the equations look is shortened.

use crate::system::System;
use hyde_ir::{Index, Range, VarId};
use std::collections::{BTreeMap, BTreeSet};

/// How much of a stretch remains, beside twice what the equations look ahead.
const REMAINS: i32 = 8;

/// Where the elements of arrays go.
pub(crate) struct Shortened {
    /// The group of an array: those that a range goes over together.
    group: BTreeMap<VarId, usize>,
    /// Places of each group with their new position, ascending.
    places: Vec<Vec<(i32, i32)>>,
}

impl Shortened {
    /// Looks at all equations; `None` where an equation over a range skips elements.
    pub(crate) fn new(system: &System) -> Option<Self> {
        let mut group: BTreeMap<VarId, usize> = BTreeMap::new();
        let arrays = system.flat.variables.enumerate();
        for (number, (var, _)) in arrays
            .filter(|(_, variable)| variable.len.is_some())
            .enumerate()
        {
            group.insert(var, number);
        }
        let accesses = accesses(system);
        let mut ahead = 0;
        for (range, list) in &accesses {
            let mut moving = list.iter().filter(|(_, index)| index.stride != 0);
            if moving.clone().any(|(_, index)| index.stride != 1) {
                return None;
            }
            let first = moving.next().and_then(|(var, _)| group.get(var).copied());
            if first.is_none() && range.len() > 64 {
                return None;
            }
            for (var, index) in list.iter().filter(|(_, index)| index.stride != 0) {
                ahead = ahead.max(index.offset.abs());
                let (Some(from), Some(to)) = (group.get(var).copied(), first) else {
                    return None;
                };
                for number in group.values_mut().filter(|number| **number == from) {
                    *number = to;
                }
            }
        }
        let mut named: Vec<BTreeSet<i32>> = vec![BTreeSet::new(); group.len()];
        for (&var, &number) in &group {
            let last = i32::try_from(system.flat.variables[var].size()).ok()? - 1;
            named[number].extend([0, last]);
        }
        for (range, list) in &accesses {
            for (var, index) in list {
                if let Some(&number) = group.get(var) {
                    named[number].extend([index.at(range.first), index.at(range.last)]);
                    if index.stride != 0 {
                        named[number].extend([range.first, range.last]);
                    }
                }
            }
        }
        let longest = REMAINS + 2 * ahead;
        let places = named
            .into_iter()
            .map(|set| {
                let mut list: Vec<(i32, i32)> = Vec::new();
                for place in set {
                    let at = list
                        .last()
                        .map_or(place, |&(before, at)| at + (place - before).min(longest));
                    list.push((place, at));
                }
                list
            })
            .collect();
        Some(Self { group, places })
    }

    /// The new position of a place that an equation names.
    fn position(&self, group: usize, place: i32) -> i32 {
        let list = &self.places[group];
        match list.binary_search_by_key(&place, |&(place, _)| place) {
            Ok(found) => list[found].1,
            Err(_) => place,
        }
    }

    /// The new position of an element that is named.
    pub(crate) fn element(&self, var: VarId, element: i32) -> i32 {
        self.group
            .get(&var)
            .map_or(element, |&group| self.position(group, element))
    }

    /// Number of elements that remain of an array.
    pub(crate) fn size(&self, system: &System, var: VarId) -> i32 {
        let size = i32::try_from(system.flat.variables[var].size()).unwrap_or(i32::MAX);
        self.element(var, size - 1) - self.element(var, 0) + 1
    }

    /// The range of an equation as it remains.
    pub(crate) fn range(&self, range: Range, accesses: &[(VarId, Index)]) -> Range {
        let moving = accesses.iter().find(|(_, index)| index.stride != 0);
        match moving.and_then(|(var, _)| self.group.get(var)) {
            Some(&group) => Range {
                first: self.position(group, range.first),
                last: self.position(group, range.last),
            },
            None => range,
        }
    }
}

/// The variables that each continuous equation reads, with its range.
fn accesses(system: &System) -> Vec<(Range, Vec<(VarId, Index)>)> {
    let equations = system.equations.iter().map(|e| (e.range, [e.lhs, e.rhs]));
    let branches = system.slots.iter().flat_map(|slot| &slot.branches);
    let branches = branches.map(|b| (Range::SCALAR, [b.lhs, b.rhs]));
    equations
        .chain(branches)
        .map(|(range, sides)| {
            let below = system.flat.exprs.below(&sides).into_iter();
            let list = below.filter_map(|id| system.flat.exprs[id].access());
            (range, list.map(|(var, index, _)| (var, index)).collect())
        })
        .collect()
}
