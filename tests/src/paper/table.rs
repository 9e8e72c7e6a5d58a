//! [`rows`]: the table of the book, and whether the library has what its rows name.

use crate::root;
use std::path::Path;

/// A row: an element or equation of the paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// What it is in the paper.
    pub element: String,
    /// The components that are it, with their packages.
    pub components: Vec<String>,
    /// The tests, `file: experiment`.
    pub tests: Vec<String>,
}

/// The rows of `book/src/paper.md`: lines of a table of four columns, of which the second names components and the third
/// tests, each between backquotes.
///
/// # Errors
/// The page cannot be read, or a row has not four columns or names no component or no test.
pub fn rows() -> Result<Vec<Row>, String> {
    let page = read(&root().join("book/src/paper.md"))?;
    let mut rows = Vec::new();
    for line in page.lines().filter(|line| line.starts_with("| ")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [element, components, tests, _] = cells[..] else {
            return Err(format!("`{line}` has not four columns"));
        };
        let row = Row {
            element: element.to_owned(),
            components: quoted(components),
            tests: quoted(tests),
        };
        if row.components.is_empty() && row.tests.is_empty() {
            continue; // the head of the table
        }
        if row.components.is_empty() || row.tests.is_empty() {
            return Err(format!("`{element}` has no component or no test"));
        }
        rows.push(row);
    }
    Ok(rows)
}

impl Row {
    /// Whether the library has the components.
    pub(super) fn components_are_there(&self) -> Result<(), String> {
        for component in &self.components {
            let (package, name) = split(component)?;
            if !declared(&package_text(package)?).any(|known| known == name) {
                return Err(format!("`{package}` declares no `{name}`"));
            }
        }
        Ok(())
    }

    /// Whether the models of its tests name each of them, or name one of them that is made of it.
    pub(super) fn components_are_used(&self, texts: &[&str]) -> Result<(), String> {
        let mut named = Vec::new();
        let mut others = Vec::new();
        for component in &self.components {
            let (package, name) = split(component)?;
            let names = |text: &&str| words(text).any(|word| word == name);
            if texts.iter().any(names) {
                named.push((package, name));
            } else {
                others.push((package, name));
            }
        }
        for (package, name) in others {
            let text = package_text(package)?;
            let inside = |whole: &(&str, &str)| {
                whole.0 == package
                    && body(&text, whole.1).is_some_and(|body| words(body).any(|word| word == name))
            };
            if !named.iter().any(inside) {
                return Err(format!("no test of the row uses `{package}.{name}`"));
            }
        }
        Ok(())
    }
}

/// The text of a package of the library.
fn package_text(package: &str) -> Result<String, String> {
    let file = format!("{}.hyde", package.replace('.', "/"));
    read(&root().join("crates/hyde-library/models").join(file))
}

/// What stands between `model NAME` and `end NAME`.
fn body<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    // Its doc string stands behind the name or on the next line.
    let begins = |end: char| text.split_once(&format!("\nmodel {name}{end}"));
    let (_, rest) = begins(' ').or_else(|| begins('\n'))?;
    let (body, _) = rest.split_once(&format!("\nend {name};"))?;
    Some(body)
}

/// Every model of the packages `Drives.…`, with its package.
///
/// # Errors
/// The folder or a file cannot be read.
#[allow(clippy::disallowed_methods, reason = "tests list the library")]
pub fn drives() -> Result<Vec<String>, String> {
    let folder = root().join("crates/hyde-library/models/Drives");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut found = Vec::new();
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let package = path.file_stem().unwrap_or_default().to_string_lossy();
        let text = read(&path)?;
        let models = text.lines().filter_map(|line| line.strip_prefix("model "));
        let names = models.filter_map(|rest| words(rest).next());
        found.extend(names.map(|name| format!("Drives.{package}.{name}")));
    }
    found.sort();
    Ok(found)
}

/// The models and functions that a package declares.
fn declared(text: &str) -> impl Iterator<Item = &str> {
    let items = text.lines().filter_map(|line| {
        line.strip_prefix("model ")
            .or_else(|| line.strip_prefix("function "))
    });
    items.filter_map(|rest| words(rest).next())
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_')
}

fn split(component: &str) -> Result<(&str, &str), String> {
    component
        .rsplit_once('.')
        .ok_or_else(|| format!("`{component}` names no package"))
}

/// What stands between backquotes.
fn quoted(cell: &str) -> Vec<String> {
    let inside = cell.split('`').skip(1).step_by(2);
    inside.map(str::to_owned).collect()
}

#[allow(clippy::disallowed_methods, reason = "tests open files")]
pub(crate) fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}
