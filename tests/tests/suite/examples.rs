//! Every experiment of every file under `examples/`, found by itself.

use hyde_tests::{Example, root};
use std::path::{Path, PathBuf};

/// An experiment of an example, or a model as it stands where the file has no experiment.
pub(crate) struct Case {
    /// The folder, and the experiment behind a dot.
    pub(crate) name: String,
    /// The folder.
    pub(crate) folder: String,
    /// The example with its records.
    pub(crate) example: Example,
}

/// All of them, in the order of their names.
pub(crate) fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    for file in files() {
        let folder = file.parent().and_then(Path::file_name).unwrap();
        let folder = folder.to_string_lossy().into_owned();
        let plain = Example::load(&file, None).unwrap();
        let loaded = plain.parse().unwrap_or_else(|error| panic!("{error}"));
        let experiments: Vec<_> = loaded.file.experiments().collect();
        if experiments.is_empty() {
            cases.push(Case {
                name: folder.clone(),
                folder,
                example: plain,
            });
            continue;
        }
        for experiment in experiments {
            let name = &experiment.name.text;
            let mut example = Example::load(&file, Some(name)).unwrap();
            for record in &experiment.records {
                let beside = record.default.as_ref();
                let beside = beside.map(|default| file.with_file_name(&default.text));
                if !beside.is_some_and(|path| path.exists()) {
                    example =
                        example.record(&record.name.text, stand_in(&folder, &record.name.text));
                }
            }
            cases.push(Case {
                name: format!("{folder}.{name}"),
                folder: folder.clone(),
                example,
            });
        }
    }
    assert!(!cases.is_empty(), "no examples were found");
    cases
}

/// A made-up record of the same columns, for an example whose data are not ours to ship.
fn stand_in(folder: &str, record: &str) -> PathBuf {
    let records = root().join("tests/records");
    let path = records.join(format!("{folder}.{record}.csv"));
    assert!(path.exists(), "{} takes the record's place", path.display());
    path
}

fn files() -> Vec<PathBuf> {
    let mut found = Vec::new();
    for folder in entries(&root().join("examples")) {
        if folder.is_dir() {
            let inside = entries(&folder).into_iter();
            found.extend(inside.filter(|path| path.extension().is_some_and(|e| e == "hyde")));
        }
    }
    found
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}
