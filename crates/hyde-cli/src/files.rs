//! Files: read whole, written whole or not at all.

use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

/// Reads a file; the error says which and why.
#[allow(clippy::disallowed_methods, reason = "the command line opens files")]
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("`{}`: {}", path.display(), reason(&error)))
}

/// Reads a text file.
pub(crate) fn read_text(path: &Path) -> Result<String, String> {
    as_text(path, read(path)?)
}

/// The content of a file as text, without the byte order mark that some editors put before it.
pub(crate) fn as_text(path: &Path, bytes: Vec<u8>) -> Result<String, String> {
    let text = String::from_utf8(bytes)
        .map_err(|_| format!("`{}` is not UTF-8 text: save it as UTF-8", path.display()))?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

/// Whether there is a file.
pub(crate) fn is_file(path: &Path) -> bool {
    path.is_file()
}

/// Whether there is a folder.
pub(crate) fn is_folder(path: &Path) -> bool {
    path.is_dir()
}

/// The path without links and dots, if there is something.
#[allow(clippy::disallowed_methods, reason = "the command line opens files")]
pub(crate) fn real(path: &Path) -> Option<PathBuf> {
    std::fs::canonicalize(path).ok()
}

/// The files with an ending below a folder, in the order of their names. Hidden folders, links to folders, and folders
/// that have a file called `border` are not entered.
#[allow(clippy::disallowed_methods, reason = "the command line opens files")]
pub(crate) fn below(folder: &Path, ending: &str, border: &str) -> Vec<PathBuf> {
    let here = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let mut found = Vec::new();
    for entry in std::fs::read_dir(here).into_iter().flatten().flatten() {
        let path = folder.join(entry.file_name());
        let hidden = entry.file_name().to_string_lossy().starts_with('.');
        let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
        if is_folder && !hidden && !path.join(border).is_file() {
            found.extend(below(&path, ending, border));
        } else if !is_folder && path.extension().is_some_and(|end| end == ending) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// The files below a folder that a pattern names, in the order of their names: `*` and `?` stand for any characters of one
/// file's or folder's name. A pattern that leaves the folder names none.
#[allow(clippy::disallowed_methods, reason = "the command line opens files")]
pub(crate) fn matching(folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let mut found = vec![folder.to_path_buf()];
    for part in Path::new(pattern).components() {
        let std::path::Component::Normal(part) = part else {
            if part == std::path::Component::CurDir {
                continue;
            }
            return Vec::new();
        };
        let part = part.to_string_lossy();
        let mut next = Vec::new();
        for place in found {
            let here = if place.as_os_str().is_empty() {
                Path::new(".")
            } else {
                &place
            };
            for entry in std::fs::read_dir(here).into_iter().flatten().flatten() {
                if fits(&entry.file_name().to_string_lossy(), &part) {
                    next.push(place.join(entry.file_name()));
                }
            }
        }
        found = next;
    }
    found.retain(|path| path.is_file());
    found.sort();
    found
}

/// Whether a name is one that a pattern stands for.
fn fits(name: &str, pattern: &str) -> bool {
    let (name, pattern): (Vec<char>, Vec<char>) =
        (name.chars().collect(), pattern.chars().collect());
    // Whether the rest of the pattern from `p` stands for the rest of the name from `n`, from the end backwards.
    let mut rest = vec![vec![false; pattern.len() + 1]; name.len() + 1];
    rest[name.len()][pattern.len()] = true;
    for n in (0..=name.len()).rev() {
        for p in (0..pattern.len()).rev() {
            rest[n][p] = match pattern[p] {
                '*' => rest[n][p + 1] || (n < name.len() && rest[n + 1][p]),
                '?' => n < name.len() && rest[n + 1][p + 1],
                other => n < name.len() && name[n] == other && rest[n + 1][p + 1],
            };
        }
    }
    rest[0][0]
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

/// Writes a file beside its place and moves it there once it is complete.
pub(crate) fn write(path: &Path, content: &[u8]) -> Result<(), String> {
    write_with(path, |file| file.write_all(content))
}

/// The same for a file that is made piece by piece.
pub(crate) fn write_with(
    path: &Path,
    make: impl FnOnce(&mut std::fs::File) -> std::io::Result<()>,
) -> Result<(), String> {
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

/// An error in words.
pub(crate) fn reason(error: &std::io::Error) -> String {
    const WORDS: [(ErrorKind, &str); 4] = [
        (ErrorKind::NotFound, "no such file or folder"),
        (ErrorKind::PermissionDenied, "permission denied"),
        (ErrorKind::StorageFull, "the disk is full"),
        (ErrorKind::ReadOnlyFilesystem, "the disk is read-only"),
    ];
    let known = WORDS.iter().find(|(kind, _)| *kind == error.kind());
    known.map_or_else(|| error.to_string(), |(_, words)| (*words).to_owned())
}
