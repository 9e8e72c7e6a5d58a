//! [`World`]: where files are. The disk, or an editor's unsaved buffers over it ([`Buffers`]), or memory alone.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// Files, as a study reads them. Paths are as the user writes them.
pub trait World: Debug + Send + Sync {
    /// Reads a file.
    ///
    /// # Errors
    /// Which file cannot be read, and why.
    fn read(&self, path: &Path) -> Result<Vec<u8>, String>;

    /// Whether there is a file.
    fn is_file(&self, path: &Path) -> bool;

    /// Whether there is a folder.
    fn is_folder(&self, path: &Path) -> bool;

    /// The path without links and dots, if there is something.
    fn real(&self, path: &Path) -> Option<PathBuf>;

    /// The names in a folder: of its files, and of its folders.
    fn entries(&self, folder: &Path) -> Entries;
}

/// The names in a folder, each list in order.
#[derive(Clone, Debug, Default)]
pub struct Entries {
    /// Files, and links to files or folders.
    pub files: Vec<String>,
    /// Folders that are no links.
    pub folders: Vec<String>,
}

/// Reads a text file.
///
/// # Errors
/// Which file cannot be read, and why.
pub fn read_text(world: &dyn World, path: &Path) -> Result<String, String> {
    as_text(path, world.read(path)?)
}

/// The content of a file as text, without the byte order mark that some editors put before it.
///
/// # Errors
/// It is not UTF-8.
pub fn as_text(path: &Path, bytes: Vec<u8>) -> Result<String, String> {
    let text = String::from_utf8(bytes)
        .map_err(|_| format!("`{}` is not UTF-8 text: save it as UTF-8", path.display()))?;
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_owned(),
        None => text,
    })
}

/// The files with an ending below a folder, in the order of their names. Hidden folders, links to folders, and folders
/// that have a file called `border` are not entered.
pub fn below(world: &dyn World, folder: &Path, ending: &str, border: &str) -> Vec<PathBuf> {
    let Entries { files, folders } = world.entries(here(folder));
    let files = files.into_iter().map(|name| folder.join(name));
    let mut found: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|end| end == ending))
        .collect();
    for name in folders {
        let path = folder.join(&name);
        if !name.starts_with('.') && !world.is_file(&path.join(border)) {
            found.extend(below(world, &path, ending, border));
        }
    }
    found.sort();
    found
}

/// The files below a folder that a pattern names, in the order of their names: `*` and `?` stand for any characters of one
/// file's or folder's name. A pattern that leaves the folder names none.
pub fn matching(world: &dyn World, folder: &Path, pattern: &str) -> Vec<PathBuf> {
    let mut found = vec![folder.to_path_buf()];
    for part in Path::new(pattern).components() {
        let Component::Normal(part) = part else {
            if part == Component::CurDir {
                continue;
            }
            return Vec::new();
        };
        let part = part.to_string_lossy();
        let mut next = Vec::new();
        for place in found {
            let Entries { files, folders } = world.entries(here(&place));
            let all = files.into_iter().chain(folders);
            next.extend(
                all.filter(|name| fits(name, &part))
                    .map(|name| place.join(name)),
            );
        }
        found = next;
    }
    found.retain(|path| world.is_file(path));
    found.sort();
    found
}

/// A folder as the system wants it.
fn here(folder: &Path) -> &Path {
    match folder.as_os_str().is_empty() {
        true => Path::new("."),
        false => folder,
    }
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

/// The files of this machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

#[allow(
    clippy::disallowed_methods,
    reason = "the one place where a study opens files"
)]
impl World for Disk {
    fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        std::fs::read(path).map_err(|error| format!("`{}`: {}", path.display(), reason(&error)))
    }

    fn is_file(&self, path: &Path) -> bool {
        path.is_file()
    }

    fn is_folder(&self, path: &Path) -> bool {
        path.is_dir()
    }

    fn real(&self, path: &Path) -> Option<PathBuf> {
        std::fs::canonicalize(path).ok()
    }

    fn entries(&self, folder: &Path) -> Entries {
        let mut found = Entries::default();
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            match entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                true => found.folders.push(name),
                false => found.files.push(name),
            }
        }
        found.files.sort();
        found.folders.sort();
        found
    }
}

/// Why the system refused something.
#[must_use]
pub fn reason(error: &std::io::Error) -> String {
    const WORDS: [(ErrorKind, &str); 4] = [
        (ErrorKind::NotFound, "no such file or folder"),
        (ErrorKind::PermissionDenied, "permission denied"),
        (ErrorKind::StorageFull, "the disk is full"),
        (ErrorKind::ReadOnlyFilesystem, "the disk is read-only"),
    ];
    let known = WORDS.iter().find(|(kind, _)| *kind == error.kind());
    known.map_or_else(|| error.to_string(), |(_, words)| (*words).to_owned())
}

/// Files in memory over those of another world, which they hide: what an editor has not saved yet. Over nothing, they are
/// all there is.
#[derive(Clone, Debug, Default)]
pub struct Buffers {
    under: Option<Arc<dyn World>>,
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl Buffers {
    /// None yet, over another world.
    #[must_use]
    pub fn over(world: Arc<dyn World>) -> Self {
        Self {
            under: Some(world),
            files: BTreeMap::new(),
        }
    }

    /// Puts a file there, or another content into it.
    pub fn put(&mut self, path: impl Into<PathBuf>, content: impl Into<Vec<u8>>) {
        self.files.insert(path.into(), content.into());
    }

    /// Forgets a file: that of the world below is seen again.
    pub fn remove(&mut self, path: &Path) {
        self.files.remove(path);
    }

    fn has_folder(&self, folder: &Path) -> bool {
        self.files
            .keys()
            .any(|path| path.parent().is_some_and(|own| own.starts_with(folder)))
    }
}

impl World for Buffers {
    fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        match (self.files.get(path), &self.under) {
            (Some(content), _) => Ok(content.clone()),
            (None, Some(world)) => world.read(path),
            (None, None) => Err(format!("`{}`: there is no such file", path.display())),
        }
    }

    fn is_file(&self, path: &Path) -> bool {
        self.files.contains_key(path) || self.under.as_ref().is_some_and(|own| own.is_file(path))
    }

    fn is_folder(&self, path: &Path) -> bool {
        self.has_folder(path) || self.under.as_ref().is_some_and(|own| own.is_folder(path))
    }

    fn real(&self, path: &Path) -> Option<PathBuf> {
        let under = self.under.as_ref().and_then(|own| own.real(path));
        under.or_else(|| {
            let own = self.files.contains_key(path) || self.has_folder(path);
            own.then(|| path.to_path_buf())
        })
    }

    fn entries(&self, folder: &Path) -> Entries {
        let mut found = self
            .under
            .as_ref()
            .map(|own| own.entries(folder))
            .unwrap_or_default();
        let folder = match folder == Path::new(".") {
            true => Path::new(""),
            false => folder,
        };
        for path in self.files.keys() {
            let mut rest = path.strip_prefix(folder).into_iter().flatten();
            let Some(name) = rest.next().map(|name| name.to_string_lossy().into_owned()) else {
                continue;
            };
            let list = match rest.next() {
                Some(_) => &mut found.folders,
                None => &mut found.files,
            };
            list.push(name);
        }
        for list in [&mut found.files, &mut found.folders] {
            list.sort();
            list.dedup();
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pattern_names_the_files_of_a_folder_and_no_others() {
        let mut world = Buffers::default();
        for path in [
            "runs/fit-1.csv",
            "runs/fit-2.csv",
            "runs/old/fit-3.csv",
            "other.csv",
        ] {
            world.put(path, "");
        }
        let found = |pattern: &str| matching(&world, Path::new("runs"), pattern);
        assert_eq!(found("fit-?.csv").len(), 2);
        assert_eq!(found("*/fit-*.csv"), [Path::new("runs/old/fit-3.csv")]);
        assert_eq!(found("../other.csv").len(), 0);
        assert_eq!(
            matching(&world, Path::new(""), "*.csv"),
            [Path::new("other.csv")]
        );
    }

    #[test]
    fn a_buffer_hides_the_file_below_it_until_it_is_removed() {
        let mut saved = Buffers::default();
        saved.put("a.hyde", "saved");
        let mut world = Buffers::over(Arc::new(saved));
        let text = |world: &Buffers| read_text(world, Path::new("a.hyde"));
        assert_eq!(text(&world).as_deref(), Ok("saved"));
        world.put("a.hyde", "\u{feff}unsaved");
        assert_eq!(text(&world).as_deref(), Ok("unsaved"));
        world.remove(Path::new("a.hyde"));
        assert_eq!(text(&world).as_deref(), Ok("saved"));
        assert!(read_text(&world, Path::new("b.hyde")).is_err());
    }

    #[test]
    fn below_a_border_nothing_is_found() {
        let mut world = Buffers::default();
        for path in [
            "p/a.hyde",
            "p/in/b.hyde",
            "p/other/hyde.toml",
            "p/other/c.hyde",
            "p/.git/d.hyde",
        ] {
            world.put(path, "");
        }
        let found = below(&world, Path::new("p"), "hyde", "hyde.toml");
        assert_eq!(found, [Path::new("p/a.hyde"), Path::new("p/in/b.hyde")]);
    }
}
