//! Any text becomes programs of its models and experiments, or errors with a place.
#![no_main]

use hyde_compiler::{Backend, Form, FreeInputs, Packages, Request};
use hyde_diag::{Diagnostics, Severity, Sources};
use libfuzzer_sys::fuzz_target;
use std::collections::BTreeMap;

/// A longer text takes long to compile, and shows nothing that a short one does not.
const LONGEST: usize = 4_000;

fuzz_target!(|text: &str| {
    if text.len() > LONGEST {
        return;
    }
    let mut sources = Sources::new();
    let mut diagnostics = Diagnostics::new();
    let packages = &Packages::LIBRARY;
    let file = hyde_compiler::load(&mut sources, "fuzz.hyde", text, packages, &mut diagnostics);
    let (settings, records) = (BTreeMap::new(), BTreeMap::new());
    let experiments = file.experiments().map(|experiment| {
        let name = experiment.name.text.clone();
        (experiment.model.dotted(), Some(name))
    });
    let models = file.models().map(|model| (model.to_owned(), None));
    for (model, experiment) in experiments.chain(models).take(4) {
        let request = Request {
            sources: &sources,
            file: &file,
            model: &model,
            experiment: experiment.as_deref(),
            settings: &settings,
            records: &records,
            free_inputs: FreeInputs::All,
            ledger: true,
            form: Form::Run,
            backend: Backend::Interpreter,
        };
        let mut own = diagnostics.clone();
        let compiled = hyde_compiler::compile(&request, &mut own);
        assert!(
            compiled.is_some() || own.has_errors(),
            "neither a program nor an error"
        );
        for error in own.iter().filter(|one| one.severity == Severity::Error) {
            assert!(!error.labels.is_empty(), "{} has no place", error.code);
        }
    }
});
