//! The nodes below an expression, each once.

use crate::{Expr, ExprArena, ExprId};
use rustc_hash::FxHashSet;

/// Most expressions have no more nodes, and a short list is searched sooner than a table is made.
const SHORT: usize = 24;

impl ExprArena {
    /// All nodes below and including `root`, children before parents.
    #[must_use]
    pub fn below(&self, roots: &[ExprId]) -> Vec<ExprId> {
        let mut found = Vec::with_capacity(SHORT);
        self.walk(roots, &mut found, |_| false, |_| false);
        found.sort_unstable();
        found
    }

    /// The same without the nodes that are known, nor what is below these alone.
    #[must_use]
    pub fn below_new(&self, root: ExprId, known: impl Fn(ExprId) -> bool) -> Vec<ExprId> {
        let mut found = Vec::with_capacity(SHORT);
        self.walk(&[root], &mut found, known, |_| false);
        found.sort_unstable();
        found
    }

    /// Whether some node below and including `root` satisfies `test`.
    #[must_use]
    pub fn any(&self, root: ExprId, test: impl Fn(Expr) -> bool) -> bool {
        self.walk(&[root], &mut Vec::new(), |_| false, |id| test(self[id]))
    }

    /// Visits each node below and including the roots once, but for those that are known, until one ends it; whether one did.
    /// What was visited is `found`.
    fn walk(
        &self,
        roots: &[ExprId],
        found: &mut Vec<ExprId>,
        known: impl Fn(ExprId) -> bool,
        ends: impl Fn(ExprId) -> bool,
    ) -> bool {
        let mut stack: Vec<ExprId> = Vec::with_capacity(SHORT);
        stack.extend_from_slice(roots);
        let mut seen = FxHashSet::default();
        while let Some(id) = stack.pop() {
            if known(id) {
                continue;
            }
            let new = if found.len() < SHORT {
                !found.contains(&id)
            } else {
                if seen.is_empty() {
                    seen.extend(found.iter().copied());
                }
                seen.insert(id)
            };
            if new {
                if ends(id) {
                    return true;
                }
                found.push(id);
                self[id].for_each_child(|child| stack.push(child));
            }
        }
        false
    }

    /// Whether an expression is made of parameters and numbers alone.
    #[must_use]
    pub fn is_parametric(&self, root: ExprId) -> bool {
        !self.any(root, |expr| !expr.is_parametric())
    }
}
