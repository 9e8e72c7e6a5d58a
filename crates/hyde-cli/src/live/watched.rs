//! The files of a model on the disk, looked at several times a second: this works on every file system, and for every editor,
//! whether it writes a file anew or moves another one to its place. A file that is being written is not read: what has changed
//! counts when it stays.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// How often the files are looked at, and how long a change must stay.
pub(super) const EVERY: Duration = Duration::from_millis(100);

/// Size and time of the last change; nothing of a file that is not there.
type Seen = Option<(u64, Option<SystemTime>)>;

/// Files as they were when they were read, and when they were last looked at.
pub(super) struct Watched {
    read: BTreeMap<PathBuf, Seen>,
    looked_at: BTreeMap<PathBuf, Seen>,
    since: Instant,
}

impl Watched {
    /// The user's file, and all others that were read.
    pub(super) fn new(own: &Path, others: impl Iterator<Item = PathBuf>) -> Self {
        let all = others.chain([own.to_path_buf()]);
        let read: BTreeMap<PathBuf, Seen> = all.map(|path| (path.clone(), seen(&path))).collect();
        Self {
            looked_at: read.clone(),
            read,
            since: instant(),
        }
    }

    /// The same, as another look found them before they were read: what has changed since may not have been read.
    pub(super) fn before_reading(mut self, before: &Self) -> Self {
        for (path, read) in &mut self.read {
            if let Some(seen) = before.looked_at.get(path) {
                *read = *seen;
            }
        }
        self
    }

    /// Whether one of them has changed since it was read, and stays as it is.
    pub(super) fn have_changed(&mut self) -> bool {
        let paths = self.read.keys();
        let now = paths.map(|path| (path.clone(), seen(path))).collect();
        if self.looked_at != now {
            (self.looked_at, self.since) = (now, instant());
        }
        self.looked_at != self.read && self.since.elapsed() >= EVERY
    }
}

#[allow(clippy::disallowed_methods, reason = "how long a file stays as it is")]
fn instant() -> Instant {
    Instant::now()
}

fn seen(path: &Path) -> Seen {
    let facts = std::fs::metadata(path).ok()?;
    Some((facts.len(), facts.modified().ok()))
}

#[cfg(test)]
#[allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test writes files, and may panic"
)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_being_written_has_not_changed_yet() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.hyde");
        let changed = |watched: &mut Watched| {
            std::thread::sleep(EVERY);
            watched.have_changed()
        };
        std::fs::write(&path, "model A end A;").unwrap();
        let mut watched = Watched::new(&path, std::iter::empty());
        assert!(!changed(&mut watched));
        // As an editor writes: empty first.
        std::fs::write(&path, "").unwrap();
        assert!(!watched.have_changed(), "it may be written still");
        std::fs::write(&path, "model A Real x; end A;").unwrap();
        assert!(!changed(&mut watched), "it was not so before");
        assert!(changed(&mut watched));
        // Between the last look and the reading it is written once more.
        let before = watched;
        std::fs::write(&path, "model A Real xy; end A;").unwrap();
        let mut watched = Watched::new(&path, std::iter::empty()).before_reading(&before);
        assert!(changed(&mut watched));
    }
}
