//! [`take`]: the states that initial equations and constraints between states take, by what these read.

use crate::graph::Bipartite;
use crate::system::System;
use hyde_diag::Origin;
use hyde_ir::dae::{Dae, Space};
use hyde_ir::{Expr, ExprId, Range, VarId};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::RangeInclusive;

/// States that may yield, in the order in which they do.
pub(super) struct Free {
    /// By their numbers.
    blocks: Vec<Block>,
    /// By their positions.
    placed: Vec<Block>,
}

/// Consecutive states: the number of the first among all that may yield, its position in the vector, and how many they are.
#[derive(Clone, Copy)]
struct Block {
    number: usize,
    position: usize,
    len: usize,
}

impl Free {
    /// Those of consecutive positions, each the first and how many.
    pub(super) fn of(states: impl Iterator<Item = (usize, usize)>) -> Self {
        let mut number = 0;
        let blocks = states.map(|(position, len)| {
            let block = Block {
                number,
                position,
                len,
            };
            number += block.len;
            block
        });
        let blocks: Vec<Block> = blocks.collect();
        let mut placed = blocks.clone();
        placed.sort_by_key(|block| block.position);
        Self { blocks, placed }
    }

    pub(super) fn len(&self) -> usize {
        let last = self.blocks.last();
        last.map_or(0, |last| last.number + last.len)
    }

    /// The position of one in the vector.
    pub(super) fn position(&self, number: usize) -> usize {
        let after = self.blocks.partition_point(|block| block.number <= number);
        let block = &self.blocks[after - 1];
        block.position + number - block.number
    }

    /// The numbers of those at some positions.
    fn at(&self, positions: RangeInclusive<usize>) -> impl Iterator<Item = usize> {
        let (start, end) = (*positions.start(), *positions.end());
        let before = |block: &Block| block.position + block.len <= start;
        let first = self.placed.partition_point(before);
        let within = self.placed[first..].iter();
        let within = within.take_while(move |block| block.position <= end);
        within.flat_map(move |block| {
            let first = block.position.max(start);
            let behind = (block.position + block.len).min(end + 1);
            (first..behind).map(|position| block.number + position - block.position)
        })
    }
}

/// The numbers of the free states that constraints between states take, and initial equations, each of those it reads itself or
/// through what defines other variables.
pub(super) fn take(
    dae: &Dae,
    equations: &[(Range, ExprId, Origin)],
    free: &Free,
) -> BTreeSet<usize> {
    let mut edges = Vec::new();
    for selection in &dae.selections {
        let candidates = selection.candidates.iter();
        let mut own: Vec<usize> = candidates
            .flat_map(|&position| free.at(position..=position))
            .collect();
        own.sort_unstable();
        edges.extend(std::iter::repeat_n(own, selection.constraints.len()));
    }
    let definitions = definitions(dae);
    for (range, value, _) in equations {
        edges.extend(read(dae, &definitions, (*range, *value), free));
    }
    // Of an array with many elements few are read.
    let read: BTreeSet<usize> = edges.iter().flatten().copied().collect();
    let read: Vec<usize> = read.into_iter().collect();
    for number in edges.iter_mut().flatten() {
        *number = read.partition_point(|own| own < number);
    }
    let graph = Bipartite {
        edges,
        n_right: read.len(),
    };
    let matching = graph.maximum_matching();
    let taken = read.into_iter().zip(matching.of_right);
    taken
        .filter_map(|(number, by)| by.map(|_| number))
        .collect()
}

/// What defines each variable: its definitions, and the equations of an algebraic unknown.
fn definitions(dae: &Dae) -> BTreeMap<VarId, Vec<ExprId>> {
    let mut definitions: BTreeMap<VarId, Vec<ExprId>> = BTreeMap::new();
    let explicit = dae.definitions.iter().map(|own| (own.var, own.value));
    let implicit = dae.residuals.iter().filter_map(|residual| {
        let unknown = &dae.unknowns[residual.unknown];
        (!unknown.differential).then_some((unknown.var, residual.value))
    });
    for (var, value) in explicit.chain(implicit) {
        definitions.entry(var).or_default().push(value);
    }
    definitions
}

/// The numbers of the free states that each value of an initial equation reads: `x[i] = 1` reads one each. What it reads through
/// other variables all values read.
fn read(
    dae: &Dae,
    definitions: &BTreeMap<VarId, Vec<ExprId>>,
    (range, value): (Range, ExprId),
    free: &Free,
) -> Vec<Vec<usize>> {
    let (mut each, mut all) = (Vec::new(), Vec::new());
    let mut pending = vec![value];
    let mut seen = BTreeSet::new();
    while let Some(root) = pending.pop() {
        for id in dae.exprs.below(&[root]) {
            let (Expr::Var(var, index) | Expr::Der(var, index)) = dae.exprs[id] else {
                continue;
            };
            if seen.insert(var) {
                pending.extend(definitions.get(&var).into_iter().flatten());
            }
            let place = dae.places[var].filter(|place| place.space == Space::Unknown);
            let Some(place) = place else { continue };
            if root == value && index.stride != 0 {
                each.push((place.base, index));
            } else {
                let (first, last) = System::interval(index, range);
                all.extend(free.at(place.base + first..=place.base + last));
            }
        }
    }
    let of_value = |counter: i32| {
        let mut own = all.clone();
        for &(base, index) in &each {
            let (element, _) = System::interval(
                index,
                Range {
                    first: counter,
                    last: counter,
                },
            );
            own.extend(free.at(base + element..=base + element));
        }
        // What stands first in the list is taken first.
        own.sort_unstable();
        own.dedup();
        own
    };
    range.iter().map(of_value).collect()
}
