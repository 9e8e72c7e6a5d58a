//! Links from a name in a package to where that is documented.

use super::Library;
use super::html::escaped;
use hyde_syntax::ast::{Class, Import, Item, Reference, TypeItem};

/// Every package, those without a page too.
pub(super) struct Links<'l> {
    library: &'l Library,
}

impl<'l> Links<'l> {
    pub(super) fn new(library: &'l Library) -> Self {
        Self { library }
    }

    /// What is imported, with a link to its package.
    pub(super) fn import(&self, import: &Import) -> String {
        let path = import.path.dotted();
        match path.rsplit_once('.') {
            Some((package, word)) if !import.everything => {
                format!("{}.{}", self.package(package), escaped(word))
            }
            _ => self.package(&path),
        }
    }

    /// The name of a package, as a link if it has a page.
    fn package(&self, name: &str) -> String {
        let known = (0..self.library.documented).any(|number| self.library.name(number) == name);
        let text = escaped(name);
        if known {
            format!("<a href=\"{text}.html\">{text}</a>")
        } else {
            text
        }
    }

    /// The class that a name in a package means, if that has a page.
    pub(super) fn class(&self, from: usize, name: &Reference) -> Option<(usize, &'l Class)> {
        self.look_up(from, name, |item, word| match item {
            Item::Class(class) if class.name.text == word => Some(class),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// The type that a name in a package means, if that has a page.
    pub(super) fn quantity(&self, from: usize, name: &Reference) -> Option<(usize, &'l TypeItem)> {
        self.look_up(from, name, |item, word| match item {
            Item::Type(item) if item.name.text == word => Some(item),
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
    }

    /// The name of a class, as a link if it has a page.
    pub(super) fn to_class(&self, from: usize, name: &Reference) -> String {
        let found = self.class(from, name);
        self.link(
            found.map(|(number, class)| (number, class.name.text.as_str(), "")),
            name,
        )
    }

    /// The name of a type, as a link if it has a page.
    pub(super) fn to_quantity(&self, from: usize, name: &Reference) -> String {
        let found = self.quantity(from, name);
        self.link(
            found.map(|(number, item)| (number, item.name.text.as_str(), "type-")),
            name,
        )
    }

    /// The unit that a type is printed in.
    pub(super) fn unit(&self, from: usize, name: &Reference) -> String {
        let (mut from, mut name) = (from, name);
        let mut seen = Vec::new();
        while let Some((number, item)) = self.quantity(from, name) {
            // A type of itself has no unit.
            if seen.contains(&(number, &item.name.text)) {
                break;
            }
            seen.push((number, &item.name.text));
            if let Some(unit) = &item.unit {
                return escaped(&unit.text);
            }
            (from, name) = (number, &item.base);
        }
        String::new()
    }

    fn link(&self, found: Option<(usize, &str, &str)>, name: &Reference) -> String {
        let text = escaped(&name.dotted());
        match found {
            Some((number, word, lead)) if number < self.library.documented => {
                let page = self.library.name(number);
                format!("<a href=\"{page}.html#{lead}{word}\">{text}</a>")
            }
            Some(_) | None => text,
        }
    }

    /// In the package itself, then in those that it imports, then by the package in the name.
    fn look_up<T>(
        &self,
        from: usize,
        name: &Reference,
        pick: impl Fn(&'l Item, &str) -> Option<&'l T>,
    ) -> Option<(usize, &'l T)> {
        let dotted = name.dotted();
        let (package, word) = dotted.rsplit_once('.').unwrap_or(("", &dotted));
        let own = &self.library.files[from].1;
        let places = (0..self.library.files.len()).filter(|&number| {
            let other = self.library.name(number);
            let imported = own.imports.iter().any(|import| {
                let path = import.path.dotted();
                path == other || path.rsplit_once('.').map(|(start, _)| start) == Some(&other)
            });
            match package {
                "" => number == from || imported,
                package => package == other,
            }
        });
        // The package's own names come first.
        let mut places: Vec<usize> = places.collect();
        places.sort_by_key(|&number| number != from);
        places.into_iter().find_map(|number| {
            let items = self.library.files[number].1.items.iter();
            items
                .filter_map(|item| pick(item, word))
                .next()
                .map(|found| (number, found))
        })
    }
}
