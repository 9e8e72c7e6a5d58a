//! The component library: every component is tried out on a model with a known answer, and the book lists it as it is.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use hyde_tests::{library, root};

#[test]
fn what_is_expected_of_components_holds() {
    let (count, wrong) = library::try_out().unwrap();
    assert!(count > 20, "only {count} experiments were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_component_is_tried_out() {
    let unused = library::unused().unwrap();
    assert!(
        unused.is_empty(),
        "no test model uses {}",
        unused.join(", ")
    );
}

/// Each model of a package is in a table of the chapter below the package's heading; a row names its ends, every value that
/// a user must give, and nothing that is not there.
#[test]
fn the_book_lists_every_component_as_it_is() {
    let text = std::fs::read_to_string(root().join("book/src/library.md")).unwrap();
    let components = library::components().unwrap();
    let mut wrong = Vec::new();
    for component in &components {
        let place = format!("{}.{}", component.package, component.name);
        let section = section(&text, &component.package);
        let quoted = format!("`{}`", component.name);
        let Some(row) = rows(section).find(|row| row[0].contains(&quoted)) else {
            // Bases are told of in the text.
            if !section.contains(&quoted) {
                wrong.push(format!("{place} is not there"));
            }
            continue;
        };
        let words = row[1..row.len() - 1].join(" ");
        let words: Vec<&str> = words
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .collect();
        for name in &component.required {
            if !words.contains(&name.as_str()) {
                wrong.push(format!("{place} needs `{name}`"));
            }
        }
    }
    for package in library::names() {
        for row in rows(section(&text, package)) {
            let of_row: Vec<_> = components
                .iter()
                .filter(|c| c.package == package && row[0].contains(&format!("`{}`", c.name)))
                .collect();
            if of_row.is_empty() {
                continue;
            }
            let cells = row[1..row.len() - 1].join(" ");
            let names = cells.split('`').skip(1).step_by(2);
            for name in names.flat_map(str::split_whitespace) {
                let first = name.split('.').next().unwrap_or(name);
                let known = of_row
                    .iter()
                    .any(|c| c.declared.contains(first) || c.name == first);
                if !known {
                    wrong.push(format!("{package}: {} has no `{name}`", row[0]));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What stands below `## NAME`, or `### NAME` for a package within another, up to the next heading.
fn section<'a>(text: &'a str, name: &str) -> &'a str {
    let level = if name.contains('.') { "###" } else { "##" };
    let Some((_, rest)) = text.split_once(&format!("\n{level} {name}\n")) else {
        return "";
    };
    let end = rest.find("\n## ").into_iter().chain(rest.find("\n### "));
    &rest[..end.min().unwrap_or(rest.len())]
}

/// The cells of the rows of a text's tables.
fn rows(text: &str) -> impl Iterator<Item = Vec<&str>> {
    text.lines()
        .filter_map(|line| line.strip_prefix('|')?.strip_suffix('|'))
        .map(|line| line.split('|').collect::<Vec<_>>())
        .filter(|cells| cells.len() >= 3)
}
