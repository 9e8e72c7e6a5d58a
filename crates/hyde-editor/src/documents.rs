//! The texts that are open in the editor, over the files of the disk.

use crate::position::Encoding;
use hyde_study::world::{Buffers, World, read_text};
use lsp_types::TextDocumentContentChangeEvent;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A text that is open.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    pub(crate) text: String,
    pub(crate) version: i32,
}

/// The open texts, and the disk below.
pub(crate) struct Documents {
    disk: Arc<dyn World>,
    open: BTreeMap<PathBuf, Document>,
    /// Grows with every change of any file: an answer of another revision is out of date.
    pub(crate) revision: u64,
    /// The same, for checks under way.
    pub(crate) newest: Arc<AtomicU64>,
}

impl Documents {
    pub(crate) fn over(disk: Arc<dyn World>) -> Self {
        Self {
            disk,
            open: BTreeMap::new(),
            revision: 0,
            newest: Arc::default(),
        }
    }

    fn touched(&mut self) {
        self.revision += 1;
        self.newest.store(self.revision, Ordering::Relaxed);
    }

    pub(crate) fn open(&mut self, path: PathBuf, text: String, version: i32) {
        self.open.insert(path, Document { text, version });
        self.touched();
    }

    pub(crate) fn close(&mut self, path: &Path) {
        self.open.remove(path);
        self.touched();
    }

    /// Applies changes in their order.
    pub(crate) fn change(
        &mut self,
        path: &Path,
        version: i32,
        changes: Vec<TextDocumentContentChangeEvent>,
        encoding: Encoding,
    ) {
        self.touched();
        let Some(document) = self.open.get_mut(path) else {
            return;
        };
        document.version = version;
        for change in changes {
            match change.range {
                None => document.text = change.text,
                Some(range) => {
                    let start = encoding.byte(&document.text, range.start);
                    let end = encoding.byte(&document.text, range.end).max(start);
                    document.text.replace_range(start..end, &change.text);
                }
            }
        }
    }

    /// Something changed on the disk.
    pub(crate) fn disk_changed(&mut self) {
        self.touched();
    }

    pub(crate) fn get(&self, path: &Path) -> Option<&Document> {
        self.open.get(path)
    }

    /// The text of a file on the disk.
    pub(crate) fn saved(&self, path: &Path) -> Option<String> {
        read_text(self.disk.as_ref(), path).ok()
    }

    pub(crate) fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        self.open.keys()
    }

    /// The files as the editor shows them.
    pub(crate) fn world(&self) -> Arc<dyn World> {
        let mut buffers = Buffers::over(Arc::clone(&self.disk));
        for (path, document) in &self.open {
            buffers.put(path.clone(), document.text.clone());
        }
        Arc::new(buffers)
    }
}
