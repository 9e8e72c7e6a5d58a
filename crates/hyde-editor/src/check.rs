//! A full check, as `hyde check` makes it, given up as soon as a file changes.

use crate::position::Encoding;
use crate::publish::published;
use hyde_compiler::File;
use hyde_diag::{Diagnostics, Sources};
use hyde_study::world::World;
use hyde_study::{Asked, Loaded};
use lsp_types::{DiagnosticSeverity, Position, Range};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A file to be checked.
pub(crate) struct Job {
    pub(crate) path: PathBuf,
    pub(crate) world: Arc<dyn World>,
    /// Of the files as they are in this world.
    pub(crate) revision: u64,
    pub(crate) version: Option<i32>,
    pub(crate) encoding: Encoding,
    /// The newest revision that the server knows.
    pub(crate) newest: Arc<AtomicU64>,
}

impl Job {
    /// Whether a file has changed since the check was asked for.
    fn is_out_of_date(&self) -> bool {
        self.newest.load(Ordering::Relaxed) != self.revision
    }
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
    // A defect of the compiler must not end the editor's session.
    let found = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| all(job)));
    Checked {
        path: job.path.clone(),
        revision: job.revision,
        version: job.version,
        diagnostics: found
            .unwrap_or_else(|_| vec![plain("the compiler failed on this text".to_owned())]),
    }
}

fn all(job: &Job) -> Vec<lsp_types::Diagnostic> {
    let asked = Asked {
        world: Arc::clone(&job.world),
        ..Asked::of_file(&job.path)
    };
    let stop = || job.is_out_of_date();
    let found = match Loaded::of(&asked) {
        Ok(loaded) if has_nothing(&loaded) => {
            return shown(&loaded.file, &loaded.sources, &loaded.diagnostics, job);
        }
        Ok(loaded) => hyde_study::check(loaded, &asked, &stop, &mut |_, _| {}),
        Err(reason) => return vec![plain(reason)],
    };
    let mut list: Vec<lsp_types::Diagnostic> = found.refused.into_iter().map(plain).collect();
    if let Some(project) = found.project {
        let all = shown(&project.file, &project.sources, &project.diagnostics, job);
        list.extend(all);
    }
    list
}

/// Whether a file has neither experiments nor classes: types alone.
fn has_nothing(loaded: &Loaded) -> bool {
    loaded.file.experiments().next().is_none() && !loaded.file.has_classes()
}

fn shown(
    file: &File,
    sources: &Sources,
    diagnostics: &Diagnostics,
    job: &Job,
) -> Vec<lsp_types::Diagnostic> {
    let own = file.files.first().map(|(id, _)| *id);
    let found = diagnostics.iter();
    found
        .map(|found| published(found, sources, own, job.encoding))
        .collect()
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
