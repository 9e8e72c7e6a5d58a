//! [`tear`]: of each loop of definitions one variable after the other goes back into the vector, until no loop is left.

use crate::graph::strongly_connected_components;
use crate::matching::{Matched, name};
use crate::segments::Segment;
use crate::system::System;
use hyde_ir::ExprId;
use std::collections::HashMap;

/// Puts variables into the vector until the definitions of the others have an order. `edges` are what each definition reads;
/// those of what is torn, and to it, are taken out.
pub(super) fn tear(
    system: &mut System,
    matched: &Matched,
    edges: &mut [Vec<usize>],
    in_vector: &mut [bool],
) {
    let mut loops = loops_of(edges);
    // Without an edge no new loop begins: only what was one is looked at again.
    while !loops.is_empty() {
        for component in &loops {
            let Some(torn) = most_read(system, matched, edges, component) else {
                continue;
            };
            // An array stays whole.
            for number in pieces(matched, torn) {
                in_vector[number] = true;
            }
            system.notes.push(format!(
                "`{}` is torn from a loop of {} equations",
                name(system, matched.unknowns[torn]),
                component.len()
            ));
        }
        let within = std::mem::take(&mut loops);
        for component in &within {
            loops.extend(loops_within(edges, in_vector, component));
        }
    }
    for (number, read) in edges.iter_mut().enumerate() {
        match in_vector[number] {
            true => read.clear(),
            false => read.retain(|&other| !in_vector[other]),
        }
    }
}

/// Of a loop the variable that most definitions of it read; a scalar before an array, one with a guess before others.
fn most_read(
    system: &System,
    matched: &Matched,
    edges: &[Vec<usize>],
    component: &[usize],
) -> Option<usize> {
    let mut readers: HashMap<usize, usize> = HashMap::new();
    for &read in component.iter().flat_map(|&node| &edges[node]) {
        *readers.entry(read).or_default() += 1;
    }
    component.iter().copied().max_by_key(|&node| {
        (
            matched.unknowns[node].len() == 1,
            is_guessed(system, matched.unknowns[node]),
            readers.get(&node).copied(),
            usize::MAX - node,
        )
    })
}

/// The numbers of all pieces of the array that a piece is one of.
fn pieces(matched: &Matched, number: usize) -> std::ops::Range<usize> {
    let unknowns = &matched.unknowns;
    let var = unknowns[number].var;
    let first = unknowns.partition_point(|unknown| unknown.var < var);
    let behind = unknowns.partition_point(|unknown| unknown.var <= var);
    first..behind
}

/// The loops of a graph: its components with more than one node, and nodes that read themselves.
fn loops_of(edges: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let mut components = strongly_connected_components(edges);
    components.retain(|component| {
        component.len() > 1 || component.iter().any(|&n| edges[n].contains(&n))
    });
    components
}

/// The loops that are left of one, without what is in the vector.
fn loops_within(edges: &[Vec<usize>], in_vector: &[bool], component: &[usize]) -> Vec<Vec<usize>> {
    let mut nodes: Vec<usize> = component.to_vec();
    nodes.retain(|&node| !in_vector[node]);
    nodes.sort_unstable();
    let own = |&node: &usize| -> Vec<usize> {
        let read = edges[node].iter();
        read.filter_map(|other| nodes.binary_search(other).ok())
            .collect()
    };
    let own: Vec<Vec<usize>> = nodes.iter().map(own).collect();
    let mut loops = loops_of(&own);
    for node in loops.iter_mut().flatten() {
        *node = nodes[*node];
    }
    loops
}

/// Whether the model says where to look for a variable: a solution is looked for from the values of what is in the vector.
fn is_guessed(system: &System, unknown: Segment) -> bool {
    let starts = system.starts.get(&(unknown.var, unknown.first));
    let zero = |value: ExprId| system.flat.exprs.as_constant(value) == Some(0.0);
    starts.is_some_and(|list| list.iter().any(|(value, ..)| !zero(*value)))
}
