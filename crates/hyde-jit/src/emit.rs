//! The code of every kernel as text: Cranelift IR, the same on every machine, and the host's assembly.

use crate::compiled::routines;
use crate::lower;
use crate::native;
use crate::parts::Parts;
use crate::routine::{Routine, Slot};
use cranelift_codegen::Context;
use cranelift_codegen::control::ControlPlane;
use cranelift_codegen::ir::{
    AbiParam, ExtFuncData, ExternalName, Function, Signature, UserFuncName, types,
};
use cranelift_codegen::isa::TargetFrontendConfig;
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use hyde_ir::{Dae, ExprId};
use rustc_hash::FxHashSet;
use std::fmt::Write as _;
use std::ops::Range;

/// The Cranelift IR of every kernel. It depends on the model alone, not on the machine.
#[must_use]
pub fn emit_clif(dae: &Dae) -> String {
    let slots: Vec<String> = Slot::ALL
        .iter()
        .zip(1..)
        .map(|(slot, n)| format!("{} at {}", slot.letter(), 8 * n))
        .collect();
    let mut text = format!("; frame: t at 0, {}\n", slots.join(", "));
    for routine in routines(dae) {
        for (name, function) in functions(dae, &routine) {
            let _ = write!(text, "\n; {name}\n{function}");
        }
    }
    text
}

/// The assembly of every kernel on this machine.
#[must_use]
pub fn emit_assembly(dae: &Dae) -> String {
    let Some(isa) = native::host_isa() else {
        return "; no code generator for this machine\n".to_owned();
    };
    let mut text = format!("; {}\n", isa.triple());
    for routine in routines(dae) {
        for (name, function) in functions(dae, &routine) {
            let mut context = Context::for_function(function);
            context.set_disasm(true);
            let code = context.compile(&*isa, &mut ControlPlane::default());
            let listing = code
                .ok()
                .and_then(|code| code.vcode.clone())
                .unwrap_or_default();
            let _ = write!(text, "\n; {name}\n{listing}");
        }
    }
    text
}

/// The number of instructions of the Cranelift IR of every kernel.
#[must_use]
pub fn instruction_count(dae: &Dae) -> usize {
    routines(dae)
        .iter()
        .flat_map(|routine| functions(dae, routine))
        .map(|(_, function)| {
            function
                .layout
                .blocks()
                .map(|block| function.layout.block_insts(block).count())
                .sum::<usize>()
        })
        .sum()
}

/// The functions of a routine, each with its name.
fn functions(dae: &Dae, routine: &Routine) -> Vec<(String, Function)> {
    let parts = Parts::of(dae, routine);
    let mut kept = FxHashSet::default();
    let names = (0..parts.steps.len()).map(|part| routine.part_name(part));
    let list = names.zip(&parts.steps);
    list.map(|(name, steps)| {
        let part = (&parts, steps.clone());
        let function = function(dae, routine, part, &mut kept, &name);
        (name, function)
    })
    .collect()
}

fn function(
    dae: &Dae,
    routine: &Routine,
    part: (&Parts, Range<usize>),
    kept: &mut FxHashSet<ExprId>,
    name: &str,
) -> Function {
    let mut signature = Signature::new(native::PRINTED);
    signature.params.push(AbiParam::new(types::I64));
    let mut function = Function::with_name_signature(UserFuncName::testcase(name), signature);
    let mut builder_context = FunctionBuilderContext::new();
    let builder = FunctionBuilder::new(&mut function, &mut builder_context);
    let mut known: Vec<(&'static str, cranelift_codegen::ir::FuncRef)> = Vec::new();
    let config = TargetFrontendConfig {
        default_call_conv: native::PRINTED,
        pointer_width: target_lexicon::PointerWidth::U64,
        page_size_align_log2: 12,
    };
    lower::lower(
        dae,
        routine,
        part,
        kept,
        builder,
        &mut |function, name, parameters| {
            if let Some((_, reference)) = known.iter().find(|(other, _)| *other == name) {
                return *reference;
            }
            let mut signature = Signature::new(native::PRINTED);
            signature.params = parameters.iter().map(|own| AbiParam::new(*own)).collect();
            signature.returns.push(AbiParam::new(types::F64));
            let signature = function.import_signature(signature);
            let name_in_text = ExternalName::testcase(name);
            let data = ExtFuncData {
                name: name_in_text,
                signature,
                colocated: false,
                patchable: false,
            };
            let reference = function.import_function(data);
            known.push((name, reference));
            reference
        },
        config,
    );
    function
}
