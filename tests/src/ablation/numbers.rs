//! [`outside_the_table`]: named numbers of the diagnosis that are neither thresholds nor marked as numerics.

use crate::root;
use std::path::Path;

/// The folder whose numbers are held.
const FOLDER: &str = "crates/hyde-calibrate/src/diagnosis";
/// How the documentation of a number begins that only says how finely something is computed.
const MARK: &str = "/// Numerics:";

/// Each such number with its file.
///
/// # Errors
/// A file cannot be read.
pub fn outside_the_table() -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    visit(&root().join(FOLDER), &mut found)?;
    found.sort();
    Ok(found)
}

#[allow(clippy::disallowed_methods, reason = "sources are looked through")]
fn visit(folder: &Path, found: &mut Vec<String>) -> Result<(), String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_dir() {
            visit(&path, found)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = std::fs::read_to_string(&path).map_err(failed)?;
            let file = path.strip_prefix(root()).unwrap_or(&path).display();
            found.extend(unmarked(&text).map(|name| format!("{file}: {name}")));
        }
    }
    Ok(())
}

/// Names of numbers, and of lists of numbers, whose documentation does not begin with the mark.
fn unmarked(text: &str) -> impl Iterator<Item = &str> {
    let lines: Vec<&str> = text.lines().map(str::trim_start).collect();
    let number = move |at: usize| -> Option<&str> {
        let (before, rest) = lines[at].split_once("const ")?;
        let (name, kind) = rest.split_once(':')?;
        let is_item = before.is_empty() || before.starts_with("pub");
        let (kind, _) = kind.split_once('=')?;
        let numeric = ["f64", "f32", "usize", "i32", "u32", "i64", "u64"];
        let mut words = kind.split(|c: char| !c.is_alphanumeric());
        if !is_item || !words.any(|word| numeric.contains(&word)) {
            return None;
        }
        let docs = lines[..at].iter().rev();
        let docs = docs.take_while(|line| line.starts_with("///"));
        let marked = docs.last().is_some_and(|first| first.starts_with(MARK));
        (!marked).then_some(name)
    };
    (0..text.lines().count()).filter_map(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_without_a_mark_are_found() {
        let text = "/// Numerics: rows at once.\n/// More of it.\nconst BLOCK: usize = 3;\n\
                    /// A gate.\npub(crate) const GATE: f64 = 2.0;\nconst BOTH: [f64; 2] = [1.0, 2.0];\n\
                    const NAME: &str = \"a\";\n";
        let found: Vec<&str> = unmarked(text).collect();
        assert_eq!(found, ["GATE", "BOTH"]);
    }
}
