//! Machine code in memory, and the one call into it.

use crate::host;
use crate::lower;
use crate::parts::Parts;
use crate::routine::Routine;
use cranelift_codegen::ir::{AbiParam, types};
use cranelift_codegen::isa::{CallConv, OwnedTargetIsa};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Linkage, Module, default_libcall_names};
use hyde_ir::{Dae, ExprId};
use hyde_program::{Point, Workspace};
use rustc_hash::FxHashSet;
use std::ops::Range;
use std::sync::Mutex;

/// A compiled routine. Its memory is freed when it is dropped.
pub(crate) struct Native {
    /// One a part, in their order.
    functions: Vec<extern "C" fn(*const RawFrame)>,
    /// How many numbers parts keep for later ones.
    kept: usize,
    module: Mutex<Option<JITModule>>,
}

/// The frame as the code sees it: the time, then the addresses of the slots in the order of [`crate::routine::Slot`], and that
/// of what parts keep.
#[repr(C)]
struct RawFrame {
    t: f64,
    y: *const f64,
    yp: *const f64,
    z: *const f64,
    u: *const f64,
    p: *const f64,
    work: *mut f64,
    out: *mut f64,
    kept: *mut f64,
}

impl Native {
    /// Compiles a routine for this machine; `None` if it is none that Cranelift makes code for.
    pub(crate) fn new(dae: &Dae, routine: &Routine) -> Option<Self> {
        let isa = host_isa()?;
        let mut builder = JITBuilder::with_isa(isa, default_libcall_names());
        builder.symbols(host::functions());
        let mut module = JITModule::new(builder);
        let parts = Parts::of(dae, routine);
        let mut kept = FxHashSet::default();
        let mut ids = Vec::new();
        for (number, steps) in parts.steps.iter().enumerate() {
            let name = routine.part_name(number);
            let part = (&parts, steps.clone());
            ids.push(define(&mut module, dae, routine, part, &mut kept, &name)?);
        }
        module.finalize_definitions().ok()?;
        let functions = ids.into_iter().map(|id| {
            let code = module.get_finalized_function(id);
            // SAFETY: `code` is the address of the function just defined, whose signature is one pointer and no result in
            // the default calling convention of the host, which is that of `extern "C"`. It stays valid until the module's
            // memory is freed, which only `drop` does.
            #[allow(unsafe_code, reason = "the address of code just made")]
            unsafe {
                std::mem::transmute::<*const u8, extern "C" fn(*const RawFrame)>(code)
            }
        });
        Some(Self {
            functions: functions.collect(),
            kept: parts.kept.len(),
            module: Mutex::new(Some(module)),
        })
    }

    /// Runs the code at a point.
    #[inline(always)]
    pub(crate) fn run(&self, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]) {
        if workspace.kept.len() < self.kept {
            workspace.kept.resize(self.kept, 0.0);
        }
        let raw = RawFrame {
            t: at.t,
            y: at.y.as_ptr(),
            yp: at.yp.as_ptr(),
            z: at.z.as_ptr(),
            u: at.u.as_ptr(),
            p: at.p.as_ptr(),
            work: workspace.work.as_mut_ptr(),
            out: out.as_mut_ptr(),
            kept: workspace.kept.as_mut_ptr(),
        };
        for function in &self.functions {
            function(&raw const raw);
        }
    }
}

/// Defines the function of a part; `None` if Cranelift makes no code for it.
fn define(
    module: &mut JITModule,
    dae: &Dae,
    routine: &Routine,
    part: (&Parts, Range<usize>),
    kept: &mut FxHashSet<ExprId>,
    name: &str,
) -> Option<FuncId> {
    let mut context = module.make_context();
    let parameters = &mut context.func.signature.params;
    parameters.push(AbiParam::new(types::I64));
    context.func.signature.call_conv = module.target_config().default_call_conv;
    let id = module
        .declare_function(name, Linkage::Local, &context.func.signature)
        .ok()?;
    let mut builder_context = FunctionBuilderContext::new();
    let config = module.target_config();
    let function = FunctionBuilder::new(&mut context.func, &mut builder_context);
    let mut failed = false;
    lower::lower(
        dae,
        routine,
        part,
        kept,
        function,
        &mut |function, name, parameters| {
            let mut signature = module.make_signature();
            signature.params = parameters.iter().map(|own| AbiParam::new(*own)).collect();
            signature.returns.push(AbiParam::new(types::F64));
            match module.declare_function(name, Linkage::Import, &signature) {
                Ok(imported) => module.declare_func_in_func(imported, function),
                Err(_) => {
                    failed = true;
                    let signature = function.import_signature(signature);
                    function.import_function(cranelift_codegen::ir::ExtFuncData {
                        name: cranelift_codegen::ir::ExternalName::testcase(name),
                        signature,
                        colocated: false,
                        patchable: false,
                    })
                }
            }
        },
        config,
    );
    if failed {
        return None;
    }
    module.define_function(id, &mut context).ok()?;
    module.clear_context(&mut context);
    Some(id)
}

impl Drop for Native {
    fn drop(&mut self) {
        let module = self.module.get_mut().ok().and_then(Option::take);
        if let Some(module) = module {
            // SAFETY: the function pointer is private to `self`, which is being dropped: no call can follow or be under
            // way, for a call borrows `self`.
            #[allow(unsafe_code, reason = "the module leaks its memory unless told")]
            unsafe {
                module.free_memory();
            }
        }
    }
}

/// The machine this runs on.
pub(crate) fn host_isa() -> Option<OwnedTargetIsa> {
    let builder = cranelift_native::builder().ok()?;
    builder.finish(flags()?).ok()
}

fn flags() -> Option<settings::Flags> {
    let mut flags = settings::builder();
    flags.set("opt_level", "speed").ok()?;
    flags.set("is_pic", "false").ok()?;
    flags.set("use_colocated_libcalls", "false").ok()?;
    flags
        .set(
            "enable_verifier",
            if cfg!(debug_assertions) {
                "true"
            } else {
                "false"
            },
        )
        .ok()?;
    Some(settings::Flags::new(flags))
}

/// The calling convention of printed code, whatever the host.
pub(crate) const PRINTED: CallConv = CallConv::SystemV;
