//! Circles: files of a crate that import each other all the way round. Whoever reads one of them has to read them all, so
//! a circle has at most [`MOST`] files: a type with its passes, or a recursion of the language.
//!
//! ```text
//! file -> modules that its paths name      `use` trees with their braces, and paths in the code
//! a re-export -> where it comes from       `pub use` names another file's item
//! reached and reached back                 a circle
//! ```

use super::{File, sources};
use std::collections::{BTreeMap, BTreeSet};

/// Files of a circle at most.
const MOST: usize = 5;

#[test]
fn no_circle_of_files_is_longer_than_five() {
    let mut crates: BTreeMap<String, Vec<File>> = BTreeMap::new();
    for file in sources() {
        let inside = file.path.strip_prefix("crates/");
        let Some((name, path)) = inside.and_then(|path| path.split_once("/src/")) else {
            continue;
        };
        let path = path.to_owned();
        let text = file.text;
        crates
            .entry(name.to_owned())
            .or_default()
            .push(File { path, text });
    }
    let mut long = Vec::new();
    for (name, files) in &crates {
        for circle in circles(files) {
            if circle.len() > MOST {
                long.push(format!("{name}: {}", circle.join(", ")));
            }
        }
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn a_circle_is_found_by_way_of_braces_and_of_what_is_exported_again() {
    let file = |path: &str, text: &str| File {
        path: path.to_owned(),
        text: text.to_owned(),
    };
    let files = [
        file("lib.rs", "mod a;\nmod b;\nmod c;\n"),
        file("a.rs", "use crate::{b::{self, B}, c::C};\n"),
        file("b.rs", "mod inner;\npub(crate) use inner::Inner;\n"),
        file("b/inner.rs", "fn f() { super::super::c::g(); }\n"),
        file("c.rs", "use super::b::Inner;\n// use crate::a::A;\n"),
    ];
    assert_eq!(circles(&files), [["b::inner", "c"]]);
}

/// The circles of a crate's files, whose paths start at `src`, by the names of their modules.
fn circles(files: &[File]) -> Vec<Vec<String>> {
    let house = House::of(files);
    let reached: BTreeMap<&str, BTreeSet<&str>> = house
        .uses
        .keys()
        .map(|from| (from.as_str(), house.reached(from)))
        .collect();
    let mut found: BTreeSet<Vec<String>> = BTreeSet::new();
    for (from, there) in &reached {
        let back = there.iter().filter(|other| reached[*other].contains(from));
        let circle: BTreeSet<&str> = back.copied().chain([*from]).collect();
        if circle.len() > 1 {
            found.insert(circle.into_iter().map(str::to_owned).collect());
        }
    }
    found.into_iter().collect()
}

/// The modules of a crate with what each of them uses.
struct House {
    uses: BTreeMap<String, BTreeSet<String>>,
}

impl House {
    fn of(files: &[File]) -> Self {
        let modules: BTreeMap<String, Paths> = files
            .iter()
            .map(|file| (module(&file.path), Paths::of(&file.text)))
            .collect();
        let mut exported: BTreeMap<(String, String), String> = BTreeMap::new();
        // An export of an export is known one round later.
        for _ in 0..4 {
            for (own, paths) in &modules {
                for path in &paths.exported {
                    let Some(name) = path.last().cloned() else {
                        continue;
                    };
                    if let Some(there) = place(&modules, &exported, own, path) {
                        exported.insert((own.clone(), name), there);
                    }
                }
            }
        }
        let uses = modules.iter().map(|(own, paths)| {
            let there = paths.used.iter();
            let there = there.filter_map(|path| place(&modules, &exported, own, path));
            (own.clone(), there.filter(|other| other != own).collect())
        });
        Self {
            uses: uses.collect(),
        }
    }

    fn reached(&self, from: &str) -> BTreeSet<&str> {
        let mut found = BTreeSet::new();
        let mut next: Vec<&str> = vec![from];
        while let Some(own) = next.pop() {
            for other in self.uses.get(own).into_iter().flatten() {
                if found.insert(other.as_str()) {
                    next.push(other);
                }
            }
        }
        found
    }
}

/// `a::b` for `a/b.rs`, nothing for the root.
fn module(path: &str) -> String {
    let path = path.trim_end_matches(".rs");
    match path {
        "lib" | "main" => String::new(),
        _ => path.replace('/', "::"),
    }
}

/// The paths that a file names, in words.
#[derive(Default)]
struct Paths {
    used: Vec<Vec<String>>,
    exported: Vec<Vec<String>>,
}

impl Paths {
    fn of(text: &str) -> Self {
        let product = text.split("#[cfg(test)]\nmod tests").next();
        let code = product.unwrap_or_default().lines();
        let code: Vec<&str> = code
            .map(|line| line.split("//").next().unwrap_or_default())
            .collect();
        let code = code.join("\n");
        let mut paths = Self::default();
        let mut rest = String::new();
        for statement in code.split_inclusive(';') {
            let line = |at: usize| {
                let line = statement[..at].rsplit('\n').next();
                line.unwrap_or_default().trim()
            };
            let begins = |at: &usize| line(*at).is_empty() || line(*at).starts_with("pub");
            let Some(at) = statement.rfind("use ").filter(begins) else {
                rest.push_str(statement);
                continue;
            };
            let into = match line(at).is_empty() {
                true => &mut paths.used,
                false => &mut paths.exported,
            };
            expand(statement[at + 4..].trim_end_matches(';'), "", into);
            rest.push_str(&statement[..at]);
        }
        let in_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
        let named = rest
            .split(|c| !in_path(c))
            .filter(|word| word.contains("::"));
        paths.used.extend(named.map(words));
        paths
    }
}

/// The paths of a `use` tree: `a::{b, c::D}` is `a::b` and `a::c::D`.
fn expand(tree: &str, before: &str, into: &mut Vec<Vec<String>>) {
    let tree = tree.trim();
    let Some((head, inside)) = tree.split_once('{') else {
        let path = tree.split(" as ").next().unwrap_or_default();
        into.push(words(&format!("{before}{path}")));
        return;
    };
    let inside = inside.rsplit_once('}').map_or(inside, |(inside, _)| inside);
    let (mut depth, mut start) = (0, 0);
    let ends = inside.char_indices().chain([(inside.len(), ',')]);
    for (at, c) in ends {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inside[start..at].trim().is_empty() {
                    expand(&inside[start..at], &format!("{before}{head}"), into);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

fn words(path: &str) -> Vec<String> {
    let words = path.split("::").map(str::trim);
    words
        .filter(|word| !word.is_empty())
        .map(str::to_owned)
        .collect()
}

/// The module that has what a path names from a module; `None` where that is another crate.
fn place(
    modules: &BTreeMap<String, Paths>,
    exported: &BTreeMap<(String, String), String>,
    own: &str,
    path: &[String],
) -> Option<String> {
    let joined = |module: &str, word: &str| match module {
        "" => word.to_owned(),
        _ => format!("{module}::{word}"),
    };
    let outer = |module: &str| {
        module
            .rsplit_once("::")
            .map_or("", |(outer, _)| outer)
            .to_owned()
    };
    let mut rest = path;
    let mut here = own.to_owned();
    match path.first()?.as_str() {
        "crate" => (here, rest) = (String::new(), &rest[1..]),
        "self" => rest = &rest[1..],
        "super" => {
            while let Some(("super", behind)) = rest.split_first().map(|(a, b)| (a.as_str(), b)) {
                (here, rest) = (outer(&here), behind);
            }
        }
        child => {
            modules.get(&joined(own, child))?;
        }
    }
    while let Some(word) = rest.first() {
        let inner = joined(&here, word);
        if word != "self" && !modules.contains_key(&inner) {
            break;
        }
        if word != "self" {
            here = inner;
        }
        rest = &rest[1..];
    }
    let item = rest.first();
    let from = item.and_then(|word| exported.get(&(here.clone(), word.clone())));
    Some(from.cloned().unwrap_or(here))
}
