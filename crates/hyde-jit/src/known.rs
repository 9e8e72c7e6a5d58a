//! [`Known`]: the nodes that a function has code of by now.

use crate::wanted::Wanted;
use cranelift_codegen::ir;
use hyde_ir::ExprId;
use rustc_hash::FxHashMap;

/// Nodes that have been lowered: as a number, and as a truth.
#[derive(Clone, Default)]
pub(crate) struct Known {
    numbers: FxHashMap<ExprId, ir::Value>,
    truths: FxHashMap<ExprId, ir::Value>,
}

impl Known {
    pub(crate) fn get(&self, id: ExprId, wanted: Wanted) -> Option<ir::Value> {
        match wanted {
            Wanted::Number => self.numbers.get(&id).copied(),
            Wanted::Truth => self.truths.get(&id).copied(),
        }
    }

    pub(crate) fn insert(&mut self, id: ExprId, wanted: Wanted, value: ir::Value) {
        match wanted {
            Wanted::Number => self.numbers.insert(id, value),
            Wanted::Truth => self.truths.insert(id, value),
        };
    }

    pub(crate) fn remove(&mut self, id: ExprId) {
        self.numbers.remove(&id);
        self.truths.remove(&id);
    }
}
