//! The user's file and the library packages it names.

use hyde_diag::{Code, Diagnostic, Diagnostics, FileId, Sources};
use hyde_syntax::ast::{self, ClassBody, Element, Item, Reference};

/// Parsed files, the user's first, then every package that one of them names.
pub struct File {
    /// Texts and trees.
    pub files: Vec<(FileId, ast::File)>,
}

/// Where packages come from besides the library.
pub struct Packages<'a> {
    /// The place and text of a package by its dotted name, if there is one.
    pub find: &'a dyn Fn(&str) -> Option<(String, String)>,
    /// Every package of the library, whether named or not.
    pub whole_library: bool,
}

impl Packages<'_> {
    /// The library alone.
    pub const LIBRARY: Self = Self {
        find: &|_| None,
        whole_library: false,
    };
}

/// Parses a file and the packages it names: `import a.b.*;` names the package `a.b`.
pub fn load(
    sources: &mut Sources,
    name: &str,
    text: &str,
    packages: &Packages<'_>,
    diagnostics: &mut Diagnostics,
) -> File {
    let id = sources.add(name, text);
    let tree = hyde_syntax::parse(sources, id, diagnostics);
    let mut files = vec![(id, tree)];
    let mut known: Vec<String> = Vec::new();
    let mut at = 0;
    while at < files.len() {
        let mut wanted = packages_named(&files[at].1);
        if at == 0 && packages.whole_library {
            wanted.extend(hyde_library::PACKAGES.iter().map(|p| p.name.to_owned()));
        }
        for name in wanted {
            if known.contains(&name) {
                continue;
            }
            let found = match hyde_library::package(&name) {
                Some(package) => Some((
                    format!("{}.hyde", name.replace('.', "/")),
                    package.text.to_owned(),
                )),
                None => (packages.find)(&name),
            };
            known.push(name);
            if let Some((place, text)) = found {
                let id = sources.add(place, text);
                let tree = hyde_syntax::parse(sources, id, diagnostics);
                files.push((id, tree));
            }
        }
        at += 1;
    }
    unknown_imports(&files, diagnostics);
    File { files }
}

impl File {
    /// The experiments of the user's file.
    pub fn experiments(&self) -> impl Iterator<Item = &ast::Experiment> {
        self.items().filter_map(|item| match item {
            Item::Experiment(experiment) => Some(experiment),
            Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
        })
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

    fn items(&self) -> impl Iterator<Item = &Item> {
        self.files
            .first()
            .into_iter()
            .flat_map(|(_, file)| &file.items)
    }
}

/// The packages of imports and of dotted types.
fn packages_named(file: &ast::File) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut named = |package: String| {
        if !package.is_empty() && !found.contains(&package) {
            found.push(package);
        }
    };
    for import in &file.imports {
        named(if import.everything {
            import.path.dotted()
        } else {
            package_of(&import.path)
        });
    }
    let mut add = |reference: &Reference| named(package_of(reference));
    for item in &file.items {
        match item {
            Item::Class(class) => match &class.body {
                ClassBody::Short { base, effects, .. } => {
                    add(base);
                    effects.iter().for_each(|used| add(&used.effect));
                }
                ClassBody::Long { elements, .. } => types_named(elements, &mut add),
            },
            Item::Experiment(experiment) => add(&experiment.model),
            Item::Type(item) => add(&item.base),
            Item::Study(_) => {}
        }
    }
    found
}

/// What stands before the last dot.
fn package_of(reference: &Reference) -> String {
    let dotted = reference.dotted();
    dotted
        .rsplit_once('.')
        .map_or_else(String::new, |(package, _)| package.to_owned())
}

fn types_named(elements: &[Element], add: &mut impl FnMut(&Reference)) {
    for element in elements {
        match element {
            Element::Declaration(declaration) => add(&declaration.type_name),
            Element::Extends(base, _) => add(base),
            Element::Clocked(clocked) => types_named(&clocked.elements, add),
            Element::Replace(_, by, _) => add(by),
            Element::Measure(measure) | Element::Account(_, measure) => add(&measure.type_name),
            Element::Domain(_)
            | Element::Discretize(_)
            | Element::Modes(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Signature(_)
            | Element::Confounds(_) => {}
        }
    }
}

fn unknown_imports(files: &[(FileId, ast::File)], diagnostics: &mut Diagnostics) {
    let known: Vec<String> = files
        .iter()
        .filter_map(|(_, file)| file.package.as_ref().map(|(path, _)| path.dotted()))
        .collect();
    for (_, file) in files {
        for import in &file.imports {
            let path = import.path.dotted();
            let package = if import.everything {
                path.as_str()
            } else {
                path.rsplit_once('.').map_or("", |(p, _)| p)
            };
            if known.iter().any(|name| name == package) {
                continue;
            }
            let names: Vec<String> = hyde_library::PACKAGES
                .iter()
                .map(|package| format!("`{}`", package.name))
                .collect();
            diagnostics.push(
                Diagnostic::error(
                    Code::UnknownType,
                    format!("no package is called `{package}`"),
                )
                .label(
                    import.path.span,
                    "neither in the library nor beside the file",
                )
                .help(format!("the library has {}", names.join(", "))),
            );
        }
    }
}
