//! The programs of a batch: one for each variant, compiled when its first case comes and kept for the others.

use crate::{Asked, Project, Records, run_failure};
use hyde_compiler::{Backend, Form, FreeInputs, Request};
use hyde_diag::{Diagnostic, Diagnostics, Severity};
use hyde_experiment::RunError;
use hyde_experiment::batch::{
    Case, Dataset, Draft, Fault, Plan, Variant, Wanted, record_files, varied,
};
use hyde_program::Program;
use hyde_signal::Table;
use hyde_sim::FailureKind;
use hyde_syntax::ast::Name;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A program that can be run, with its records.
pub struct Ready {
    /// The program.
    pub program: Program,
    /// Its records by name.
    pub tables: BTreeMap<String, Table>,
}

/// The compiled variants of a batch.
pub struct Variants {
    dataset: Dataset,
    known: Mutex<BTreeMap<Variant, Cell>>,
}

/// A variant, or why none of its cases can be compiled; empty as long as neither is known.
type Cell = Arc<Mutex<Option<Made>>>;
type Made = Result<Arc<(Ready, Wanted)>, Fault>;

impl Variants {
    /// None yet.
    pub fn new(dataset: &Dataset) -> Self {
        Self {
            dataset: dataset.clone(),
            known: Mutex::default(),
        }
    }

    /// Gives the program of a case to `with`, compiled if it is the first of its variant. Others that need it wait.
    pub fn with<T>(
        &self,
        model: &Source<'_>,
        plan: &Plan,
        case: &Case,
        with: impl FnOnce(&Ready, &Wanted) -> T,
    ) -> Result<T, Fault> {
        let cell = {
            let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            Arc::clone(known.entry(plan.variant(case)).or_default())
        };
        let made = {
            let mut kept = cell.lock().unwrap_or_else(PoisonError::into_inner);
            match &*kept {
                Some(made) => made.clone(),
                None => {
                    let (made, of_all) = self.made(model, plan, case);
                    *kept = of_all.then(|| made.clone());
                    made
                }
            }
        };
        made.map(|ready| with(&ready.0, &ready.1))
    }

    /// Compiles the variant of a case, and whether what comes of it is that of all cases of the variant. A value of the first
    /// case that its parameter may not have is no fault of the others: the program has the declared value then, and each case
    /// is held against the bounds when it is run.
    fn made(&self, model: &Source<'_>, plan: &Plan, case: &Case) -> (Made, bool) {
        let options = plan.options(case);
        let ready = |ready: Ready| {
            let wanted = Wanted::of(&ready.program, &self.dataset);
            Ok(Arc::new((ready, wanted)))
        };
        let of_case = match model.compile(&options, &plan.settings(case)) {
            Ok(found) => return (ready(found), true),
            Err(diagnostics) => model.refused(&diagnostics),
        };
        match model.compile(&options, &plan.structural_settings(case)) {
            Ok(found) => (ready(found), true),
            Err(diagnostics) => {
                let same = model.refused(&diagnostics).reason == of_case.reason;
                (Err(of_case), same)
            }
        }
    }
}

/// What variants are made of.
pub struct Source<'p> {
    /// The model and the experiment.
    pub project: &'p Project,
    /// What was asked, with its files.
    pub asked: &'p Asked,
    /// The sweep as it is written.
    pub draft: &'p Draft,
}

impl Source<'_> {
    /// Compiles a variant: with these options of the choices, and these values of what is structural.
    pub fn compile(&self, options: &[usize], set: &[(String, f64)]) -> Result<Ready, Diagnostics> {
        let Self {
            project,
            asked,
            draft,
        } = self;
        let (file, model) = varied(&project.file, draft, &project.model, options);
        let mut diagnostics = Diagnostics::new();
        let mut settings: BTreeMap<String, f64> = project.set().into_iter().collect();
        // A start value becomes a parameter by being named.
        settings.extend(draft.starts().map(|name| (name, 0.0)));
        settings.extend(set.iter().cloned());
        let others = record_files(draft, options);
        let read = file
            .experiments()
            .find(|e| e.name.text == draft.experiment)
            .map(|experiment| {
                let mut experiment = experiment.clone();
                let mut asked = (*asked).clone();
                for (record, path) in others {
                    asked.records.retain(|(name, _)| *name != record);
                    for item in experiment
                        .records
                        .iter_mut()
                        .filter(|item| item.name.text == record)
                    {
                        let span = item.name.span;
                        item.default = Some(Name {
                            text: path.to_owned(),
                            span,
                        });
                    }
                }
                crate::read_records(&experiment, &asked, Records::Needed, &mut diagnostics)
            });
        let read = match read {
            Some(Ok(read)) if !diagnostics.has_errors() => read,
            Some(Ok(_)) => return Err(diagnostics),
            Some(Err(_)) | None => BTreeMap::new(), // Told when the project was loaded.
        };
        let headers = crate::headers(&read);
        let request = Request {
            sources: &project.sources,
            file: &file,
            model: &model,
            experiment: Some(&draft.experiment),
            settings: &settings,
            records: &headers,
            free_inputs: FreeInputs::None,
            ledger: false,
            form: Form::Run,
            backend: Backend::Native,
        };
        match hyde_compiler::compile(&request, &mut diagnostics) {
            Some(mut compiled) => {
                project.attach_fmus(&mut compiled.program);
                Ok(Ready {
                    program: compiled.program,
                    tables: crate::tables(&read),
                })
            }
            None => Err(diagnostics),
        }
    }

    /// A variant that does not compile, as the outcome of its cases.
    fn refused(&self, diagnostics: &Diagnostics) -> Fault {
        let first = diagnostics.iter().find(|d| d.severity == Severity::Error);
        first.map_or_else(Fault::default, |diagnostic| {
            self.fault(diagnostic, f64::NAN)
        })
    }

    /// A case that failed, as its outcome; `None` if it was interrupted.
    pub fn failed(&self, error: &RunError, program: &Program) -> Option<Fault> {
        let time_s = match error {
            RunError::Failed(failure) if failure.kind == FailureKind::Interrupted => return None,
            RunError::Failed(failure) => failure.t,
            RunError::NotANumber { t, .. } => *t,
            RunError::NoParameter(_)
            | RunError::CannotSet(..)
            | RunError::NotAllowed(..)
            | RunError::Row(_)
            | RunError::NoGradientBy(..)
            | RunError::NoStop
            | RunError::EndsBeforeStart { .. }
            | RunError::Lasts(_)
            | RunError::NotPositive(..)
            | RunError::TooManyRows { .. }
            | RunError::Compare(_) => f64::NAN,
        };
        let (diagnostic, _) = run_failure::diagnostic(error, program, None);
        Some(self.fault(&diagnostic, time_s))
    }

    fn fault(&self, diagnostic: &Diagnostic, time_s: f64) -> Fault {
        let sources = &self.project.sources;
        let span = diagnostic.labels.first().map(|label| label.span);
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        Fault {
            code: diagnostic.code.to_string(),
            reason: diagnostic.message.clone(),
            equation: span.map_or_else(String::new, |span| words(sources.text(span))),
            source: span.map_or_else(String::new, |span| sources.place(span)),
            time_s,
        }
    }
}
