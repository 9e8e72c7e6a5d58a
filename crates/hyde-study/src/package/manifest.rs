//! `hyde.toml`: what a package is called, where its files are, and what it depends on.
//!
//! ```toml
//! name = "seals"
//! version = "0.2.0"
//! description = "Seals and wipers of feed drives"
//! licence = "MIT"
//! folders = ["models"]              # where its files are; the manifest's own folder if left out
//! data = ["data/grease.csv"]        # what `table` may read
//!
//! [dependencies]
//! guides = "../guides"              # a folder with a manifest of that name
//! ```

use super::{MANIFEST, is_inside, links_out};
use crate::refusals::packages as refused;
use crate::world::{World, read_text};
use hyde_diag::{Diagnostic, Diagnostics, FileId, Sources, Span};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;

/// A manifest that was read.
#[derive(Debug)]
pub struct Manifest {
    /// The package that its files begin with.
    pub name: String,
    /// Three numbers.
    pub version: String,
    /// What it is, in a line; may be empty.
    pub description: String,
    /// May be empty.
    pub licence: String,
    /// Below the manifest's folder; `.` is that itself.
    pub folders: Vec<String>,
    /// Below the manifest's folder.
    pub data: Vec<String>,
    /// Packages that its files may import beside its own.
    pub dependencies: Vec<Dependency>,
}

/// `name = "../path"`
#[derive(Clone, Debug)]
pub struct Dependency {
    /// The name of its manifest.
    pub name: String,
    /// Relative to this manifest's folder.
    pub path: String,
    span: Span,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    name: Spanned<String>,
    version: Spanned<String>,
    #[serde(default)]
    description: String,
    #[serde(default)]
    licence: String,
    #[serde(default)]
    folders: Vec<Spanned<String>>,
    #[serde(default)]
    data: Vec<Spanned<String>>,
    #[serde(default)]
    dependencies: BTreeMap<String, Spanned<String>>,
}

/// Reads the manifest of a folder; what is wrong with it is reported.
pub(super) fn read(
    world: &dyn World,
    folder: &Path,
    sources: &mut Sources,
    diagnostics: &mut Diagnostics,
) -> Option<Manifest> {
    let path = folder.join(MANIFEST);
    let text = match read_text(world, &path) {
        Ok(text) => text,
        Err(reason) => {
            diagnostics.push(refused::unreadable_manifest(&reason));
            return None;
        }
    };
    let id = sources.add(path.to_string_lossy(), text.as_str());
    let written: Written = match toml::from_str(&text) {
        Ok(written) => written,
        Err(error) => {
            diagnostics.push(not_understood(id, &error));
            return None;
        }
    };
    let before = diagnostics.error_count();
    let mut reader = Reader {
        world,
        folder,
        id,
        diagnostics,
    };
    let manifest = reader.checked(written);
    (diagnostics.error_count() == before).then_some(manifest)
}

struct Reader<'r> {
    world: &'r dyn World,
    folder: &'r Path,
    id: FileId,
    diagnostics: &'r mut Diagnostics,
}

impl Reader<'_> {
    fn checked(&mut self, written: Written) -> Manifest {
        if !is_name(written.name.get_ref()) {
            let span = self.span(&written.name);
            self.diagnostics
                .push(refused::not_a_name(written.name.get_ref(), span));
        }
        let version = written.version.get_ref().split('.');
        let numbers = version.map(str::parse::<u32>).collect::<Vec<_>>();
        if numbers.len() != 3 || numbers.iter().any(Result::is_err) {
            let span = self.span(&written.version);
            self.diagnostics
                .push(refused::not_a_version(written.version.get_ref(), span));
        }
        for folder in &written.folders {
            self.below(folder, true);
        }
        for file in &written.data {
            self.below(file, false);
        }
        let dependencies = written.dependencies.into_iter().map(|(name, path)| {
            if Path::new(path.get_ref()).is_absolute() {
                let span = self.span(&path);
                self.diagnostics.push(refused::absolute_path(&name, span));
            }
            Dependency {
                name,
                span: self.span(&path),
                path: path.into_inner(),
            }
        });
        let dependencies = dependencies.collect();
        let plain = |list: Vec<Spanned<String>>| list.into_iter().map(Spanned::into_inner);
        let folders: Vec<String> = plain(written.folders).collect();
        Manifest {
            name: written.name.into_inner(),
            version: written.version.into_inner(),
            description: written.description,
            licence: written.licence,
            folders: if folders.is_empty() {
                vec![".".to_owned()]
            } else {
                folders
            },
            data: plain(written.data).collect(),
            dependencies,
        }
    }

    /// Reports a declared folder or file that is not there, or not below the manifest's folder.
    fn below(&mut self, path: &Spanned<String>, folder: bool) {
        let written = path.get_ref();
        let place = self.folder.join(written);
        if !is_inside(written) || links_out(self.world, self.folder, &place) {
            let span = self.span(path);
            self.diagnostics
                .push(refused::outside_package(written, span));
        } else if !(match folder {
            true => self.world.is_folder(&place),
            false => self.world.is_file(&place),
        }) {
            let what = if folder { "folder" } else { "file" };
            let span = self.span(path);
            self.diagnostics
                .push(refused::nothing_there(written, span, what));
        }
    }

    fn span(&self, at: &Spanned<String>) -> Span {
        Span::new(self.id, at.span().start, at.span().end)
    }
}

impl Dependency {
    /// There is no package where the dependency says.
    pub(super) fn missing(&self, folder: &Path) -> Diagnostic {
        refused::no_manifest(&folder.join(MANIFEST), &self.name, self.span)
    }

    /// The path leads to the manifest that names the dependency.
    pub(super) fn itself(&self) -> Diagnostic {
        refused::depends_on_itself(&self.path, self.span)
    }

    /// The package there has another name.
    pub(super) fn other_name(&self, name: &str) -> Diagnostic {
        refused::other_name(name, (&self.name, &self.path), self.span)
    }
}

fn not_understood(id: FileId, error: &toml::de::Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    let message = error.message().lines().next().unwrap_or_default();
    refused::bad_manifest(message, Span::new(id, span.start, span.end))
}

fn is_name(name: &str) -> bool {
    name.split('.').all(|word| {
        let letters = word.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        letters && word.starts_with(|c: char| c.is_ascii_alphabetic())
    })
}
