//! The component library as its sources declare it, and the models of `tests/models/library` that try it out.
//!
//! Each experiment there `expect`s closed forms, balances, or published values; a component of the library that none of
//! the project's test models uses is told by [`unused`].

use crate::{Example, folder};
use hyde_diag::{Diagnostics, Sources};
use hyde_syntax::ast::{Class, ClassBody, ClassKind, Declaration, Element, File, Item, Prefix};
use std::collections::{BTreeMap, BTreeSet};

/// The folders whose models use the library.
const FOLDERS: [&str; 4] = [
    "tests/models/library",
    "tests/models/msl",
    "tests/models/paper",
    "tests/models",
];

/// A model of the library.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Component {
    /// The package it is in.
    pub package: String,
    /// Its name.
    pub name: String,
    /// The names it declares, those of what it extends among them.
    pub declared: BTreeSet<String>,
    /// The parameters and inputs that have no value there: a user gives them.
    pub required: BTreeSet<String>,
    /// The packages and names of what it extends and of the components in it, as they are written.
    mentions: BTreeSet<(String, String)>,
}

/// The names of the packages.
pub fn names() -> impl Iterator<Item = &'static str> {
    hyde_library::PACKAGES.iter().map(|package| package.name)
}

/// Every model of the library, by package and name.
///
/// # Errors
/// A package is not in order.
pub fn components() -> Result<Vec<Component>, String> {
    let files = packages()?;
    let mut found: BTreeMap<(String, String), Component> = BTreeMap::new();
    // Bases first: what is extended adds its names.
    for _ in 0..8 {
        for (package, file) in &files {
            for class in models(file) {
                let component = component(package, file, class, &files, &found);
                found.insert((package.clone(), class.name.text.clone()), component);
            }
        }
    }
    Ok(found.into_values().collect())
}

/// The models of the library that no model of the project's tests uses, be it as a part of another one.
///
/// # Errors
/// A file cannot be read or is not in order.
pub fn unused() -> Result<Vec<String>, String> {
    let library = components()?;
    let files = packages()?;
    let mut reached: BTreeSet<(String, String)> = BTreeSet::new();
    for place in FOLDERS {
        for path in folder::models(place)? {
            let example = Example::load(&path, None)?;
            let file = parsed(&path.to_string_lossy(), example.text())?;
            for class in models(&file) {
                reached.extend(mentions(class, "", &file, &files));
            }
        }
    }
    loop {
        let before = reached.len();
        for component in &library {
            if reached.contains(&(component.package.clone(), component.name.clone())) {
                reached.extend(component.mentions.iter().cloned());
            }
        }
        if reached.len() == before {
            break;
        }
    }
    Ok(library
        .into_iter()
        .filter(|known| !reached.contains(&(known.package.clone(), known.name.clone())))
        .map(|known| format!("{}.{}", known.package, known.name))
        .collect())
}

/// Runs every experiment of `tests/models/library`; what does not hold, and how many experiments there are.
///
/// # Errors
/// The folder cannot be read.
pub fn try_out() -> Result<(usize, Vec<String>), String> {
    let (mut count, mut wrong) = (0, Vec::new());
    for path in folder::models("tests/models/library")? {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let example = Example::load(&path, None)?;
        let file = parsed(&name, example.text())?;
        for item in &file.items {
            let Item::Experiment(experiment) = item else {
                continue;
            };
            let title = &experiment.name.text;
            count += 1;
            match Example::load(&path, Some(title))?.run() {
                Err(error) => wrong.push(format!("{name} {title}: {error}")),
                Ok((_, run)) if !run.measures.iter().any(|measure| measure.expectation) => {
                    wrong.push(format!("{name} {title} expects nothing"));
                }
                Ok((_, run)) => wrong.extend(
                    run.measures
                        .iter()
                        .filter(|measure| !measure.holds)
                        .map(|measure| format!("{name} {title}: {}", measure.name)),
                ),
            }
        }
    }
    Ok((count, wrong))
}

fn packages() -> Result<Vec<(String, File)>, String> {
    hyde_library::PACKAGES
        .iter()
        .map(|package| {
            let file = parsed(package.name, package.text)?;
            Ok((package.name.to_owned(), file))
        })
        .collect()
}

fn parsed(name: &str, text: &str) -> Result<File, String> {
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let id = sources.add(name, text);
    let file = hyde_syntax::parse(&sources, id, &mut diagnostics);
    if diagnostics.has_errors() {
        return Err(format!("{name} is not in order"));
    }
    Ok(file)
}

fn models(file: &File) -> impl Iterator<Item = &Class> {
    file.items.iter().filter_map(|item| match item {
        Item::Class(class) if class.kind == ClassKind::Model => Some(class),
        Item::Class(_) | Item::Experiment(_) | Item::Type(_) | Item::Study(_) => None,
    })
}

fn elements(class: &Class) -> &[Element] {
    match &class.body {
        ClassBody::Long { elements, .. } => elements,
        ClassBody::Short { .. } => &[],
    }
}

fn component(
    package: &str,
    file: &File,
    class: &Class,
    files: &[(String, File)],
    known: &BTreeMap<(String, String), Component>,
) -> Component {
    let mut found = Component {
        package: package.to_owned(),
        name: class.name.text.clone(),
        mentions: mentions(class, package, file, files),
        ..Component::default()
    };
    for element in elements(class) {
        match element {
            Element::Declaration(declaration) => {
                let needs_value = needs_value(declaration);
                for declarator in &declaration.declarators {
                    let name = declarator.name.text.clone();
                    if needs_value && declarator.binding.is_none() {
                        found.required.insert(name.clone());
                    }
                    found.declared.insert(name);
                }
            }
            Element::Extends(base, changes) => {
                for target in resolved(&base.dotted(), package, file, files) {
                    let Some(base) = known.get(&target) else {
                        continue;
                    };
                    found.declared.extend(base.declared.iter().cloned());
                    let given = |name: &String| {
                        changes
                            .iter()
                            .any(|change| change.target.dotted() == *name && change.value.is_some())
                    };
                    let open = base.required.iter().filter(|name| !given(name)).cloned();
                    found.required.extend(open);
                }
            }
            Element::Clocked(clocked) => {
                found.declared.insert(clocked.name.text.clone());
            }
            Element::Domain(_)
            | Element::Discretize(_)
            | Element::Modes(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Replace(..)
            | Element::Signature(_)
            | Element::Confounds(_)
            | Element::Measure(_)
            | Element::Account(..) => {}
        }
    }
    found
}

/// Whether a user gives the value of what is declared: of parameters and inputs that are not final.
fn needs_value(declaration: &Declaration) -> bool {
    let has = |prefix| declaration.prefixes.contains(&prefix);
    (has(Prefix::Parameter) || has(Prefix::Input)) && !has(Prefix::Final)
}

/// What a model extends and declares, as packages and names of the library.
fn mentions(
    class: &Class,
    package: &str,
    file: &File,
    files: &[(String, File)],
) -> BTreeSet<(String, String)> {
    let mut written: Vec<String> = Vec::new();
    if let ClassBody::Short { base, .. } = &class.body {
        written.push(base.dotted());
    }
    for element in elements(class) {
        match element {
            Element::Declaration(declaration) => {
                written.push(declaration.type_name.dotted());
                for change in declaration.declarators.iter().flat_map(|d| &d.changes) {
                    written.extend(
                        change
                            .redeclare
                            .as_ref()
                            .map(hyde_syntax::ast::Reference::dotted),
                    );
                }
            }
            Element::Extends(base, _) => written.push(base.dotted()),
            Element::Replace(_, by, _) => written.push(by.dotted()),
            Element::Clocked(clocked) => {
                written.extend(clocked.elements.iter().filter_map(|inner| {
                    if let Element::Declaration(declaration) = inner {
                        return Some(declaration.type_name.dotted());
                    }
                    None
                }));
            }
            Element::Domain(_)
            | Element::Discretize(_)
            | Element::Modes(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Signature(_)
            | Element::Confounds(_)
            | Element::Measure(_)
            | Element::Account(..) => {}
        }
    }
    let found = written
        .iter()
        .flat_map(|name| resolved(name, package, file, files));
    found.collect()
}

/// The models of the library that a name can stand for in a file.
fn resolved(
    written: &str,
    package: &str,
    file: &File,
    files: &[(String, File)],
) -> Vec<(String, String)> {
    let (of, name) = written.rsplit_once('.').unwrap_or(("", written));
    let open: Vec<String> = if of.is_empty() {
        let imports = file.imports.iter().filter_map(|import| {
            let path = import.path.dotted();
            if import.everything {
                return Some(path);
            }
            let (package, last) = path.rsplit_once('.')?;
            (last == name).then(|| package.to_owned())
        });
        std::iter::once(package.to_owned()).chain(imports).collect()
    } else {
        vec![of.to_owned()]
    };
    let has = |package: &String| {
        let file = files.iter().find(|(known, _)| known == package);
        file.is_some_and(|(_, file)| models(file).any(|class| class.name.text == name))
    };
    open.into_iter()
        .filter(has)
        .map(|package| (package, name.to_owned()))
        .collect()
}
