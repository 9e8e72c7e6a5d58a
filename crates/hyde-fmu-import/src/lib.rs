//! FMUs of other tools as components of a model: `model Controller = fmu("controller.fmu", step = 1 [ms]);`.
//!
//! [`Fmu`] reads the archive: its description ([`description`]) becomes the interface of a model ([`interface`]) whose clock
//! is the communication step. A run makes instances ([`InProcess`]): the archive is unpacked to a temporary folder
//! (`unpacked.rs`), its library loaded, and the functions of FMI 2.0 or 3.0 called at each tick (`instance.rs`). An FMU for
//! model exchange is integrated between them (`exchange.rs`). [`host`] does the same in another process, which a library that
//! crashes ends alone.

pub mod description;
mod description_units;
mod dormand_prince;
mod exchange;
mod fmi_2_0;
mod fmi_3_0;
pub mod host;
mod instance;
pub mod interface;
mod library;
mod log;
mod unpacked;

pub use description::{Description, Use, Version};
pub use instance::InProcess;
pub use interface::Interface;

use std::io::Read as _;

/// The platform whose libraries can be loaded, as FMI 3.0 and FMI 2.0 call it.
pub(crate) const PLATFORM: (&str, &str) = ("x86_64-linux", "linux64");

/// An FMU that was read and can be used here.
#[derive(Debug)]
pub struct Fmu {
    /// The file as the model names it.
    pub file: String,
    /// What it says of itself.
    pub description: Description,
    /// What it is to a model.
    pub interface: Interface,
    /// The library of this platform in the archive.
    pub(crate) library: String,
    /// The archive.
    pub content: Vec<u8>,
}

/// Why a file is not an FMU that can be used here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unusable {
    /// What is wrong with it.
    pub what: String,
    /// What to do.
    pub help: String,
}

impl Unusable {
    pub(crate) fn new(what: impl Into<String>, help: impl Into<String>) -> Self {
        Self {
            what: what.into(),
            help: help.into(),
        }
    }
}

impl Fmu {
    /// Reads an archive. `model` is the name of the model that stands for it, `package` that of the package around it.
    ///
    /// # Errors
    /// It is not an FMU, or not one that can be used here.
    pub fn read(
        file: &str,
        content: Vec<u8>,
        package: &str,
        model: &str,
    ) -> Result<Self, Unusable> {
        let not_an_fmu = |why: String| {
            Unusable::new(
                format!("`{file}` is not an FMU: {why}"),
                "name a file that a tool has exported as an FMU: a zip archive with a `modelDescription.xml`",
            )
        };
        let mut archive = zip::ZipArchive::new(std::io::Cursor::new(content.as_slice()))
            .map_err(|error| not_an_fmu(error.to_string()))?;
        let mut text = String::new();
        archive
            .by_name("modelDescription.xml")
            .map_err(|_| not_an_fmu("it has no `modelDescription.xml`".to_owned()))?
            .read_to_string(&mut text)
            .map_err(|error| not_an_fmu(format!("`modelDescription.xml`: {error}")))?;
        let mut description = Description::parse(file, &text)?;
        let names: Vec<String> = archive
            .file_names()
            .filter_map(|name| Some(name.ok()?.into_owned()))
            .collect();
        let library = description.library(file, names.iter().map(String::as_str))?;
        if needs_python(&mut archive, &library) {
            description.notes.push(
                "its library needs Python: that of the system is loaded before it, or that of `LD_PRELOAD`".to_owned(),
            );
        }
        let interface = Interface::of(&description, package, model);
        Ok(Self {
            file: file.to_owned(),
            description,
            interface,
            library,
            content,
        })
    }
}

/// Whether the library calls Python without bringing it along. Those that do are small; large ones are not looked into.
fn needs_python(archive: &mut zip::ZipArchive<std::io::Cursor<&[u8]>>, library: &str) -> bool {
    const LARGEST: u64 = 16 << 20;
    let mut content = Vec::new();
    let Ok(entry) = archive.by_name(library) else {
        return false;
    };
    let read = entry.take(LARGEST).read_to_end(&mut content);
    let word = b"\0PyObject_";
    read.is_ok() && content.windows(word.len()).any(|found| found == word)
}
