//! A full check: every experiment of a file compiled, or its last model, and its studies read.

use crate::position::Encoding;
use crate::publish::published;
use hyde_calibrate::CalibrationPlan;
use hyde_compiler::DiagnosisPlan;
use hyde_diag::Diagnostics;
use hyde_study::world::World;
use hyde_study::{Aim, Asked, Loaded, Project, Records};
use hyde_syntax::ast::StudyKind;
use lsp_types::{DiagnosticSeverity, Position, Range};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A file to be checked.
pub(crate) struct Job {
    pub(crate) path: PathBuf,
    pub(crate) world: Arc<dyn World>,
    /// Of the files as they are in this world.
    pub(crate) revision: u64,
    pub(crate) version: Option<i32>,
    pub(crate) encoding: Encoding,
}

/// What a check found.
pub(crate) struct Checked {
    pub(crate) path: PathBuf,
    pub(crate) revision: u64,
    pub(crate) version: Option<i32>,
    pub(crate) diagnostics: Vec<lsp_types::Diagnostic>,
}

/// Checks a file.
pub(crate) fn check(job: &Job) -> Checked {
    let encoding = job.encoding;
    // A defect of the compiler must not end the editor's session.
    let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        all(&job.path, &job.world, encoding)
    }));
    Checked {
        path: job.path.clone(),
        revision: job.revision,
        version: job.version,
        diagnostics: found
            .unwrap_or_else(|_| vec![plain("the compiler failed on this text".to_owned())]),
    }
}

fn all(path: &Path, world: &Arc<dyn World>, encoding: Encoding) -> Vec<lsp_types::Diagnostic> {
    let asked = Asked {
        world: Arc::clone(world),
        ..Asked::of_file(path)
    };
    let loaded = match Loaded::of(&asked) {
        Ok(loaded) => loaded,
        Err(reason) => return vec![plain(reason)],
    };
    let studies = |kind| loaded.file.studies().any(|study| study.kind == kind);
    // A diagnosis names effects of packages that its model need not use.
    let whole_library = studies(StudyKind::Diagnose);
    let experiments = loaded.file.experiments();
    let mut chosen: Vec<Option<String>> = experiments
        .map(|experiment| Some(experiment.name.text.clone()))
        .collect();
    if chosen.is_empty() {
        chosen.push(None);
    }
    let nothing = chosen == [None] && loaded.file.models().next().is_none();
    if loaded.diagnostics.has_errors() || nothing {
        let own = loaded.file.files.first().map(|(id, _)| *id);
        let found = loaded.diagnostics.iter();
        return found
            .map(|found| published(found, &loaded.sources, own, encoding))
            .collect();
    }
    let mut list: Vec<lsp_types::Diagnostic> = Vec::new();
    let mut last: Option<Project> = None;
    for experiment in chosen {
        let asked = Asked {
            experiment,
            whole_library,
            ..asked.clone()
        };
        match hyde_study::load(&asked, Records::IfThere) {
            Ok(mut project) => {
                if !project.diagnostics.has_errors() {
                    let aim = match project.experiment {
                        None => Aim::Linearize,
                        Some(_) => Aim::Ledger,
                    };
                    // What is wrong is among the project's diagnostics.
                    let _compiled = project.compile(aim);
                }
                // The files are the same, so places are: what is wrong with a model is shown once.
                if let Some(before) = last {
                    let own = std::mem::replace(&mut project.diagnostics, before.diagnostics);
                    own.iter()
                        .for_each(|own| project.diagnostics.push(own.clone()));
                }
                last = Some(project);
            }
            Err(reason) => list.push(plain(reason)),
        }
    }
    if let Some(mut project) = last {
        read_studies(&mut project);
        let own = project.file.files.first().map(|(id, _)| *id);
        let found = project.diagnostics.iter();
        list.extend(found.map(|found| published(found, &project.sources, own, encoding)));
    }
    list
}

/// Reads calibrations and diagnoses, as the check of the command line does.
fn read_studies(project: &mut Project) {
    let mut diagnostics = std::mem::take(&mut project.diagnostics);
    for study in project.file.studies() {
        read_study(project, study, &mut diagnostics);
    }
    project.diagnostics = diagnostics;
}

fn read_study(project: &Project, study: &hyde_syntax::ast::Study, diagnostics: &mut Diagnostics) {
    match study.kind {
        StudyKind::Calibrate => drop(CalibrationPlan::read(study, diagnostics)),
        StudyKind::Diagnose => {
            drop(DiagnosisPlan::read(
                &project.file,
                &study.name.text,
                diagnostics,
            ));
        }
        StudyKind::Sweep => {}
    }
}

/// What has no place in the text.
fn plain(message: String) -> lsp_types::Diagnostic {
    lsp_types::Diagnostic {
        range: Range::new(Position::new(0, 0), Position::new(0, 0)),
        severity: Some(DiagnosticSeverity::ERROR),
        source: Some("hyde".to_owned()),
        message,
        ..lsp_types::Diagnostic::default()
    }
}
