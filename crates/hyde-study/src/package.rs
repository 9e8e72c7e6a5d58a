//! Packages beyond the library: files beside the model, or a folder with a manifest, and the packages it depends on.
//!
//! ```text
//! seals/hyde.toml                 name, version, folders, data, dependencies: see `manifest`
//! seals/models/lip/soft.hyde      package lip.soft;     with folders = ["models"]
//! seals/data/grease.csv           table(v, "data/grease.csv")     with data = ["data/grease.csv"]
//! ```
//! Without a manifest a model's own folder is searched, and `table` reads files below it. No file is read but those that
//! are named so, and none outside the folder it is declared below: a symbolic link that leads out is refused.

mod manifest;

use crate::refusals::packages as refused;
use crate::world::{World, below, read_text};
use hyde_diag::{Diagnostic, Diagnostics, Sources};
pub use manifest::Manifest;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// The name of a manifest.
pub const MANIFEST: &str = "hyde.toml";

/// A folder that packages are found in, with what its manifest says.
#[derive(Debug)]
pub struct Root {
    /// As printed.
    pub folder: PathBuf,
    /// `None` of a model without one.
    pub manifest: Option<Manifest>,
    /// The roots that it depends on, by the name of their manifest.
    dependencies: Vec<usize>,
}

/// The packages that a model can import: its own root first, then all that it depends on, near or far.
#[derive(Debug)]
pub struct Roots {
    world: Arc<dyn World>,
    /// The model's own root first.
    pub roots: Vec<Root>,
    /// The root of each file that was found, by its place.
    owners: RefCell<BTreeMap<String, usize>>,
}

impl Roots {
    /// The root of a model's file, found by the nearest manifest in its folder or above, and what it depends on. What is
    /// wrong with a manifest is reported.
    pub fn of(
        world: &Arc<dyn World>,
        file: &Path,
        sources: &mut Sources,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let beside = file.parent().unwrap_or(Path::new("")).to_path_buf();
        match nearest_manifest(world.as_ref(), &beside) {
            Some(folder) => Self::at(world, &folder, sources, diagnostics),
            None => Self::new(
                world,
                vec![Root {
                    folder: beside,
                    manifest: None,
                    dependencies: Vec::new(),
                }],
            ),
        }
    }

    /// The root of a folder with a manifest.
    pub fn at(
        world: &Arc<dyn World>,
        folder: &Path,
        sources: &mut Sources,
        diagnostics: &mut Diagnostics,
    ) -> Self {
        let mut roots = vec![Root {
            folder: lexical(folder),
            manifest: manifest::read(world.as_ref(), folder, sources, diagnostics),
            dependencies: Vec::new(),
        }];
        let mut at = 0;
        while at < roots.len() {
            let wanted = roots[at].manifest.iter();
            let wanted: Vec<_> = wanted.flat_map(|m| m.dependencies.clone()).collect();
            for dependency in wanted {
                let folder = lexical(&roots[at].folder.join(&dependency.path));
                let known = roots
                    .iter()
                    .position(|root| same(world.as_ref(), &root.folder, &folder));
                let number = match known {
                    Some(number) => number,
                    None if world.is_file(&folder.join(MANIFEST)) => {
                        roots.push(Root {
                            manifest: manifest::read(world.as_ref(), &folder, sources, diagnostics),
                            folder,
                            dependencies: Vec::new(),
                        });
                        roots.len() - 1
                    }
                    None => {
                        diagnostics.push(dependency.missing(&folder));
                        continue;
                    }
                };
                if number == at {
                    diagnostics.push(dependency.itself());
                    continue;
                }
                if let Some(manifest) = &roots[number].manifest
                    && manifest.name != dependency.name
                {
                    diagnostics.push(dependency.other_name(&manifest.name));
                }
                roots[at].dependencies.push(number);
            }
            at += 1;
        }
        Self::new(world, roots)
    }

    fn new(world: &Arc<dyn World>, roots: Vec<Root>) -> Self {
        Self {
            world: Arc::clone(world),
            roots,
            owners: RefCell::default(),
        }
    }

    /// The place and text of a package, as the file at `importer` may import it.
    pub fn find(
        &self,
        importer: &str,
        package: &str,
    ) -> Result<Option<(String, String)>, Diagnostic> {
        let own = self.owner(importer);
        let mut found: Vec<(usize, PathBuf)> = Vec::new();
        for number in std::iter::once(own).chain(self.roots[own].dependencies.iter().copied()) {
            let places = self.roots[number].places(self.world.as_ref(), package)?;
            found.extend(places.into_iter().map(|place| (number, place)));
        }
        match found.as_slice() {
            [(number, place)] => {
                let text = read_text(self.world.as_ref(), place)
                    .map_err(|reason| refused::unreadable(&reason))?;
                let place = place.to_string_lossy().into_owned();
                self.owners.borrow_mut().insert(place.clone(), *number);
                Ok(Some((place, text)))
            }
            [(_, first), (_, second), ..] => Err(refused::in_two_places(package, first, second)),
            [] => self.beyond(own, package),
        }
    }

    /// A package that only a dependency of a dependency has: told, for it is not declared.
    fn beyond(&self, own: usize, package: &str) -> Result<Option<(String, String)>, Diagnostic> {
        for (number, root) in self.roots.iter().enumerate() {
            let known = number == own || self.roots[own].dependencies.contains(&number);
            if known || root.places(self.world.as_ref(), package)?.is_empty() {
                continue;
            }
            let name = root.manifest.as_ref().map_or("", |m| m.name.as_str());
            let manifest = self.roots[own].folder.join(MANIFEST);
            return Err(refused::not_a_dependency(
                package,
                name,
                &manifest,
                &root.folder,
            ));
        }
        Ok(None)
    }

    /// The path of a data file that the file at `importer` names.
    pub fn data(&self, importer: &str, path: &str) -> Result<PathBuf, Diagnostic> {
        let root = &self.roots[self.owner(importer)];
        if !is_inside(path) {
            return Err(refused::outside(path, "the package's folder"));
        }
        let Some(manifest) = &root.manifest else {
            let place = root.folder.join(path);
            return match links_out(self.world.as_ref(), &root.folder, &place) {
                true => Err(refused::outside(path, "the model's folder")),
                false => Ok(place),
            };
        };
        if !manifest.data.iter().any(|known| known == path) {
            let place = root.folder.join(MANIFEST);
            return Err(refused::not_among_data(path, &manifest.name, &place));
        }
        Ok(root.folder.join(path))
    }

    /// The packages of the model's own root, by name, each with its file; none without a manifest.
    pub fn own_packages(&self) -> Vec<(String, PathBuf)> {
        let own = self.roots.first();
        own.map_or_else(Vec::new, |root| root.packages(self.world.as_ref()))
    }

    /// The files of the packages that the model's own root depends on, near or far.
    pub fn packages_depended_on(&self) -> Vec<PathBuf> {
        let others = self.roots.iter().skip(1);
        let packages = others.flat_map(|root| root.packages(self.world.as_ref()));
        packages.map(|(_, place)| place).collect()
    }

    /// The name that a file of the model's own root has by its place.
    pub fn name_of(&self, file: &Path) -> Option<String> {
        let packages = self.own_packages();
        let found = packages
            .into_iter()
            .find(|(_, place)| same(self.world.as_ref(), place, file));
        found.map(|(name, _)| name)
    }

    /// The name that a file at a place without links has, or would have if it were there.
    pub fn name_at(&self, file: &Path) -> Option<String> {
        let root = &self.roots[0];
        let folders = root.manifest.iter().flat_map(|manifest| &manifest.folders);
        let mut tops = folders.filter_map(|folder| self.world.real(&inside(&root.folder, folder)));
        tops.find_map(|top| file.strip_prefix(&top).ok().map(dotted))
    }

    fn owner(&self, place: &str) -> usize {
        self.owners.borrow().get(place).copied().unwrap_or(0)
    }
}

impl Root {
    /// Its packages, by name, each with its file; none without a manifest.
    fn packages(&self, world: &dyn World) -> Vec<(String, PathBuf)> {
        let Some(manifest) = &self.manifest else {
            return Vec::new();
        };
        let mut found = Vec::new();
        for folder in &manifest.folders {
            let top = inside(&self.folder, folder);
            for place in below(world, &top, "hyde", MANIFEST) {
                if let Ok(name) = place.strip_prefix(&top)
                    && !links_out(world, &top, &place)
                {
                    found.push((dotted(name), place));
                }
            }
        }
        found.sort();
        found
    }

    /// The files that a package may be in: one below each of the folders, where it is there.
    fn places(&self, world: &dyn World, package: &str) -> Result<Vec<PathBuf>, Diagnostic> {
        let file = format!("{}.hyde", package.replace('.', "/"));
        let folders = match &self.manifest {
            Some(manifest) => manifest.folders.clone(),
            None => vec![".".to_owned()],
        };
        let mut found = Vec::new();
        for folder in folders {
            let top = inside(&self.folder, &folder);
            let place = top.join(&file);
            if !world.is_file(&place) {
                continue;
            }
            if links_out(world, &top, &place) {
                return Err(refused::outside(&place.to_string_lossy(), "its folder"));
            }
            found.push(place);
        }
        Ok(found)
    }
}

/// Whether a path stays below where it starts, links apart.
pub fn is_inside(path: &str) -> bool {
    let mut parts = Path::new(path).components();
    parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
}

/// Whether a path that is there leads out of a folder by a link.
pub fn links_out(world: &dyn World, folder: &Path, path: &Path) -> bool {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    match (world.real(folder), world.real(path)) {
        (Some(folder), Some(path)) => !path.starts_with(folder),
        _ => false,
    }
}

/// Whether two paths lead to one folder or file; an empty path is the folder that one is in.
fn same(world: &dyn World, a: &Path, b: &Path) -> bool {
    let real = |path: &Path| match path.as_os_str().is_empty() {
        true => world.real(Path::new(".")),
        false => world.real(path),
    };
    real(a).is_some_and(|known| real(b) == Some(known))
}

/// A folder below another; `.` is that one itself.
fn inside(folder: &Path, below: &str) -> PathBuf {
    let below = Path::new(below).components();
    let below = below.filter(|part| matches!(part, Component::Normal(_)));
    below.fold(folder.to_path_buf(), |path, part| path.join(part))
}

/// `a/b.hyde` as `a.b`.
fn dotted(file: &Path) -> String {
    let parts = file.with_extension("");
    let parts: Vec<String> = parts
        .components()
        .map(|part| part.as_os_str().to_string_lossy().into_owned())
        .collect();
    parts.join(".")
}

/// The nearest folder with a manifest, going up.
fn nearest_manifest(world: &dyn World, start: &Path) -> Option<PathBuf> {
    let here = if start.as_os_str().is_empty() {
        Path::new(".")
    } else {
        start
    };
    let depth = world.real(here)?.components().count();
    let mut folder = start.to_path_buf();
    for _ in 0..depth {
        if world.is_file(&folder.join(MANIFEST)) {
            return Some(folder);
        }
        folder = match folder.file_name() {
            Some(_) => folder.parent()?.to_path_buf(),
            None => folder.join(".."),
        };
    }
    None
}

/// A path without `a/..`, as printed.
fn lexical(path: &Path) -> PathBuf {
    let mut found = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if found.file_name().is_some() => {
                found.pop();
            }
            Component::CurDir => {}
            part @ (Component::ParentDir
            | Component::Normal(_)
            | Component::RootDir
            | Component::Prefix(_)) => found.push(part),
        }
    }
    found
}
