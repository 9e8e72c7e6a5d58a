//! [`Parts`]: a long routine as several functions, for the time to allocate registers grows faster than a function.
//!
//! ```text
//! rows 0 … 120     read weight(xn, 0), …      made in the first function, and kept in memory
//! rows 121 … 260   read weight(xn, 0), …      loaded in the second
//! ```
//! A number that a later part reads is computed once. Leaves and truths are made again in each part.

use crate::routine::{Routine, Slot};
use crate::wanted::{Wanted, children, moving};
use hyde_ir::{Dae, ExprId};
use rustc_hash::{FxHashMap, FxHashSet};
use std::ops::Range;

/// So many nodes are made in one function, and those of the step that comes to it.
const NODES: usize = 3000;

/// A routine in parts.
pub(crate) struct Parts {
    /// The steps of each part.
    pub(crate) steps: Vec<Range<usize>>,
    /// The place of each number that is kept for later parts.
    pub(crate) kept: FxHashMap<ExprId, i32>,
}

impl Parts {
    /// Looks at all steps in their order. The assignments of a tick read each other, and stay one part.
    pub(crate) fn of(dae: &Dae, routine: &Routine) -> Self {
        let all = 0..routine.steps.len();
        let moves = moving(dae, routine, all.clone());
        let mut parts = Self {
            steps: vec![all],
            kept: FxHashMap::default(),
        };
        if moves.len() < NODES || routine.tick.is_some() {
            return parts;
        }
        let mut made = FxHashMap::default();
        let (mut first, mut count) = (0, 0);
        parts.steps.clear();
        for (number, step) in routine.steps.iter().enumerate() {
            if count >= NODES {
                parts.steps.push(first..number);
                (first, count) = (number, 0);
            }
            let part = parts.steps.len();
            let mut in_loop = FxHashSet::default();
            let mut open = vec![(step.value, Wanted::Number)];
            while let Some((id, wanted)) = open.pop() {
                if moves[&id] {
                    if !in_loop.insert((id, wanted)) {
                        continue;
                    }
                } else {
                    let before = made.insert((id, wanted), part);
                    let is_leaf = routine.leaf(dae, dae.exprs[id]).is_some();
                    match before {
                        Some(before) if before == part => continue,
                        Some(_) if wanted == Wanted::Number && !is_leaf => {
                            let next = i32::try_from(parts.kept.len()).unwrap_or(i32::MAX);
                            parts.kept.entry(id).or_insert(next);
                            continue;
                        }
                        Some(_) | None => count += 1,
                    }
                }
                children(dae, id, wanted, |child, wanted| open.push((child, wanted)));
            }
        }
        parts.steps.push(first..routine.steps.len());
        parts
    }

    /// Where the frame has the address of what is kept: behind those of the slots.
    pub(crate) const OFFSET: i32 = 8 * (1 + Slot::ALL.len() as i32);
}
