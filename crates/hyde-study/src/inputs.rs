//! [`Inputs`]: every file that a model is made from, as it was read: to tell whether two batches are one, and to make the
//! same model elsewhere, or later when the files have changed.

use crate::world::World;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// What a file is to a model.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The user's file.
    Model,
    /// A package that a file names.
    Package,
    /// A lookup table that a file names.
    Table,
    /// An FMU that a file names.
    Fmu,
    /// A record of the experiment, or the table of cases.
    Record,
}

/// Which file is meant: what it is, the place of the file that names it, and the name there.
pub type Key = (Kind, String, String);

/// A file: the place it was read from, and its content.
pub type Content = (String, Vec<u8>);

/// Files that were read, or that are to be read instead of those of the disk.
#[derive(Debug, Default)]
pub struct Inputs {
    replayed: bool,
    /// Stands below the model's own file, as if it were written there.
    below: String,
    files: Mutex<BTreeMap<Key, Content>>,
}

impl Inputs {
    /// Notes what is read.
    pub fn recording() -> Self {
        Self::default()
    }

    /// The same with a text below the model's file.
    pub fn recording_with(below: String) -> Self {
        Self {
            below,
            ..Self::default()
        }
    }

    /// Gives these files and no others.
    pub fn replaying(files: BTreeMap<Key, Content>) -> Self {
        Self {
            replayed: true,
            files: Mutex::new(files),
            ..Self::default()
        }
    }

    /// Whether the files are not those of the disk.
    pub fn is_replayed(&self) -> bool {
        self.replayed
    }

    /// Reads a file.
    pub(crate) fn read(
        &self,
        world: &dyn World,
        kind: Kind,
        asker: &str,
        name: &str,
        path: &Path,
    ) -> Result<Vec<u8>, String> {
        if self.replayed {
            let found = self.found(kind, asker, name).map(|(_, content)| content);
            return found.ok_or_else(|| {
                format!("`{}` is not among the files of the batch", path.display())
            });
        }
        let mut content = world.read(path)?;
        if kind == Kind::Model {
            content.extend_from_slice(self.below.as_bytes());
        }
        self.note(
            kind,
            asker,
            name,
            (path.to_string_lossy().into_owned(), content.clone()),
        );
        Ok(content)
    }

    /// Notes a file that was read otherwise.
    pub fn note(&self, kind: Kind, asker: &str, name: &str, content: Content) {
        let key = (kind, asker.to_owned(), name.to_owned());
        self.files
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .insert(key, content);
    }

    /// A file that is known.
    pub fn found(&self, kind: Kind, asker: &str, name: &str) -> Option<Content> {
        let key = (kind, asker.to_owned(), name.to_owned());
        self.files
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .get(&key)
            .cloned()
    }

    /// All of them.
    pub fn all(&self) -> BTreeMap<Key, Content> {
        self.files
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }
}
