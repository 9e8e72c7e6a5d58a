//! Whatever stands in a file, the compiler ends with a model or with an error inside the file, never with a panic.
//!
//! The texts of the examples and of the wrong files, mutilated: characters, words and lines taken away, doubled, swapped,
//! cut off. `HYDE_MUTANTS` sets how many a text, for long runs.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use hyde_compiler::{Backend, Form, FreeInputs, Packages, Request};
use hyde_diag::{Diagnostics, Severity, Sources};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;
use std::time::Duration;

/// A text that takes longer hangs the compiler: the largest of them takes milliseconds.
const PATIENCE: Duration = Duration::from_secs(60);

#[test]
fn mutilated_files_never_panic() {
    let count: u64 = std::env::var("HYDE_MUTANTS").map_or(12, |text| text.parse().unwrap());
    for path in models() {
        let text = std::fs::read_to_string(&path).unwrap();
        // Each file has its own numbers, whatever files there are beside it.
        let bytes = text.bytes();
        let mut random = Random(bytes.fold(20_261_121, |sum, byte| {
            (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        }));
        for _ in 0..count {
            let mutant = mutilated(&text, &mut random);
            ends_well(&path, &mutant);
        }
    }
}

#[test]
fn strange_files_never_panic() {
    let deep = format!(
        "model A\n Real x = {}1{};\nend A;",
        "(".repeat(10_000),
        ")".repeat(10_000)
    );
    let nested = "model A\nequation\n".to_owned() + &"if true then\n".repeat(5_000);
    let long = format!("model A\n Real {};\nend A;", "x".repeat(1_000_000));
    let texts = [
        "",
        "\u{feff}model A\n Real x = 1;\nend A;",
        "model A\r\n Real x = 1;\r\nend A;\r\n",
        "\0\u{1}\u{7f}\u{fffd}",
        "model",
        "model A",
        "end A;",
        "𝛂 = 𝛃",
        "model A Real x[1000000000000]; end A;",
        "model A Real x[-1]; equation x[99999999999999999999] = 0; end A;",
        "model A A a; end A;",
        "model A = A;",
        "model A extends A; end A;",
        "experiment e of A; end e;",
        "model A parameter Real p = p; Real x = p; end A;",
        "model A Real x = 1e999 [m]; end A;",
        &deep,
        &nested,
        &long,
    ];
    for text in texts {
        ends_well(Path::new("strange.hyde"), text);
    }
}

/// Compiles every model and experiment of a text up to the DAE.
fn ends_well(path: &Path, text: &str) {
    let (send, receive) = channel();
    let own = text.to_owned();
    std::thread::spawn(move || send.send(catch_unwind(AssertUnwindSafe(|| compiled(&own)))));
    let wrong = match receive.recv_timeout(PATIENCE) {
        Ok(Ok(wrong)) => wrong,
        Ok(Err(_)) => Some("it panicked".to_owned()),
        Err(_) => Some(format!("it did not end within {PATIENCE:?}")),
    };
    if let Some(wrong) = wrong {
        let shown: String = text.chars().take(20_000).collect();
        panic!("{}: {wrong}\n{shown}", path.display());
    }
}

/// What is wrong with the way the compiler ended.
fn compiled(text: &str) -> Option<String> {
    let mut sources = Sources::new();
    let mut diagnostics = Diagnostics::new();
    let file = hyde_compiler::load(
        &mut sources,
        "mutant.hyde",
        text,
        &Packages::LIBRARY,
        &mut diagnostics,
    );
    let (settings, records) = (BTreeMap::new(), BTreeMap::new());
    let experiments = file.experiments().map(|experiment| {
        (
            experiment.model.dotted(),
            Some(experiment.name.text.clone()),
        )
    });
    let models = file.models().map(|model| (model.to_owned(), None));
    let mut all: Vec<(String, Option<String>)> = experiments.chain(models).collect();
    all.truncate(6);
    for (model, experiment) in all {
        let request = Request {
            sources: &sources,
            file: &file,
            model: &model,
            experiment: experiment.as_deref(),
            settings: &settings,
            records: &records,
            free_inputs: FreeInputs::All,
            ledger: true,
            form: Form::Run,
            backend: Backend::Interpreter,
        };
        let mut own = diagnostics.clone();
        let dae = hyde_compiler::analyze(&request, &mut own);
        if dae.is_none() && !own.has_errors() {
            return Some(format!("`{model}` gives neither a model nor an error"));
        }
        for diagnostic in own.iter().filter(|d| d.severity == Severity::Error) {
            if diagnostic.labels.is_empty() {
                return Some(format!("{} has no place", diagnostic.code));
            }
            for label in &diagnostic.labels {
                let (start, end) = (label.span.start as usize, label.span.end as usize);
                // `None` outside the text, between the bytes of a letter, and where the end is before the start.
                if sources.get(label.span.file).text.get(start..end).is_none() {
                    return Some(format!("{} points outside its text", diagnostic.code));
                }
            }
        }
    }
    None
}

/// Every model file of the examples, the test models and the wrong files.
fn models() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![
        hyde_tests::root().join("examples"),
        hyde_tests::root().join("tests/models"),
        hyde_tests::root().join("tests/fixtures/errors"),
    ];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path
                .extension()
                .is_some_and(|extension| extension == "hyde")
            {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// One to three mutilations of a text.
fn mutilated(text: &str, random: &mut Random) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        text = match random.below(6) {
            0 => by_lines(&text, random, |lines, a, _| {
                lines.remove(a);
            }),
            1 => by_lines(&text, random, |lines, a, b| lines.insert(b, lines[a])),
            2 => by_lines(&text, random, |lines, a, b| lines.swap(a, b)),
            3 => by_words(&text, random, |words, a, _| {
                words.remove(a);
            }),
            4 => by_words(&text, random, |words, a, b| words.swap(a, b)),
            _ => {
                let cut = random.below(text.chars().count().max(1));
                text.chars().take(cut).collect()
            }
        };
    }
    text
}

fn by_lines(
    text: &str,
    random: &mut Random,
    change: impl Fn(&mut Vec<&str>, usize, usize),
) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    changed(&mut lines, random, change);
    lines.join("\n")
}

fn by_words(
    text: &str,
    random: &mut Random,
    change: impl Fn(&mut Vec<&str>, usize, usize),
) -> String {
    let mut words: Vec<&str> = text
        .split_inclusive(|c: char| !c.is_alphanumeric())
        .collect();
    changed(&mut words, random, change);
    words.concat()
}

fn changed<'t>(
    parts: &mut Vec<&'t str>,
    random: &mut Random,
    change: impl Fn(&mut Vec<&'t str>, usize, usize),
) {
    if !parts.is_empty() {
        let (a, b) = (random.below(parts.len()), random.below(parts.len()));
        change(parts, a, b);
    }
}

/// A linear congruential generator (Knuth, MMIX): the same mutants on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        usize::try_from(self.0 >> 33).unwrap_or(0) % limit
    }
}
