//! The archive: description, library, and what the library reads.

use crate::kept::RESOURCE;
use crate::reference::Reference;
use std::fmt;
use std::io::{Cursor, Write as _};
use zip::CompressionMethod;
use zip::write::{SimpleFileOptions, ZipWriter};

/// A version of FMI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0.
    Fmi2,
    /// FMI 3.0.
    Fmi3,
}

impl Version {
    /// The folder of the libraries for Linux on x86-64.
    #[must_use]
    pub fn folder(self) -> &'static str {
        match self {
            Self::Fmi2 => "binaries/linux64",
            Self::Fmi3 => "binaries/x86_64-linux",
        }
    }

    /// The number of the version.
    #[must_use]
    pub fn number(self) -> &'static str {
        match self {
            Self::Fmi2 => "2.0",
            Self::Fmi3 => "3.0",
        }
    }
}

/// Why there is no archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArchiveError(String);

impl fmt::Display for ArchiveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Puts an FMU together: `libraries` with their names, of which the first is called as the model, `sources` with their
/// places where the texts are to be read by people, and what the FMU is expected to compute.
///
/// # Errors
/// The archive cannot be written.
pub fn archive(
    version: Version,
    description: &str,
    libraries: &[(String, Vec<u8>)],
    kept: &[u8],
    sources: &[(String, Vec<u8>)],
    reference: &Reference,
) -> Result<Vec<u8>, ArchiveError> {
    let failed = |error: &dyn fmt::Display| ArchiveError(error.to_string());
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    // The fastest level makes the library hardly longer, and its time is what an export takes.
    let packed = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(1));
    let stored = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut put = |name: &str, options: SimpleFileOptions, content: &[u8]| {
        zip.start_file(name, options).map_err(|e| failed(&e))?;
        zip.write_all(content).map_err(|e| failed(&e))
    };
    put("modelDescription.xml", packed, description.as_bytes())?;
    for (name, content) in libraries {
        let name = format!("{}/{name}", version.folder());
        put(&name, packed.unix_permissions(0o755), content)?;
    }
    put(&format!("resources/{RESOURCE}"), stored, kept)?;
    for (place, content) in sources {
        let place = place.replace(['\\', ':'], "/");
        let parts = place
            .split('/')
            .filter(|part| !matches!(*part, "" | "." | ".."));
        let place = parts.collect::<Vec<_>>().join("/");
        put(&format!("resources/source/{place}"), packed, content)?;
    }
    for (place, text) in &reference.files {
        put(place, packed, text.as_bytes())?;
    }
    let done = zip.finish().map_err(|e| failed(&e))?;
    Ok(done.into_inner())
}
