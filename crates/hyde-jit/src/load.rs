//! What Cranelift may assume of a load.

use crate::routine::Slot;
use cranelift_codegen::ir::MemFlagsData;

/// Of what a kernel reads but never writes: it may be loaded anywhere.
pub(crate) fn unwritten() -> MemFlagsData {
    MemFlagsData::trusted().with_readonly().with_can_move()
}

/// Of a slot.
pub(crate) fn flags(slot: Slot) -> MemFlagsData {
    match slot {
        Slot::Unknown | Slot::Derivative | Slot::Memory | Slot::Input | Slot::Parameter => {
            unwritten()
        }
        Slot::Work | Slot::Out => MemFlagsData::trusted(),
    }
}
