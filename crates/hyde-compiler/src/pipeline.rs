//! The way through the compiler, in the order written here.

use crate::load::File;
use crate::states::States;
use hyde_diag::{Diagnostics, Sources};
use hyde_flatten::{Additions, Form, FreeInputs, Header};
use hyde_ir::{Dae, FlatModel};
use hyde_jit::Backend;
use hyde_program::Program;
use std::collections::BTreeMap;
use std::time::Duration;

/// What is to be compiled.
pub struct Request<'a> {
    /// The source texts.
    pub sources: &'a Sources,
    /// The parsed files.
    pub file: &'a File,
    /// The model.
    pub model: &'a str,
    /// The experiment.
    pub experiment: Option<&'a str>,
    /// Values set from outside, SI. Those of structural parameters shape the equations.
    pub settings: &'a BTreeMap<String, f64>,
    /// The headers of the experiment's records.
    pub records: &'a BTreeMap<String, Header>,
    /// Which free inputs become parameters.
    pub free_inputs: FreeInputs,
    /// Make the energy ledger.
    pub ledger: bool,
    /// What the experiment is made into.
    pub form: Form,
    /// How numbers are made.
    pub backend: Backend,
}

/// A program with the time each stage took.
pub struct Compiled {
    /// What can be run.
    pub program: Program,
    /// Its states.
    pub states: States,
    /// The stages and their times.
    pub times: Vec<(&'static str, Duration)>,
}

/// Compiles a model with its experiment, from parsed files to a program.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn compile(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Compiled> {
    compile_with(request, &Additions::new(), diagnostics)
}

/// The same, given up without an error where `stop` is true before a stage.
pub fn compile_unless(
    request: &Request<'_>,
    stop: &dyn Fn() -> bool,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    staged(request, &Additions::new(), stop, diagnostics)
}

/// The same with effects put on the model beside those of its text.
pub fn compile_with(
    request: &Request<'_>,
    additions: &Additions,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    staged(request, additions, &|| false, diagnostics)
}

fn staged(
    request: &Request<'_>,
    additions: &Additions,
    stop: &dyn Fn() -> bool,
    diagnostics: &mut Diagnostics,
) -> Option<Compiled> {
    let go_on = || (!stop()).then_some(());
    let mut times = Vec::new();
    go_on()?;
    let flat = step("flatten", &mut times, || {
        flat(request, additions, diagnostics)
    })?;
    go_on()?;
    let dae = step("analyze", &mut times, || {
        checked(hyde_analysis::analyze(flat, request.settings, diagnostics))
    })?;
    go_on()?;
    let states = States::of(&dae);
    let program = step("compile", &mut times, || {
        hyde_jit::compile(dae, request.backend)
    });
    Some(Compiled {
        program,
        states,
        times,
    })
}

/// The same up to the DAE, for printing.
pub fn analyze(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Dae> {
    let flat = flatten(request, diagnostics)?;
    checked(hyde_analysis::analyze(flat, request.settings, diagnostics))
}

/// The flat model; refused if parsing found errors.
pub(crate) fn flatten(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<FlatModel> {
    flat(request, &Additions::new(), diagnostics)
}

fn flat(
    request: &Request<'_>,
    additions: &Additions,
    diagnostics: &mut Diagnostics,
) -> Option<FlatModel> {
    if diagnostics.has_errors() {
        return None;
    }
    let flat = hyde_flatten::flatten(&input(request, additions), diagnostics)?;
    if cfg!(debug_assertions) {
        let valid = hyde_ir::validate_flat(&flat);
        assert!(valid.is_ok(), "flatten broke an invariant: {valid:?}");
    }
    Some(flat)
}

/// What a request is to the first stage.
pub(crate) fn input<'a>(
    request: &'a Request<'_>,
    additions: &'a Additions,
) -> hyde_flatten::Input<'a> {
    hyde_flatten::Input {
        sources: request.sources,
        files: &request.file.files,
        elsewhere: &request.file.elsewhere,
        tables: &request.file.tables,
        fmus: &request.file.fmus,
        model: request.model,
        additions,
        experiment: request.experiment,
        settings: request.settings,
        records: request.records,
        free_inputs: request.free_inputs,
        ledger: request.ledger,
        form: request.form,
    }
}

fn checked(dae: Option<Dae>) -> Option<Dae> {
    if let (true, Some(dae)) = (cfg!(debug_assertions), &dae) {
        let valid = hyde_ir::validate_dae(dae);
        assert!(valid.is_ok(), "analyze broke an invariant: {valid:?}");
    }
    dae
}

/// Runs a stage and takes its time.
#[allow(
    clippy::disallowed_methods,
    reason = "the one place that times the stages"
)]
fn step<T>(
    name: &'static str,
    times: &mut Vec<(&'static str, Duration)>,
    stage: impl FnOnce() -> T,
) -> T {
    let start = std::time::Instant::now();
    let result = stage();
    times.push((name, start.elapsed()));
    result
}
