//! What the name of an item means in a file: one of its own, an imported one, or one of a package by its full name.

use crate::ast::{Class, File, Item, Part, Reference, TypeItem};
use hyde_diag::FileId;
use std::sync::Arc;

/// A file by its number among those loaded.
pub type FileIndex = usize;

/// Files whose items can name each other.
#[derive(Clone, Copy)]
pub struct Lookup<'a> {
    /// The files with their texts, the user's file first.
    pub files: &'a [(FileId, Arc<File>)],
}

impl<'a> Lookup<'a> {
    /// The file of a package.
    #[must_use]
    pub fn package(self, name: &str) -> Option<FileIndex> {
        self.files.iter().position(|(_, tree)| {
            let package = tree.package.as_ref();
            package.is_some_and(|(path, _)| path.dotted() == name)
        })
    }

    /// The class that a name means in a file.
    #[must_use]
    pub fn class(self, file: FileIndex, name: &Reference) -> Option<(FileIndex, &'a Class)> {
        self.item(file, name, |item, word| match item {
            Item::Class(class) if class.name.text == word => Some(class),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// The type that a name means in a file.
    #[must_use]
    pub fn type_item(self, file: FileIndex, name: &Reference) -> Option<(FileIndex, &'a TypeItem)> {
        self.item(file, name, |item, word| match item {
            Item::Type(item) if item.name.text == word => Some(item),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// What a name means in a file, of the items that `pick` takes for a word: in the file, among single imports, among whole
    /// packages, or by its full name. A name that two whole packages have means neither.
    fn item<T>(
        self,
        file: FileIndex,
        name: &Reference,
        pick: impl Fn(&'a Item, &str) -> Option<&'a T>,
    ) -> Option<(FileIndex, &'a T)> {
        let in_file = |index: FileIndex, word: &str| {
            let tree = &self.files.get(index)?.1;
            let mut items = tree.items.iter();
            let found = items.find_map(|item| pick(item, word));
            found.map(|found| (index, found))
        };
        let (last, package) = name.parts.split_last()?;
        let word = last.name.text.as_str();
        if !package.is_empty() {
            return in_file(self.package(&dotted(package))?, word);
        }
        if let Some(found) = in_file(file, word) {
            return Some(found);
        }
        let imports = &self.files.get(file)?.1.imports;
        let mut exact = imports.iter().filter(|import| !import.everything);
        let exact = exact.find_map(|import| {
            let (last, package) = import.path.parts.split_last()?;
            if last.name.text != word {
                return None;
            }
            in_file(self.package(&dotted(package))?, word)
        });
        exact.or_else(|| {
            let whole = imports.iter().filter(|import| import.everything);
            let mut found =
                whole.filter_map(|import| in_file(self.package(&import.path.dotted())?, word));
            let first = found.next()?;
            found.all(|(index, _)| index == first.0).then_some(first)
        })
    }
}

/// A dotted name from its parts, subscripts left out.
#[must_use]
pub fn dotted(parts: &[Part]) -> String {
    let words: Vec<&str> = parts.iter().map(|part| part.name.text.as_str()).collect();
    words.join(".")
}
