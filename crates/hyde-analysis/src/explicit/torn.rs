//! [`tear`]: of each loop of definitions one variable after the other goes back into the vector, until no loop is left.
//!
//! ```text
//! a = (q - f)/m;  f = J*a - drive        a is torn where m is small: of f the solver knows no more than its tolerance,
//!                                        and 1/m would make it an error of a
//! ```

use super::Explicit;
use crate::graph::strongly_connected_components;
use crate::matching::{Matched, name};
use crate::segments::Segment;
use crate::system::System;
use hyde_ir::{Expr, ExprId, VarId};
use rustc_hash::{FxHashMap, FxHashSet};

/// A definition is steeper than another if it multiplies what it reads by so many times more.
const STEEPER: f64 = 1e3;

/// Puts variables into the vector until the definitions of the others have an order. `edges` are what each definition reads;
/// those of what is torn, and to it, are taken out.
pub(super) fn tear(
    system: &mut System,
    (matched, explicit): (&Matched, &[Option<Explicit>]),
    declared: &[Vec<f64>],
    edges: &mut [Vec<usize>],
    in_vector: &mut [bool],
) {
    let mut loops = loops_of(edges);
    let mut steepness = FxHashMap::default();
    for component in &loops {
        let variables = component.iter().map(|&node| matched.unknowns[node].var);
        let variables: FxHashSet<VarId> = variables.collect();
        for &node in component {
            if let Some(definition) = &explicit[node] {
                let own = steepness_of(system, declared, definition.value, &variables);
                steepness.insert(node, own);
            }
        }
    }
    // Without an edge no new loop begins: only what was one is looked at again.
    while !loops.is_empty() {
        for component in &loops {
            let Some(torn) = best(system, matched, edges, &steepness, component) else {
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

/// By how many powers of [`STEEPER`] a definition multiplies what it reads of a loop, with the parameters as declared.
fn steepness_of(
    system: &mut System,
    declared: &[Vec<f64>],
    value: ExprId,
    of_loop: &FxHashSet<VarId>,
) -> i32 {
    let read = |expr| matches!(expr, Expr::Var(var, _) if of_loop.contains(&var));
    let gradient = system.exprs().gradient(value, read);
    let factors = gradient.iter();
    let factors = factors.filter_map(|(_, factor)| system.value_with(declared, *factor));
    let most = factors.fold(1.0, |most: f64, factor| most.max(factor.abs()));
    #[allow(clippy::cast_possible_truncation, reason = "at most 102")]
    let powers = (most.ln() / STEEPER.ln()).floor() as i32;
    powers
}

/// Of a loop the variable that most definitions of it read; a scalar before an array, one with a guess before others, one
/// with a steep definition before those with flat ones.
fn best(
    system: &System,
    matched: &Matched,
    edges: &[Vec<usize>],
    steepness: &FxHashMap<usize, i32>,
    component: &[usize],
) -> Option<usize> {
    let mut readers: FxHashMap<usize, usize> = FxHashMap::default();
    for &read in component.iter().flat_map(|&node| &edges[node]) {
        *readers.entry(read).or_default() += 1;
    }
    component.iter().copied().max_by_key(|&node| {
        (
            matched.unknowns[node].len() == 1,
            is_guessed(system, matched.unknowns[node]),
            steepness.get(&node).copied(),
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
