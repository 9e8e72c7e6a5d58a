//! What is known of a project's model beside its program: which effects fit where on it, and which laws may act where.

use crate::Project;
use hyde_compiler::{Backend, Candidate, Form, FreeInputs, Laws, Request};
use hyde_diag::Diagnostics;
use std::collections::BTreeMap;

impl Project {
    /// Which effects fit where on the model, as long as that is in order; what is wrong stays in the project's diagnostics.
    pub fn candidates(&mut self) -> Option<Vec<Candidate>> {
        self.known(hyde_compiler::candidates)
    }

    /// Where a law may act on the model and what it may be made of, as long as both are in order; what is wrong stays in the
    /// project's diagnostics.
    pub fn laws(&mut self) -> Option<Laws> {
        self.known(hyde_compiler::laws)
    }

    /// What the compiler knows of the model beside its program.
    fn known<T>(&mut self, ask: fn(&Request<'_>, &mut Diagnostics) -> Option<T>) -> Option<T> {
        let request = Request {
            sources: &self.sources,
            file: &self.file,
            model: &self.model,
            experiment: None,
            settings: &BTreeMap::new(),
            records: &BTreeMap::new(),
            free_inputs: FreeInputs::All,
            ledger: false,
            form: Form::Run,
            backend: Backend::Native,
        };
        ask(&request, &mut self.diagnostics)
    }
}
