//! The models of a folder of this project.

use crate::root;
use std::path::PathBuf;

/// Every `.hyde` file of a folder (relative to the project's), by name.
///
/// # Errors
/// The folder cannot be read.
#[allow(clippy::disallowed_methods, reason = "tests list their models")]
pub(crate) fn models(folder: &str) -> Result<Vec<PathBuf>, String> {
    let folder = root().join(folder);
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| path.extension().is_some_and(|ending| ending == "hyde"))
        .collect();
    paths.sort();
    Ok(paths)
}
