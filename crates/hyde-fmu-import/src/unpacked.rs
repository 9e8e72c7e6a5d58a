//! [`Unpacked`]: an FMU in a temporary folder, where its library finds its resources. The folder is removed with it.
#![allow(
    clippy::disallowed_methods,
    reason = "a library can only be loaded from a file"
)]

use crate::Fmu;
use std::fs;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// More than this is no controller but a mistake, or an archive that was made to fill the disk: bytes.
const LARGEST: u64 = 4 << 30;

/// The folder of an FMU.
pub(crate) struct Unpacked {
    folder: tempfile::TempDir,
}

impl Unpacked {
    /// Unpacks everything but sources and documentation.
    pub(crate) fn of(fmu: &Fmu) -> Result<Self, String> {
        let failed = |error: &dyn std::fmt::Display| format!("it cannot be unpacked: {error}");
        let folder = tempfile::Builder::new()
            .prefix("hyde-fmu-")
            .tempdir()
            .map_err(|error| failed(&error))?;
        let mut archive = zip::ZipArchive::new(Cursor::new(fmu.content.as_slice()))
            .map_err(|error| failed(&error))?;
        let mut size = 0;
        for number in 0..archive.len() {
            let mut entry = archive.by_index(number).map_err(|error| failed(&error))?;
            let Some(name) = entry.enclosed_name() else {
                return Err(format!(
                    "it cannot be unpacked: `{}` is outside its folder",
                    entry.name().unwrap_or_default()
                ));
            };
            if name.starts_with("sources") || name.starts_with("documentation") {
                continue;
            }
            let path = folder.path().join(name);
            if entry.is_dir() {
                fs::create_dir_all(&path).map_err(|error| failed(&error))?;
                continue;
            }
            size += entry.size();
            if size > LARGEST {
                return Err("it cannot be unpacked: it has more than 4 GB".to_owned());
            }
            if let Some(parent) = path.parent() {
                fs::create_dir_all(parent).map_err(|error| failed(&error))?;
            }
            let mut file = fs::File::create(&path).map_err(|error| failed(&error))?;
            std::io::copy(&mut entry, &mut file).map_err(|error| failed(&error))?;
        }
        let resources = folder.path().join("resources");
        fs::create_dir_all(resources).map_err(|error| failed(&error))?;
        Ok(Self { folder })
    }

    /// The folder.
    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    /// A file in it.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }
}
