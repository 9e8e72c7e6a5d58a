//! The user's file and the packages it names.

use crate::library_trees;
use crate::named::{Sought, packages_named, tables_named, words_named};
use crate::parses::counted;
use crate::refusals::packages as refused;
use hyde_diag::{Diagnostic, Diagnostics, FileId, Sources, Span};
use hyde_flatten::{FmuInterface, TableFile};
use hyde_library::Package;
use hyde_syntax::ast::{self, Item};
use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

/// Parsed files, the user's first, then every package that one of them names.
#[derive(Clone)]
pub struct File {
    /// Texts and trees.
    pub files: Vec<(FileId, Arc<ast::File>)>,
    /// Types and models that none of them declares, with the packages that do.
    pub elsewhere: BTreeMap<String, Vec<String>>,
    /// The files of tables by the source file that names them and the name there: put in by who reads files.
    pub tables: BTreeMap<(FileId, String), TableFile>,
    /// The FMUs by the source file that stands for each: put in by who reads files.
    pub fmus: BTreeMap<FileId, FmuInterface>,
}

/// The place or the name of a package, and its text.
pub type Place = (String, String);

/// Finds a package for the file at a place, by its name.
pub type Find<'a> = dyn Fn(&str, &str) -> Result<Option<Place>, Diagnostic> + 'a;

/// Where packages come from besides the library.
pub struct Packages<'a> {
    /// The place and text of a package, if there is one: `find(place, name)` is asked for by the file at that place.
    /// What keeps it from being read is an error without a place yet.
    pub find: &'a Find<'a>,
    /// The name and text of every package that could be found: looked at when a name is known to none that is loaded.
    pub all: &'a dyn Fn() -> Vec<Place>,
    /// Where else packages are looked for, as in "neither in the library nor …".
    pub searched: &'a str,
    /// Every package of the library, whether named or not.
    pub whole_library: bool,
}

impl Packages<'_> {
    /// The library alone.
    pub const LIBRARY: Self = Self {
        find: &|_, _| Ok(None),
        all: &Vec::new,
        searched: "beside the file",
        whole_library: false,
    };
}

/// Parses a file and the packages it names: `import a.b.*;` names the package `a.b`. Packages may import each other.
pub fn load(
    sources: &mut Sources,
    name: &str,
    text: &str,
    packages: &Packages<'_>,
    diagnostics: &mut Diagnostics,
) -> File {
    let id = sources.add(name, text);
    let tree = counted(sources, id, diagnostics);
    let mut files = vec![(id, Arc::new(tree))];
    let own = files[0].1.package.as_ref();
    let own = own.map(|(path, _)| (path.dotted(), path.span));
    if let Some((own, span)) = &own
        && hyde_library::package(own).is_some()
        && !of_library(sources, id)
    {
        diagnostics.push(refused::hides_the_library((own, *span)));
    }
    let mut known: Vec<String> = own.map(|(own, _)| own).into_iter().collect();
    let mut first = packages_named(&files[0].1);
    if packages.whole_library {
        let whole = hyde_library::PACKAGES.iter();
        first.extend(whole.map(|p| (p.name.to_owned(), Span::new(id, 0, 0))));
    }
    add_packages(
        sources,
        &mut files,
        &mut known,
        first,
        packages,
        diagnostics,
    );
    let mut file = File {
        files,
        elsewhere: BTreeMap::new(),
        tables: BTreeMap::new(),
        fmus: BTreeMap::new(),
    };
    file.unknown_imports(packages, diagnostics);
    file.look_elsewhere(sources, packages);
    file
}

/// The sources and the file with a package of the library beside those that are loaded.
pub(crate) fn with_package(sources: &Sources, file: &File, name: &str) -> (Sources, File) {
    let (mut sources, mut file) = (sources.clone(), file.clone());
    file.add_of_library(&mut sources, [name]);
    (sources, file)
}

/// Adds packages that the first file wants, and all that these name.
fn add_packages(
    sources: &mut Sources,
    files: &mut Vec<(FileId, Arc<ast::File>)>,
    known: &mut Vec<String>,
    wanted: Vec<(String, Span)>,
    packages: &Packages<'_>,
    diagnostics: &mut Diagnostics,
) {
    let mut waiting = VecDeque::new();
    if let Some(&(first, _)) = files.first() {
        waiting.push_back((first, wanted));
    }
    while let Some((importer, wanted)) = waiting.pop_front() {
        for (name, span) in wanted {
            if known.contains(&name) {
                continue;
            }
            known.push(name.clone());
            let Some(found) = find(sources, (importer, &name, span), packages, diagnostics) else {
                continue;
            };
            let id = sources.add(found.place, found.text);
            let tree = match found.of_library {
                Some(package) => library_trees::tree(package, sources, id),
                None => {
                    let tree = counted(sources, id, diagnostics);
                    check_name(sources, id, &tree, &name, diagnostics);
                    Arc::new(tree)
                }
            };
            waiting.push_back((id, packages_named(&tree)));
            files.push((id, tree));
        }
    }
}

/// A package that was found.
struct Found {
    place: String,
    text: String,
    of_library: Option<Package>,
}

/// Whether a file is a package of the library.
fn of_library(sources: &Sources, file: FileId) -> bool {
    let text = &sources.get(file).text;
    hyde_library::PACKAGES
        .iter()
        .any(|package| package.text == *text)
}

/// The package that a file names; a name that the library has too is reported.
fn find(
    sources: &Sources,
    (importer, name, span): (FileId, &str, Span),
    packages: &Packages<'_>,
    diagnostics: &mut Diagnostics,
) -> Option<Found> {
    let of_library = hyde_library::package(name).map(|package| Found {
        place: format!("{}.hyde", name.replace('.', "/")),
        text: package.text.to_owned(),
        of_library: Some(package),
    });
    // Packages of the library import each other and nothing else.
    if self::of_library(sources, importer) {
        return of_library;
    }
    match (
        (packages.find)(&sources.get(importer).name, name),
        of_library,
    ) {
        (Err(diagnostic), _) => {
            diagnostics.push(diagnostic.label(span, "named here"));
            None
        }
        (Ok(Some((place, _))), Some(_)) => {
            diagnostics.push(refused::also_in_library(name, &place, span));
            None
        }
        (Ok(Some((place, text))), None) => Some(Found {
            place,
            text,
            of_library: None,
        }),
        (Ok(None), of_library) => of_library,
    }
}

/// Reports a package that is not called `name`, as the place of its file says.
pub fn check_name(
    sources: &Sources,
    id: FileId,
    tree: &ast::File,
    name: &str,
    diagnostics: &mut Diagnostics,
) {
    let place = &sources.get(id).name;
    let Some((path, _)) = &tree.package else {
        diagnostics.push(refused::not_declared(place, Span::new(id, 0, 0), name));
        return;
    };
    let found = path.dotted();
    if found != name {
        diagnostics.push(refused::called_otherwise((&found, path.span), place, name));
    }
}

impl File {
    /// Adds every package of the library that is not loaded yet.
    pub fn add_library(&mut self, sources: &mut Sources) {
        let names = hyde_library::PACKAGES.iter().map(|package| package.name);
        self.add_of_library(sources, names);
    }

    /// Adds packages of the library, and all that these name, to those that are loaded.
    fn add_of_library<'a>(
        &mut self,
        sources: &mut Sources,
        names: impl IntoIterator<Item = &'a str>,
    ) {
        let Some(&(first, _)) = self.files.first() else {
            return;
        };
        let own = self.files.iter();
        let own = own.filter_map(|(_, tree)| tree.package.as_ref());
        let mut known: Vec<String> = own.map(|(path, _)| path.dotted()).collect();
        let names = names.into_iter();
        let wanted = names.map(|name| (name.to_owned(), Span::new(first, 0, 0)));
        // The library has no errors: a test of its own compiles all of it.
        let mut diagnostics = Diagnostics::new();
        add_packages(
            sources,
            &mut self.files,
            &mut known,
            wanted.collect(),
            &Packages::LIBRARY,
            &mut diagnostics,
        );
    }

    /// The experiments of the user's file.
    pub fn experiments(&self) -> impl Iterator<Item = &ast::Experiment> {
        self.items().filter_map(|item| match item {
            Item::Experiment(experiment) => Some(experiment),
            Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
        })
    }

    /// The calibrations, diagnoses and sweeps of the user's file.
    pub fn studies(&self) -> impl Iterator<Item = &ast::Study> {
        self.items().filter_map(|item| match item {
            Item::Study(study) => Some(study),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) => None,
        })
    }

    /// The package that the user's file is, if it says so.
    #[must_use]
    pub fn package(&self) -> Option<String> {
        let (_, tree) = self.files.first()?;
        let (path, _) = tree.package.as_ref()?;
        Some(path.dotted())
    }

    /// Whether the user's file has a class: a model, connector, effect or function.
    #[must_use]
    pub fn has_classes(&self) -> bool {
        self.items().any(|item| matches!(item, Item::Class(_)))
    }

    /// The names of the models of the user's file.
    pub fn models(&self) -> impl Iterator<Item = &str> {
        self.items().filter_map(|item| match item {
            Item::Class(class) if class.kind == ast::ClassKind::Model => {
                Some(class.name.text.as_str())
            }
            Item::Class(_) | Item::Experiment(_) | Item::Type(_) | Item::Study(_) => None,
        })
    }

    /// The files of tables that are named, by source file and with where that is.
    #[must_use]
    pub fn tables_named(&self) -> Vec<(FileId, String, Span)> {
        let of_file = |(id, tree): &(FileId, Arc<ast::File>)| {
            let id = *id;
            let named = tables_named(tree).into_iter();
            named.map(move |(path, span)| (id, path, span))
        };
        self.files.iter().flat_map(of_file).collect()
    }

    /// The names of the effects of the user's file.
    pub fn effects(&self) -> impl Iterator<Item = &str> {
        self.items().filter_map(|item| match item {
            Item::Class(class) if class.kind == ast::ClassKind::Effect => {
                Some(class.name.text.as_str())
            }
            Item::Class(_) | Item::Experiment(_) | Item::Type(_) | Item::Study(_) => None,
        })
    }

    /// The names of the effects of all files as `with` takes them: those of packages with the package before.
    pub fn effects_known(&self) -> impl Iterator<Item = String> {
        self.files
            .iter()
            .enumerate()
            .flat_map(|(number, (_, tree))| {
                let package = tree.package.as_ref().filter(|_| number > 0);
                let package =
                    package.map_or_else(String::new, |(path, _)| format!("{}.", path.dotted()));
                tree.items.iter().filter_map(move |item| match item {
                    Item::Class(class) if class.kind == ast::ClassKind::Effect => {
                        Some(format!("{package}{}", class.name.text))
                    }
                    Item::Class(_) | Item::Experiment(_) | Item::Type(_) | Item::Study(_) => None,
                })
            })
    }

    fn items(&self) -> impl Iterator<Item = &Item> {
        self.files
            .first()
            .into_iter()
            .flat_map(|(_, file)| &file.items)
    }

    /// Whether one of the files is the package of that name.
    fn has(&self, package: &str) -> bool {
        let mut names = self
            .files
            .iter()
            .filter_map(|(_, file)| file.package.as_ref());
        names.any(|(path, _)| path.dotted() == package)
    }

    fn unknown_imports(&self, packages: &Packages<'_>, diagnostics: &mut Diagnostics) {
        if diagnostics.has_errors() {
            return; // What could not be read is reported.
        }
        for (_, file) in &self.files {
            for (package, span) in packages_named(file) {
                let imported = file.imports.iter().any(|import| import.path.span == span);
                if !imported || self.has(&package) {
                    continue;
                }
                let library = hyde_library::PACKAGES.iter();
                let library: Vec<String> = library.map(|p| format!("`{}`", p.name)).collect();
                let here = (packages.all)();
                let own: Vec<String> = here.iter().map(|(name, _)| format!("`{name}`")).collect();
                let names = hyde_library::PACKAGES.iter().map(|package| package.name);
                let names = names.chain(here.iter().map(|(name, _)| name.as_str()));
                let near = hyde_flatten::nearest(&package, names);
                let instead = hyde_syntax::instead_of(&package);
                diagnostics.push(refused::no_package(
                    (&package, span),
                    packages.searched,
                    (instead.as_deref(), near),
                    (&library, &own),
                ));
            }
        }
    }

    /// Finds the packages that have what the files name and none of them declares.
    fn look_elsewhere(&mut self, sources: &Sources, packages: &Packages<'_>) {
        let declared = |word: &str, sought: Sought| {
            ["Real", "Integer", "Boolean"].contains(&word)
                || self
                    .files
                    .iter()
                    .any(|(_, file)| declares(file, word, sought))
        };
        let own = self.files.iter();
        let own = own.filter(|(id, _)| !of_library(sources, *id));
        let mut missing: Vec<(String, Sought)> = Vec::new();
        for (word, sought) in own.flat_map(|(_, file)| words_named(file)) {
            if !declared(word, sought) && !missing.iter().any(|(known, _)| known == word) {
                missing.push((word.to_owned(), sought));
            }
        }
        if missing.is_empty() {
            return;
        }
        for (word, sought) in &missing {
            for package in library_trees::declaring(word, *sought) {
                if !self.has(package) {
                    let packages = self.elsewhere.entry(word.clone()).or_default();
                    packages.push(package.to_owned());
                }
            }
        }
        for (name, text) in (packages.all)() {
            if self.has(&name) {
                continue;
            }
            let mut sources = Sources::new();
            let id = sources.add(name.as_str(), text);
            let tree = hyde_syntax::parse(&sources, id, &mut Diagnostics::new());
            for (word, sought) in &missing {
                if declares(&tree, word, *sought) {
                    let packages = self.elsewhere.entry(word.clone()).or_default();
                    packages.push(name.clone());
                }
            }
        }
    }
}

/// Whether a file declares a class or a type of that name, as it is sought.
fn declares(file: &ast::File, word: &str, sought: Sought) -> bool {
    file.items.iter().any(|item| match item {
        Item::Class(class) => sought.takes(true) && class.name.text == word,
        Item::Type(item) => sought.takes(false) && item.name.text == word,
        Item::Experiment(_) | Item::Study(_) => false,
    })
}
