//! The files of a model on the disk, looked at several times a second: this works on every file system, and for every editor,
//! whether it writes a file anew or moves another one to its place.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// How often the files are looked at.
pub(super) const EVERY: Duration = Duration::from_millis(100);

/// Size and time of the last change; nothing of a file that is not there.
type Seen = Option<(u64, Option<SystemTime>)>;

/// Files as they were when they were last looked at.
pub(super) struct Watched {
    files: BTreeMap<PathBuf, Seen>,
}

impl Watched {
    /// The user's file, and all others that were read.
    pub(super) fn new(own: &Path, others: impl Iterator<Item = PathBuf>) -> Self {
        let all = others.chain([own.to_path_buf()]);
        Self {
            files: all.map(|path| (path.clone(), seen(&path))).collect(),
        }
    }

    /// Whether one of them has changed since.
    pub(super) fn have_changed(&self) -> bool {
        self.files
            .iter()
            .any(|(path, before)| seen(path) != *before)
    }
}

fn seen(path: &Path) -> Seen {
    let facts = std::fs::metadata(path).ok()?;
    Some((facts.len(), facts.modified().ok()))
}
