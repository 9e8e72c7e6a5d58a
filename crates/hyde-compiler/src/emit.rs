//! Each stage's result as text, for `hyde emit` and the snapshots.

use crate::pipeline::{Request, analyze, flatten};
use hyde_diag::Diagnostics;

/// A stage whose result can be printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The tree, as source text.
    Ast,
    /// The flat model.
    Flat,
    /// What became of every variable and in which order the rest is solved.
    Structure,
    /// The system in full.
    Dae,
    /// Cranelift IR, the same on every machine.
    Clif,
    /// Assembly of this machine.
    Asm,
}

/// The result of a stage.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn emit(request: &Request<'_>, stage: Stage, diagnostics: &mut Diagnostics) -> Option<String> {
    if stage == Stage::Ast {
        let (_, tree) = request.file.files.first()?;
        return (!diagnostics.has_errors()).then(|| hyde_syntax::format(tree));
    }
    if stage == Stage::Flat {
        let flat = flatten(request, diagnostics)?;
        return Some(hyde_ir::print::print_flat(&flat, request.sources));
    }
    let dae = analyze(request, diagnostics)?;
    Some(match stage {
        Stage::Ast | Stage::Flat | Stage::Structure => {
            hyde_ir::print::print_structure(&dae, request.sources)
        }
        Stage::Dae => hyde_ir::print::print_dae(&dae, request.sources),
        Stage::Clif => hyde_jit::emit_clif(&dae),
        Stage::Asm => hyde_jit::emit_assembly(&dae),
    })
}

/// The kernels as C, with some of the outputs, by number.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn kernels_as_c(
    request: &Request<'_>,
    outputs: &[usize],
    diagnostics: &mut Diagnostics,
) -> Option<String> {
    let dae = analyze(request, diagnostics)?;
    Some(hyde_jit::emit_c(&dae, outputs))
}
