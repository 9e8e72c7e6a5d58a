//! What the names of classes and types mean in each file: its own, its imports, and packages by their full name.

use crate::input::Input;
use crate::refusals::names as refused;
use hyde_diag::{Diagnostic, FileId, Span};
pub(crate) use hyde_syntax::FileIndex;
use hyde_syntax::Lookup;
use hyde_syntax::ast::{self, Class, ClassBody, Element, Item, Reference, TypeItem};
use hyde_units::Kind;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a type name means.
#[derive(Clone, Copy)]
pub(crate) enum TypeName<'a> {
    Real,
    Integer,
    Boolean,
    Quantity(FileIndex, &'a TypeItem),
}

impl TypeName<'_> {
    /// What kind of values the type has.
    pub(crate) fn values(&self) -> Kind {
        match self {
            Self::Real | Self::Quantity(..) => Kind::Real,
            Self::Integer => Kind::Integer,
            Self::Boolean => Kind::Boolean,
        }
    }
}

/// The classes and types of all files.
#[derive(Clone, Copy)]
pub(crate) struct Names<'a> {
    files: &'a [(FileId, Arc<ast::File>)],
    elsewhere: &'a BTreeMap<String, Vec<String>>,
}

impl<'a> Names<'a> {
    pub(crate) fn new(input: &Input<'a>) -> Self {
        Self {
            files: input.files,
            elsewhere: input.elsewhere,
        }
    }

    /// The file a span lies in.
    pub(crate) fn file_of(self, span: Span) -> Option<FileIndex> {
        self.files.iter().position(|(id, _)| *id == span.file)
    }

    fn lookup(self) -> Lookup<'a> {
        Lookup { files: self.files }
    }

    /// The class a name means in a file.
    pub(crate) fn class(self, file: FileIndex, name: &Reference) -> Option<(FileIndex, &'a Class)> {
        self.lookup().class(file, name)
    }

    /// The names of what a class and its bases declare that is of another class or extends it.
    pub(crate) fn parts_that_are(
        self,
        host: (FileIndex, &'a Class),
        wanted: &Class,
    ) -> Vec<&'a str> {
        // A class may extend itself.
        let mut classes = vec![host];
        let mut found = Vec::new();
        let mut seen: Vec<&'a Class> = Vec::new();
        while let Some((file, class)) = classes.pop() {
            if seen.iter().any(|&known| std::ptr::eq(known, class)) {
                continue;
            }
            seen.push(class);
            classes.extend(self.bases(file, class));
            let ClassBody::Long { elements, .. } = &class.body else {
                continue;
            };
            for element in elements {
                if let Element::Declaration(declaration) = element
                    && let Some(own) = self.class(file, &declaration.type_name)
                    && self.is_a(own, wanted)
                {
                    let names = declaration.declarators.iter();
                    found.extend(names.map(|own| own.name.text.as_str()));
                }
            }
        }
        found
    }

    /// Whether a class is another one or extends it.
    pub(crate) fn is_a(self, own: (FileIndex, &'a Class), other: &Class) -> bool {
        let mut waiting = vec![own];
        let mut seen: Vec<&'a Class> = Vec::new();
        while let Some((file, class)) = waiting.pop() {
            if std::ptr::eq(class, other) {
                return true;
            }
            if !seen.iter().any(|&known| std::ptr::eq(known, class)) {
                seen.push(class);
                waiting.extend(self.bases(file, class));
            }
        }
        false
    }

    /// The classes that a class extends, as far as they are known.
    pub(crate) fn bases(self, file: FileIndex, class: &'a Class) -> Vec<(FileIndex, &'a Class)> {
        let known = |base| self.class(file, base);
        match &class.body {
            ClassBody::Short { base, .. } => known(base).into_iter().collect(),
            ClassBody::Long { elements, .. } => {
                let extended = elements.iter().filter_map(|element| {
                    if let Element::Extends(base, _) = element {
                        known(base)
                    } else {
                        None
                    }
                });
                extended.collect()
            }
        }
    }

    /// The type a name means in a file.
    pub(crate) fn quantity(self, file: FileIndex, name: &Reference) -> Option<TypeName<'a>> {
        match name.as_word() {
            Some("Real") => return Some(TypeName::Real),
            Some("Integer") => return Some(TypeName::Integer),
            Some("Boolean") => return Some(TypeName::Boolean),
            Some(_) | None => {}
        }
        let (file, item) = self.lookup().type_item(file, name)?;
        // `type Teeth = Integer;` is an Integer.
        let mut base = (file, item);
        let mut seen = vec![item];
        while base.1.unit.is_none() {
            match base.1.base.as_word() {
                Some("Integer") => return Some(TypeName::Integer),
                Some("Boolean") => return Some(TypeName::Boolean),
                Some(_) | None => {}
            }
            match self.lookup().type_item(base.0, &base.1.base) {
                Some(next) if !seen.iter().any(|known| std::ptr::eq(*known, next.1)) => base = next,
                Some(_) | None => break,
            }
            seen.push(base.1);
        }
        Some(TypeName::Quantity(file, item))
    }

    /// A class of the first file, by its name.
    pub(crate) fn own_class(self, name: &str) -> Option<&'a Class> {
        self.own_items().find_map(|item| match item {
            Item::Class(class) if class.name.text == name => Some(class),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// The names of the models of the first file.
    pub(crate) fn own_models(self) -> impl Iterator<Item = &'a str> {
        self.own_items().filter_map(|item| match item {
            Item::Class(class) if class.kind == ast::ClassKind::Model => {
                Some(class.name.text.as_str())
            }
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// An experiment of the first file, by its name.
    pub(crate) fn own_experiment(self, name: &str) -> Option<&'a ast::Experiment> {
        self.own_items().find_map(|item| match item {
            Item::Experiment(experiment) if experiment.name.text == name => Some(experiment),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// "no such type or model", with the nearest names that there are.
    pub(crate) fn unknown(self, file: FileIndex, name: &Reference) -> Diagnostic {
        let text = name.dotted();
        if let [first, second, ..] = self.packages_with(file, &text).as_slice() {
            return refused::in_two_packages(name, first, second);
        }
        if let Some(diagnostic) = self.not_imported(file, name, None, declared_name) {
            return diagnostic;
        }
        let declare = "declare it, or import its package: `import Rotational.*;`";
        self.nowhere(file, name, ("type or model", declare), declared_name)
    }

    /// "no such quantity", where only one can stand: behind `parameter`, before the name of a measure.
    pub(crate) fn unknown_quantity(self, file: FileIndex, name: &Reference) -> Diagnostic {
        match self.not_imported(file, name, None, quantity_name) {
            Some(diagnostic) => diagnostic,
            None => {
                let declare = format!("declare it: `type {} = Real [unit];`", name.dotted());
                self.nowhere(file, name, ("quantity", &declare), quantity_name)
            }
        }
    }

    /// The quantities known in a file, each with its file.
    pub(crate) fn quantities(self, file: FileIndex) -> Vec<(FileIndex, &'a TypeItem)> {
        let known = |other: &FileIndex| *other == file || self.imports_everything(file, *other);
        let files = (0..self.files.len()).filter(known);
        let items = files.flat_map(|index| {
            let items = self.files[index].1.items.iter();
            items.map(move |item| (index, item))
        });
        let quantities = items.filter_map(|(index, item)| match item {
            Item::Type(item) => Some((index, item)),
            Item::Class(_) | Item::Experiment(_) | Item::Study(_) => None,
        });
        quantities.collect()
    }

    /// "there is none here", with the nearest names that there are.
    fn nowhere(
        self,
        file: FileIndex,
        name: &Reference,
        missing: (&str, &str),
        declared: impl Fn(&'a Item) -> Option<&'a str>,
    ) -> Diagnostic {
        let mut known: Vec<&str> = Vec::new();
        for (index, (_, tree)) in self.files.iter().enumerate() {
            if index == file || self.imports_everything(file, index) {
                known.extend(tree.items.iter().filter_map(&declared));
            }
        }
        known.extend(["Real", "Integer", "Boolean"]);
        refused::no_type(name, missing, &known)
    }

    /// A name that means a quantity here, and is used as the component of that name, which is not imported.
    pub(crate) fn component_elsewhere(
        self,
        file: FileIndex,
        name: &Reference,
    ) -> Option<Diagnostic> {
        let also = Some("a quantity, which has no parts");
        self.not_imported(file, name, also, |item| match item {
            Item::Class(class) => Some(&class.name.text),
            Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// A name that means a component here, and is used as the quantity of that name, which is not imported.
    pub(crate) fn quantity_elsewhere(
        self,
        file: FileIndex,
        name: &Reference,
    ) -> Option<Diagnostic> {
        let also = Some("a component, which has no value");
        self.not_imported(file, name, also, quantity_name)
    }

    /// "it is in a package that is not imported", if that is so.
    fn not_imported(
        self,
        file: FileIndex,
        name: &Reference,
        also: Option<&str>,
        declared: impl Fn(&Item) -> Option<&str>,
    ) -> Option<Diagnostic> {
        let text = name.dotted();
        let mut packages: Vec<String> = Vec::new();
        for (index, (_, tree)) in self.files.iter().enumerate() {
            if index == file || self.imports_everything(file, index) {
                continue;
            }
            if let Some((package, _)) = &tree.package
                && tree
                    .items
                    .iter()
                    .any(|item| declared(item) == Some(text.as_str()))
            {
                packages.push(package.dotted());
            }
        }
        packages.extend(self.elsewhere.get(&text).into_iter().flatten().cloned());
        if packages.is_empty() {
            return None;
        }
        Some(refused::not_imported(name, &packages, also))
    }

    /// The packages imported whole that have a model of that name.
    fn packages_with(self, file: FileIndex, name: &str) -> Vec<String> {
        let Some((_, tree)) = self.files.get(file) else {
            return Vec::new();
        };
        let has = |index: FileIndex| {
            let items = &self.files[index].1.items;
            items
                .iter()
                .any(|item| matches!(item, Item::Class(class) if class.name.text == name))
        };
        let mut found: Vec<String> = Vec::new();
        for import in tree.imports.iter().filter(|import| import.everything) {
            let package = import.path.dotted();
            if self.lookup().package(&package).is_some_and(has) && !found.contains(&package) {
                found.push(package);
            }
        }
        found
    }

    /// Every effect, with its file and the package it is in; those of the user's file without one.
    pub(crate) fn effects(self) -> Vec<(FileIndex, Option<String>, &'a Class)> {
        let mut found = Vec::new();
        for (index, (_, tree)) in self.files.iter().enumerate() {
            let package = tree.package.as_ref().filter(|_| index > 0);
            let package = package.map(|(path, _)| path.dotted());
            found.extend(tree.items.iter().filter_map(|item| match item {
                Item::Class(class) if class.kind == ast::ClassKind::Effect => {
                    Some((index, package.clone(), class))
                }
                Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
            }));
        }
        found
    }

    fn own_items(self) -> impl Iterator<Item = &'a Item> {
        self.files
            .first()
            .into_iter()
            .flat_map(|(_, file)| &file.items)
    }

    fn imports_everything(self, file: FileIndex, other: FileIndex) -> bool {
        let Some((_, tree)) = self.files.get(file) else {
            return false;
        };
        tree.imports.iter().any(|import| {
            import.everything && self.lookup().package(&import.path.dotted()) == Some(other)
        })
    }
}

fn quantity_name(item: &Item) -> Option<&str> {
    match item {
        Item::Type(item) => Some(&item.name.text),
        Item::Class(_) | Item::Experiment(_) | Item::Study(_) => None,
    }
}

fn declared_name(item: &Item) -> Option<&str> {
    match item {
        Item::Class(class) => Some(&class.name.text),
        Item::Type(item) => Some(&item.name.text),
        Item::Experiment(_) | Item::Study(_) => None,
    }
}
