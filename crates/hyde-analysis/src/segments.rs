//! The unknowns as whole arrays and the scalars around them: each array is cut where its equations are cut.
//!
//! ```text
//! for i in 1..23: … der(w[i]) …;  … der(w[0]) …;  … der(w[24]) …        w falls into w[0], w[1..23], w[24]
//! ```
//! An equation over a range can determine an array through one of its accesses; the accesses are chosen so that the
//! pieces tile the array without gap or overlap: first what an equation is written for, then equations of the array's own
//! component, then the access with the largest factor (the diagonal of a mass matrix). What cannot be tiled is
//! reported by the caller, who unrolls it or gives up (F3).

use crate::cells::Cells;
use crate::system::System;
use hyde_ir::{Expr, ExprId, Index, Range, VarId};
use std::collections::{BTreeMap, BTreeSet};

/// An unknown of the matching: consecutive elements of a variable; a state's unknown is its derivative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Segment {
    pub(crate) var: VarId,
    pub(crate) first: usize,
    pub(crate) last: usize,
    pub(crate) state: bool,
}

impl Segment {
    pub(crate) fn len(self) -> usize {
        self.last - self.first + 1
    }

    pub(crate) fn overlaps(self, first: usize, last: usize) -> bool {
        self.first <= last && first <= self.last
    }
}

/// A way in which an equation could determine a piece of an array.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    first: usize,
    last: usize,
    equation: usize,
    derivative: bool,
    /// Least first: not what the equation is written for, of another component, rank of its factor in the equation.
    cost: (bool, bool, usize),
}

/// The segments of all variables that remain; `Err` with the arrays that cannot be tiled.
pub(crate) fn segments(system: &mut System) -> Result<Vec<Segment>, Vec<VarId>> {
    let used = used_variables(system);
    let states = state_cells(system);
    let candidates = candidates(system);
    let mut found = Vec::new();
    let mut untiled = Vec::new();
    for (id, variable) in system.flat.variables.enumerate() {
        let eliminated = variable.len.is_none() && system.aliases.contains_key(&(id, 0));
        if !system.is_continuous(id)
            || eliminated
            || (!used.contains(&id) && variable.len.is_none() && !must_be_solved(system, id))
        {
            continue;
        }
        let is_state = |element: usize| states.contains(&(id, element));
        if variable.len.is_none() {
            found.push(Segment {
                var: id,
                first: 0,
                last: 0,
                state: is_state(0),
            });
            continue;
        }
        let empty = Vec::new();
        let mut list = candidates.get(&id).unwrap_or(&empty).clone();
        list.sort_by_key(|candidate| (candidate.first, candidate.cost));
        match tile(&list, 0, variable.size(), &mut Vec::new()) {
            Some(pieces) => found.extend(pieces.into_iter().map(|(first, last)| Segment {
                var: id,
                first,
                last,
                state: is_state(first),
            })),
            None => untiled.push(id),
        }
    }
    if untiled.is_empty() {
        Ok(found)
    } else {
        Err(untiled)
    }
}

/// A variable that nothing reads still needs a value: its declaration promised a result column.
fn must_be_solved(system: &System, id: VarId) -> bool {
    system.flat.variables[id].len.is_none()
}

/// Every variable that an equation mentions.
fn used_variables(system: &System) -> BTreeSet<VarId> {
    let equations = system.equations.iter().flat_map(|e| [e.lhs, e.rhs]);
    let branches = system
        .slots
        .iter()
        .flat_map(|slot| &slot.branches)
        .flat_map(|b| [b.lhs, b.rhs]);
    let roots: Vec<_> = equations.chain(branches).collect();
    let leaves = system
        .flat
        .exprs
        .below(&roots)
        .into_iter()
        .map(|id| system.flat.exprs[id]);
    leaves
        .filter_map(|expr| {
            if let Expr::Var(var, _) | Expr::Der(var, _) = expr {
                Some(var)
            } else {
                None
            }
        })
        .collect()
}

/// The elements whose derivative appears.
pub(crate) fn state_cells(system: &System) -> Cells {
    let mut found = Cells::default();
    let equations = system.equations.iter().map(|e| (e.range, [e.lhs, e.rhs]));
    let branches = system
        .slots
        .iter()
        .flat_map(|slot| &slot.branches)
        .map(|b| (Range::SCALAR, [b.lhs, b.rhs]));
    for (range, sides) in equations.chain(branches) {
        for id in system.flat.exprs.below(&sides) {
            if let Expr::Der(var, index) = system.flat.exprs[id] {
                let (first, last) = System::interval(index, range);
                found.insert(var, first, last);
            }
        }
    }
    found
}

fn candidates(system: &mut System) -> BTreeMap<VarId, Vec<Candidate>> {
    let declared = system.declared_values();
    let mut found: BTreeMap<VarId, Vec<Candidate>> = BTreeMap::new();
    for number in 0..system.equations.len() {
        let (range, lhs, rhs) = {
            let equation = &system.equations[number];
            (equation.range, equation.lhs, equation.rhs)
        };
        let scalar = range == Range::SCALAR;
        let mut accesses: Vec<(VarId, Index, bool)> = Vec::new();
        for id in system.flat.exprs.below(&[lhs, rhs]) {
            let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
                continue;
            };
            let array = system.flat.variables[var].len.is_some() && system.is_continuous(var);
            if array && (index.stride.abs() != 1) == scalar {
                accesses.push((var, index, derivative));
            }
        }
        if accesses.is_empty() {
            continue;
        }
        let factors = factors(system, &declared, lhs, rhs);
        for &(var, index, derivative) in &accesses {
            let factor =
                |access: &(VarId, Index, bool)| factors.get(access).copied().unwrap_or(0.0);
            let own = factor(&(var, index, derivative));
            let rank = accesses
                .iter()
                .filter(|other| other.0 == var && other.2 == derivative && factor(other) > own)
                .count();
            let named = matches!(system.flat.exprs[lhs], Expr::Var(v, i) if v == var && i == index);
            let foreign = system.equations[number].origin.instance
                != system.flat.variables[var].origin.instance;
            let (first, last) = System::interval(index, range);
            let candidate = Candidate {
                first,
                last,
                equation: number,
                derivative,
                cost: (!named, foreign, rank),
            };
            found.entry(var).or_default().push(candidate);
        }
    }
    // A state's value is known: only its derivative can be determined.
    let states = state_cells(system);
    for (&var, list) in &mut found {
        list.retain(|candidate| candidate.derivative || !states.contains(&(var, candidate.first)));
    }
    found
}

/// Magnitudes of the factors of an equation's accesses, with declared parameters; 1 where they vary.
fn factors(
    system: &mut System,
    declared: &[Vec<f64>],
    lhs: ExprId,
    rhs: ExprId,
) -> BTreeMap<(VarId, Index, bool), f64> {
    let residual = system.flat.exprs.minus(lhs, rhs);
    let gradient = system.flat.exprs.gradient(residual, |expr| {
        matches!(expr, Expr::Var(..) | Expr::Der(..))
    });
    let mut found = BTreeMap::new();
    for (leaf, factor) in gradient {
        let (Expr::Var(var, index) | Expr::Der(var, index)) = leaf else {
            continue;
        };
        let magnitude = system.value_with(declared, factor).map_or(1.0, f64::abs);
        found.insert((var, index, matches!(leaf, Expr::Der(..))), magnitude);
    }
    found
}

/// Pieces that tile `at..size`, one an equation.
fn tile(
    list: &[Candidate],
    at: usize,
    size: usize,
    used: &mut Vec<usize>,
) -> Option<Vec<(usize, usize)>> {
    if at == size {
        return Some(Vec::new());
    }
    for candidate in list.iter().filter(|candidate| candidate.first == at) {
        if used.contains(&candidate.equation) || candidate.last >= size {
            continue;
        }
        used.push(candidate.equation);
        if let Some(mut rest) = tile(list, candidate.last + 1, size, used) {
            rest.insert(0, (candidate.first, candidate.last));
            return Some(rest);
        }
        used.pop();
    }
    None
}
