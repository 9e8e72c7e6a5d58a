//! The files of a record: one, or several that a pattern or a sum names, `part_*.csv`, `scope.csv + drive.csv`.

use crate::asked::Asked;
use crate::inputs::Kind;
use crate::record_settings::{self, side_file};
use crate::records::{Record, Records, missing};
use crate::refusals::files as refused;
use crate::world::{World, matching};
use hyde_diag::Diagnostic;
use hyde_signal::{Note, Table};
use hyde_syntax::ast::RecordItem;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};

/// What stands between the names of files that make one record.
const AND: &str = " + ";

/// The files that make one record.
#[derive(Debug)]
pub(crate) struct Files {
    /// As messages and summaries call them.
    pub(crate) shown: PathBuf,
    /// Each of them once.
    pub(crate) all: Vec<PathBuf>,
}

impl Files {
    /// What a text names below a folder: the file of that name if there is one, else those of its names and patterns.
    pub(crate) fn named(world: &dyn World, root: &Path, text: &str) -> Self {
        let shown = root.join(text);
        let several = text.contains(AND) || is_pattern(text);
        let all = match several && !world.is_file(&shown) {
            true => of_parts(world, root, text),
            false => vec![shown.clone()],
        };
        Self { shown, all }
    }
}

impl Files {
    /// The names of all without their folders.
    pub(crate) fn names(&self) -> String {
        sum(&self.all, own_name)
    }

    /// The files as the one record that a study names, beside all of them; neither if one is missing or outside the folder.
    pub(crate) fn one_record(self, world: &dyn World) -> (Vec<PathBuf>, Vec<PathBuf>) {
        let inside = |file: &PathBuf| {
            let mut parts = file.components();
            world.is_file(file) && !parts.any(|part| part == std::path::Component::ParentDir)
        };
        match !self.all.is_empty() && self.all.iter().all(inside) {
            true => {
                let sum = sum(&self.all, |file| file.to_string_lossy().into_owned());
                (vec![PathBuf::from(sum)], self.all)
            }
            false => (Vec::new(), Vec::new()),
        }
    }
}

/// The text that names files as one record, each called so.
pub fn sum(files: &[PathBuf], called: impl Fn(&Path) -> String) -> String {
    let names = files.iter().map(|file| called(file));
    names.collect::<Vec<_>>().join(AND)
}

/// A file's name without its folder.
pub(crate) fn own_name(file: &Path) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    name.to_string_lossy().into_owned()
}

/// Whether a text names several files that are one record.
pub(crate) fn is_sum(text: &str) -> bool {
    text.contains(AND)
}

fn of_parts(world: &dyn World, root: &Path, text: &str) -> Vec<PathBuf> {
    let beside = Path::new(parts(text).next().unwrap_or_default()).parent();
    let mut files: Vec<PathBuf> = Vec::new();
    for name in parts(text).map(Path::new) {
        // A name without a folder is in the folder of the first one.
        let place = match (name.parent(), beside) {
            (Some(own), Some(beside)) if own.as_os_str().is_empty() => beside.join(name),
            _ => name.to_owned(),
        };
        let place = root.join(place);
        match is_pattern(&place.to_string_lossy()) {
            true => files.extend(of_pattern(world, &place)),
            false => files.push(place),
        }
    }
    let mut once: Vec<PathBuf> = Vec::new();
    for file in files {
        if !once.contains(&file) {
            once.push(file);
        }
    }
    once
}

/// The names and patterns of a sum.
pub fn parts(text: &str) -> impl Iterator<Item = &str> {
    text.split(AND).map(str::trim)
}

fn is_pattern(text: &str) -> bool {
    text.contains(['*', '?'])
}

/// The files of a pattern, from the last folder that it names outright.
fn of_pattern(world: &dyn World, path: &Path) -> Vec<PathBuf> {
    let mut folder = PathBuf::new();
    let mut rest = PathBuf::new();
    for part in path.components() {
        let plain = rest.as_os_str().is_empty() && !is_pattern(&part.as_os_str().to_string_lossy());
        match plain {
            true => folder.push(part),
            false => rest.push(part),
        }
    }
    matching(world, &folder, &rest.to_string_lossy())
}

/// Reads the files of a record that is asked for, and joins them.
pub(crate) fn read(
    item: &RecordItem,
    settings: Option<&RecordItem>,
    files: Files,
    asked: &Asked,
    needed: Records,
) -> Result<Record, Diagnostic> {
    let open = |file: &Path| asked.read(Kind::Record, "", &file.to_string_lossy(), file);
    joined(item, settings, files, &open, &|reason| {
        missing(item, needed, reason)
    })
}

/// The same with `open` for the content of a file, and a diagnostic for one that is not there.
pub(crate) fn joined(
    item: &RecordItem,
    settings: Option<&RecordItem>,
    files: Files,
    open: &dyn Fn(&Path) -> Result<Vec<u8>, String>,
    missing: &dyn Fn(&str) -> Diagnostic,
) -> Result<Record, Diagnostic> {
    let Files { shown, all: files } = files;
    if files.is_empty() {
        return Err(missing(&format!(
            "no file is named as `{}`",
            shown.display()
        )));
    }
    let mut hash = Sha256::new();
    let mut tables: Vec<(String, Table)> = Vec::new();
    for file in &files {
        let content = open(file).map_err(|reason| missing(&reason))?;
        hash.update(&content);
        let side = open(&side_file(file)).ok();
        let table = record_settings::table(item, settings, file, &content, side)?;
        tables.push((own_name(file), table));
    }
    let several = files.len() > 1;
    let mut table = hyde_signal::join(tables).map_err(|error| {
        let (file, repair) = (shown.display().to_string(), error.repair(&item.name.text));
        refused::cannot_join(item, &file, &error.to_string(), &repair)
    })?;
    if several {
        table.tell(Note::new(format!(
            "{} files are read as one record",
            files.len()
        )));
    }
    Ok(Record {
        path: shown,
        hash: format!("{:x}", hash.finalize()),
        table,
    })
}

#[cfg(test)]
mod tests {
    use super::Files;
    use crate::world::Buffers;
    use std::path::{Path, PathBuf};

    fn files(text: &str) -> Vec<PathBuf> {
        let mut world = Buffers::default();
        for name in ["d/a_1.csv", "d/a_2.csv", "d/b.csv", "d/odd*.csv"] {
            world.put(name, "t,x\n");
        }
        Files::named(&world, Path::new(""), text).all
    }

    fn paths(names: &[&str]) -> Vec<PathBuf> {
        names.iter().map(PathBuf::from).collect()
    }

    #[test]
    fn a_pattern_and_a_sum_name_several_files() {
        assert_eq!(files("d/a_?.csv"), paths(&["d/a_1.csv", "d/a_2.csv"]));
        assert_eq!(
            files("d/b.csv + a_*.csv"),
            paths(&["d/b.csv", "d/a_1.csv", "d/a_2.csv"])
        );
        assert_eq!(files("d/b.csv + d/b.csv"), paths(&["d/b.csv"]));
    }

    #[test]
    fn a_file_that_is_called_like_a_pattern_is_that_file() {
        assert_eq!(files("d/odd*.csv"), paths(&["d/odd*.csv"]));
        assert_eq!(files("d/none_*.csv"), paths(&[]));
    }
}
