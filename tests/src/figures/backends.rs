//! `jit_vs_interpreter_max_ulp`: do machine code and the interpreter of the IR agree to the last bit?

use super::promise::{Figure, Measured, Promise, Session};
use crate::last_bit::{Place, Random};
use crate::{Example, root};
use hyde_compiler::Backend;
use std::path::{Path, PathBuf};

pub(super) const FIGURE: Figure = Figure {
    name: "jit_vs_interpreter_max_ulp",
    unit: "ulp",
    promise: Promise::Exactly(0.0),
    measure: |session| Ok(Measured::Value(most_apart(session)?)),
};

/// Points at which every kernel is compared.
const POINTS: usize = 5;

/// The largest distance over all kernels of all examples.
fn most_apart(session: &Session) -> Result<f64, String> {
    let mut examples: Vec<Example> = Vec::new();
    for path in models()? {
        examples.extend(every_experiment(&path, session)?);
    }
    let mut most = 0;
    for example in examples {
        let native = example.compile(Backend::Native)?.program;
        let interpreted = example.compile(Backend::Interpreter)?.program;
        let mut random = Random(1);
        for _ in 0..POINTS {
            let place = Place::random(&native, &mut random);
            most = most.max(place.apart(&native, &interpreted)?);
        }
    }
    // Beyond 2^53 the count itself is rounded; by then nothing agrees.
    Ok(most as f64)
}

/// The examples, and the models of the other figures.
fn models() -> Result<Vec<PathBuf>, String> {
    let list = |folder: PathBuf| -> Result<Vec<PathBuf>, String> {
        let entries =
            std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
        paths.sort();
        Ok(paths)
    };
    let mut folders = list(root().join("examples"))?;
    folders.retain(|path| path.is_dir());
    folders.push(root().join("tests/models"));
    let mut found = Vec::new();
    for folder in folders {
        let mut files = list(folder)?;
        files.retain(|path| path.extension().is_some_and(|end| end == "hyde"));
        found.extend(files);
    }
    Ok(found)
}

/// A file with each of its experiments; the model alone where it has none or where the records are not here.
fn every_experiment(path: &Path, session: &Session) -> Result<Vec<Example>, String> {
    let plain = Example::load(path, None)?.free_inputs();
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default();
    let mut found = Vec::new();
    for experiment in plain.parse()?.file.experiments() {
        let shipped = Example::load(path, Some(&experiment.name.text))?;
        let measured = shipped.clone().data(session.data.join(folder));
        found.extend(
            [shipped, measured]
                .into_iter()
                .find(|example| example.parse().is_ok()),
        );
    }
    if found.is_empty() {
        found.push(plain);
    }
    Ok(found)
}
