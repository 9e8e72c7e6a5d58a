//! From a [`hyde_ir::Dae`] to a [`hyde_program::Program`]: tables from the DAE, numbers from machine code or by
//! interpretation.
//!
//! Every kernel is a `Routine`: a list of steps, each an expression over a range of its counter with a place to
//! write to. The interpreter (`interpret`) runs it node by node; `lower` turns it into a Cranelift function: scalars
//! as straight-line code with common subexpressions shared, ranges as loops over two elements at a time; a long routine
//! becomes several functions (`parts`). Both use the same functions for everything that is no single instruction
//! (`host`), so they agree to the last bit.
//!
//! Machine code is made at the first use of a kernel and freed with the last program that holds it.

mod bending;
mod c;
mod compiled;
mod delays;
mod emit;
mod figures;
mod flows;
mod host;
mod interpret;
mod known;
mod ledger;
mod load;
mod lower;
mod native;
mod parts;
mod routine;
mod some_rows;
mod still;
mod tables;
mod vector;
mod wanted;

pub use c::emit_c;
pub use compiled::Backend;
pub use emit::{emit_assembly, emit_clif, instruction_count};

use hyde_ir::Dae;
use hyde_program::Program;

/// Makes a DAE executable.
#[must_use]
pub fn compile(dae: Dae, backend: Backend) -> Program {
    let kernels = compiled::Compiled::new(dae, backend);
    tables::program(kernels)
}
