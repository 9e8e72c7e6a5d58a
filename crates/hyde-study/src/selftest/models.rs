//! [`Models`]: programs of an axis with effects put on. Every diagnosis of a self-test asks for the same observed ones, one
//! effect at a time: these are made once.

use crate::Project;
use crate::unknown;
use hyde_calibrate::{Built, Written};
use hyde_compiler::{Additions, Candidate, Form, Header, Request};
use hyde_diag::Diagnostics;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A program with the paths of its effects.
type Made = Option<(hyde_program::Program, Vec<String>)>;

/// Programs of an axis.
pub(super) struct Models<'a> {
    project: &'a Project,
    candidates: &'a [Candidate],
    headers: BTreeMap<String, Header>,
    observed: Mutex<BTreeMap<Vec<usize>, Made>>,
}

impl<'a> Models<'a> {
    pub(super) fn new(project: &'a Project, candidates: &'a [Candidate]) -> Self {
        Self {
            headers: crate::headers(&project.records),
            observed: Mutex::default(),
            project,
            candidates,
        }
    }

    /// What an observer runs, with effects written for it behind those known.
    pub(super) fn observed(&self, numbers: &[usize], written: &[Written]) -> Option<Built> {
        if numbers.len() > 1 || !written.is_empty() {
            let settings: BTreeMap<String, f64> = self.project.set().into_iter().collect();
            let request = self.request(&settings, Form::Observed);
            return unknown::built(&request, self.candidates, numbers, written);
        }
        let built = |made: &Made| {
            let (program, paths) = made.clone()?;
            Some(Built { program, paths })
        };
        let lock = || self.observed.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(made) = lock().get(numbers) {
            return built(made);
        }
        let made = self.compiled(numbers, Form::Observed, |_| Vec::new());
        let found = built(&made);
        lock().insert(numbers.to_vec(), made);
        found
    }

    /// What makes a record; sizes and shapes of the effect may shape the equations.
    pub(super) fn recorded(
        &self,
        numbers: &[usize],
        sizes: &[f64],
        shapes: &[f64],
    ) -> Option<Built> {
        let of_last = |paths: &[String]| {
            let (Some(path), Some(&number)) = (paths.last(), numbers.last()) else {
                return Vec::new();
            };
            let candidate = &self.candidates[number];
            let knobs = candidate.sizes.iter().zip(sizes);
            let knobs = knobs.chain(candidate.shapes.iter().zip(shapes));
            knobs
                .map(|(knob, &value)| (format!("{path}.{}", knob.name), value))
                .collect()
        };
        let (program, paths) = self.compiled(numbers, Form::Recorded, of_last)?;
        Some(Built { program, paths })
    }

    fn compiled(
        &self,
        numbers: &[usize],
        form: Form,
        values: impl FnOnce(&[String]) -> Vec<(String, f64)>,
    ) -> Made {
        let project = self.project;
        let file = project.file.files.first()?.0;
        let mut additions = Additions::kept();
        let paths: Vec<String> = numbers
            .iter()
            .map(|&number| additions.put(file, &self.candidates[number]))
            .collect();
        let mut settings: BTreeMap<String, f64> = project.set().into_iter().collect();
        settings.extend(values(&paths));
        let request = self.request(&settings, form);
        let compiled = hyde_compiler::compile_with(&request, &additions, &mut Diagnostics::new())?;
        Some((compiled.program, paths))
    }

    fn request<'r>(&'r self, settings: &'r BTreeMap<String, f64>, form: Form) -> Request<'r> {
        self.project.request(settings, &self.headers, form)
    }
}
