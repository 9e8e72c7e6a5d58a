//! A text with the packages it names, parsed, and its names with their meanings.

use crate::occurrences::{Occurrence, occurrences};
use crate::scope::{Definition, Files};
use hyde_diag::{FileId, Span};
use hyde_study::world::World;
use hyde_study::{Asked, Loaded};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A parsed text.
pub(crate) struct Analysis {
    pub(crate) path: PathBuf,
    pub(crate) loaded: Loaded,
}

/// Where something is declared, the same in every analysis: the name of the source text and the first byte.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Identity {
    pub(crate) source: String,
    pub(crate) start: u32,
}

impl Analysis {
    /// Parses the file at a path.
    pub(crate) fn of(world: &Arc<dyn World>, path: &Path) -> Option<Self> {
        let asked = Asked {
            world: Arc::clone(world),
            ..Asked::of_file(path)
        };
        let loaded = Loaded::of(&asked).ok()?;
        Some(Self {
            path: path.to_path_buf(),
            loaded,
        })
    }

    /// The text of the file itself.
    pub(crate) fn text(&self) -> &str {
        match self.own() {
            Some(file) => &self.loaded.sources.get(file).text,
            None => "",
        }
    }

    /// The file itself among the sources.
    pub(crate) fn own(&self) -> Option<FileId> {
        self.loaded.file.files.first().map(|(id, _)| *id)
    }

    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            files: &self.loaded.file.files,
        }
    }

    /// The names of the file itself.
    pub(crate) fn occurrences(&self) -> Vec<Occurrence<'_>> {
        occurrences(self.files(), 0)
    }

    /// The name at a byte of the file itself, or just before it.
    pub(crate) fn occurrence_at(&self, byte: usize) -> Option<Occurrence<'_>> {
        let own = self.occurrences().into_iter();
        let mut at: Vec<Occurrence<'_>> = own
            .filter(|found| (found.span.start as usize) <= byte && byte <= found.span.end as usize)
            .collect();
        at.sort_by_key(|found| (found.span.end as usize == byte, found.meaning.is_none()));
        at.first().copied()
    }

    pub(crate) fn identity(&self, definition: &Definition<'_>) -> Identity {
        self.identity_of(definition.name.span)
    }

    pub(crate) fn identity_of(&self, span: Span) -> Identity {
        Identity {
            source: self.loaded.sources.get(span.file).name.clone(),
            start: span.start,
        }
    }
}
