//! Files: read whole, written whole or not at all.

pub(crate) use hyde_study::world::reason;
use hyde_study::world::{self, Disk, World};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The disk, as studies take it.
pub(crate) fn disk() -> Arc<dyn World> {
    Arc::new(Disk)
}

/// Reads a file; the error says which and why.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, String> {
    Disk.read(path)
}

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    world::read_text(&Disk, path)
}

/// Whether there is a file.
pub(crate) fn is_file(path: &Path) -> bool {
    Disk.is_file(path)
}

/// Whether there is a folder.
pub(crate) fn is_folder(path: &Path) -> bool {
    Disk.is_folder(path)
}

/// The path without links and dots, if there is something.
pub(crate) fn real(path: &Path) -> Option<PathBuf> {
    Disk.real(path)
}

/// The files with an ending below a folder, in the order of their names: see [`world::below`].
pub(crate) fn below(folder: &Path, ending: &str, border: &str) -> Vec<PathBuf> {
    world::below(&Disk, folder, ending, border)
}

/// The files in a folder itself, in the order of their names.
pub(crate) fn in_folder(folder: &Path) -> Vec<PathBuf> {
    let names = Disk.entries(folder).files.into_iter();
    names.map(|name| folder.join(name)).collect()
}

/// The beginning of the name of a file that is being written.
const UNFINISHED: &str = ".hyde-";

/// Makes a folder with all above it.
pub(crate) fn make_folder(path: &Path) -> Result<(), String> {
    std::fs::create_dir_all(path).map_err(|error| {
        format!(
            "cannot make the folder `{}`: {}",
            path.display(),
            reason(&error)
        )
    })
}

/// Writes a file beside its place and moves it there once it is complete: see [`write_with`].
pub(crate) fn write(path: &Path, content: &[u8]) -> Result<(), String> {
    write_with(path, |file| file.write_all(content))
}

/// Writes a file of the user's anew, which stays the file that it is: a link leads to it still, and its permissions, its owner
/// and its other names are as they were. One that is read-only is left.
#[allow(clippy::disallowed_methods, reason = "the command line writes files")]
pub(crate) fn rewrite(path: &Path, content: &[u8]) -> Result<(), String> {
    let failed = |error: std::io::Error| cannot_write(path, &error);
    let place = real(path).unwrap_or_else(|| path.to_path_buf());
    let facts = std::fs::metadata(&place).map_err(failed)?;
    if facts.permissions().readonly() {
        let error = std::io::Error::from(ErrorKind::PermissionDenied);
        return Err(format!("{}; the file is read-only", failed(error)));
    }
    let folder = place.parent().unwrap_or(Path::new("."));
    let beside = tempfile::Builder::new()
        .prefix(UNFINISHED)
        .tempfile_in(folder)
        .ok();
    let beside = beside.filter(|file| takes_its_place(file, &facts));
    let Some(mut file) = beside else {
        // Only the file itself has its names and its owner.
        return std::fs::write(&place, content).map_err(failed);
    };
    file.write_all(content)
        .and_then(|()| file.as_file().set_permissions(facts.permissions()))
        .and_then(|()| file.as_file().sync_all())
        .map_err(failed)?;
    file.persist(&place).map_err(|error| failed(error.error))?;
    sync_folder(folder)
}

/// Whether a new file can stand for another one: it has the same owner, and the other one has no second name.
#[cfg(unix)]
fn takes_its_place(file: &tempfile::NamedTempFile, other: &std::fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt as _;
    let own = file.as_file().metadata();
    own.is_ok_and(|own| other.nlink() == 1 && (own.uid(), own.gid()) == (other.uid(), other.gid()))
}

#[cfg(not(unix))]
fn takes_its_place(_: &tempfile::NamedTempFile, _: &std::fs::Metadata) -> bool {
    true
}

/// Makes a file piece by piece beside its place and moves it there once it is complete. A link stays, and the file that it
/// leads to is made; what is no file, as a device or a pipe, gets the content itself, and so does the standard output.
pub(crate) fn write_with(
    path: &Path,
    make: impl FnOnce(&mut std::fs::File) -> std::io::Result<()>,
) -> Result<(), String> {
    let at_once = opened_at_once(path).map_err(|error| cannot_write(path, &error))?;
    if let Some(mut open) = at_once {
        return make(&mut open).map_err(|error| cannot_write(path, &error));
    }
    let place = leads_to(path);
    let path = place.as_path();
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."));
    let failed = |error: std::io::Error| cannot_write(path, &error);
    let mut file = tempfile::Builder::new()
        .prefix(UNFINISHED)
        .tempfile_in(folder)
        .map_err(failed)?;
    make(file.as_file_mut())
        .and_then(|()| file.as_file().sync_all())
        .map_err(failed)?;
    make_readable(&file).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    sync_folder(folder)
}

/// What has to be written itself, opened: a device, a pipe, the standard output. Another file in its place would take it away.
#[cfg(unix)]
fn opened_at_once(path: &Path) -> std::io::Result<Option<std::fs::File>> {
    use std::os::fd::AsFd as _;
    use std::os::unix::fs::MetadataExt as _;
    let Ok(facts) = std::fs::metadata(path) else {
        return Ok(None);
    };
    if facts.is_dir() {
        return Ok(None);
    }
    // What is already in the file that the standard output leads to stays before this.
    let output = std::io::stdout().as_fd().try_clone_to_owned();
    if let Ok(output) = output.map(std::fs::File::from) {
        let own = output.metadata();
        if own.is_ok_and(|own| (own.dev(), own.ino()) == (facts.dev(), facts.ino())) {
            return Ok(Some(output));
        }
    }
    if facts.is_file() {
        return Ok(None);
    }
    std::fs::OpenOptions::new().write(true).open(path).map(Some)
}

#[cfg(not(unix))]
fn opened_at_once(_: &Path) -> std::io::Result<Option<std::fs::File>> {
    Ok(None)
}

/// Where links lead from a path, to a file that need not be there; the path itself where they go round.
fn leads_to(path: &Path) -> PathBuf {
    /// So many links one after the other lead nowhere.
    const MOST: usize = 40;
    let mut place = path.to_path_buf();
    for _ in 0..MOST {
        let Ok(next) = std::fs::read_link(&place) else {
            return place;
        };
        // A link is read from the folder that it is in.
        place = place.parent().unwrap_or(Path::new("")).join(next);
    }
    path.to_path_buf()
}

/// Removes what a process that was killed has left of files that it was writing, in a folder and in those below. Only who has
/// the folder alone may do so.
#[allow(clippy::disallowed_methods, reason = "the command line removes files")]
pub(crate) fn remove_unfinished(folder: &Path) {
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_folder {
            remove_unfinished(&entry.path());
        } else if entry.file_name().to_string_lossy().starts_with(UNFINISHED) {
            // What cannot be removed does no harm.
            drop(std::fs::remove_file(entry.path()));
        }
    }
}

/// Opens a file for reading.
#[allow(clippy::disallowed_methods, reason = "the command line opens files")]
pub(crate) fn open(path: &Path) -> Result<std::fs::File, String> {
    std::fs::File::open(path).map_err(|error| cannot_read(path, &error))
}

/// Opens a file for locking, and makes it if it is not there.
pub(crate) fn open_lock(path: &Path) -> Result<std::fs::File, String> {
    let options = std::fs::OpenOptions::new()
        .create(true)
        .truncate(false)
        .write(true)
        .open(path);
    options.map_err(|error| cannot_write(path, &error))
}

/// Makes a file with a name that nobody has, for writing.
pub(crate) fn make_own(folder: &Path, ending: &str) -> Result<(std::fs::File, PathBuf), String> {
    let failed = |error: std::io::Error| cannot_write(folder, &error);
    let file = tempfile::Builder::new()
        .prefix("part-")
        .suffix(ending)
        .tempfile_in(folder)
        .map_err(failed)?;
    make_readable(&file).map_err(failed)?;
    file.keep().map_err(|error| failed(error.error))
}

/// Waits until the names in a folder are on the disk.
#[allow(clippy::disallowed_methods, reason = "the command line opens files")]
pub(crate) fn sync_folder(folder: &Path) -> Result<(), String> {
    let opened = std::fs::File::open(folder).and_then(|folder| folder.sync_all());
    opened.map_err(|error| cannot_write(folder, &error))
}

/// That a file cannot be read, and why.
pub(crate) fn cannot_read(path: &Path, error: &std::io::Error) -> String {
    format!("cannot read `{}`: {}", path.display(), reason(error))
}

/// That a file cannot be written, and why.
pub(crate) fn cannot_write(path: &Path, error: &std::io::Error) -> String {
    format!("cannot write `{}`: {}", path.display(), reason(error))
}

/// Removes a file, if there is one.
#[allow(clippy::disallowed_methods, reason = "the command line removes files")]
pub(crate) fn remove(path: &Path) -> Result<(), String> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(format!(
            "cannot remove `{}`: {}",
            path.display(),
            reason(&error)
        )),
        Ok(()) | Err(_) => Ok(()),
    }
}

/// A temporary file is private; a result is as readable as the folder's other files.
#[cfg(unix)]
fn make_readable(file: &tempfile::NamedTempFile) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt as _;
    file.as_file()
        .set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_: &tempfile::NamedTempFile) -> std::io::Result<()> {
    Ok(())
}

#[cfg(all(test, unix))]
#[allow(
    clippy::unwrap_used,
    clippy::disallowed_methods,
    reason = "a test writes files, and may panic"
)]
mod tests {
    use super::*;
    use std::os::unix::fs::{PermissionsExt as _, symlink};

    #[test]
    fn a_file_that_is_written_anew_stays_the_file_that_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let (own, link, second) = (place("own.hyde"), place("link.hyde"), place("second.hyde"));
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
        std::fs::write(&own, "one").unwrap();
        std::fs::set_permissions(&own, std::fs::Permissions::from_mode(0o640)).unwrap();
        symlink("own.hyde", &link).unwrap();
        rewrite(&link, b"two").unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read(&own).unwrap(), b"two");
        assert_eq!(mode(&own), 0o640);
        std::fs::hard_link(&own, &second).unwrap();
        rewrite(&own, b"three").unwrap();
        assert_eq!(std::fs::read(&second).unwrap(), b"three");
        std::fs::set_permissions(&own, std::fs::Permissions::from_mode(0o444)).unwrap();
        let refused = rewrite(&own, b"four").unwrap_err();
        assert!(refused.ends_with("the file is read-only"), "{refused}");
        assert_eq!(std::fs::read(&second).unwrap(), b"three");
    }
    #[test]
    fn a_link_stays_and_a_pipe_gets_the_content_itself() {
        let folder = tempfile::tempdir().unwrap();
        let place = |name: &str| folder.path().join(name);
        let (own, link, later) = (place("own.csv"), place("link.csv"), place("later.csv"));
        std::fs::write(&own, "one").unwrap();
        symlink("own.csv", &link).unwrap();
        write(&link, b"two").unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read(&own).unwrap(), b"two");
        // A link may lead to what is only made now, by way of another link.
        symlink("far.csv", place("near.csv")).unwrap();
        symlink("near.csv", &later).unwrap();
        write(&later, b"three").unwrap();
        assert!(std::fs::symlink_metadata(&later).unwrap().is_symlink());
        assert_eq!(std::fs::read(place("far.csv")).unwrap(), b"three");
        let pipe = place("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.unwrap().success());
        let end = pipe.clone();
        let reader = std::thread::spawn(move || std::fs::read(end).unwrap());
        write(&pipe, b"four").unwrap();
        assert_eq!(reader.join().unwrap(), b"four");
        assert!(!std::fs::symlink_metadata(&pipe).unwrap().is_file());
    }
}
