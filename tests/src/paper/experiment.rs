//! [`tests`]: the experiments of `tests/models/paper`, and whether what they expect holds.

use super::table::read;
use crate::{Example, root};
use hyde_compiler::Backend;
use hyde_experiment::{linearize, modes, parameters};
use std::collections::BTreeMap;

/// An experiment of a model file.
#[derive(Clone, Debug)]
pub struct Test {
    /// `file: experiment`.
    pub name: String,
    file: String,
    experiment: String,
    text: String,
    frequencies: Option<Frequencies>,
}

/// What the comment above an experiment says of its natural frequencies.
#[derive(Clone, Debug, PartialEq)]
struct Frequencies {
    hz: Vec<f64>,
    within: f64,
}

/// Every experiment, by file.
///
/// # Errors
/// The folder or a file cannot be read.
#[allow(clippy::disallowed_methods, reason = "tests list their models")]
pub fn tests() -> Result<Vec<Test>, String> {
    let folder = root().join("tests/models/paper");
    let entries = std::fs::read_dir(&folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let mut paths: Vec<_> = entries
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        let text = read(&path)?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let names = text
            .lines()
            .filter_map(|line| line.strip_prefix("experiment "));
        for experiment in names.filter_map(|rest| rest.split([' ', '(']).next()) {
            found.push(Test {
                name: format!("{stem}: {experiment}"),
                file: format!("tests/models/paper/{stem}.hyde"),
                experiment: experiment.to_owned(),
                text: text.clone(),
                frequencies: frequencies(&text, experiment)?,
            });
        }
    }
    Ok(found)
}

impl Test {
    /// The text of its file.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Runs it; what does not hold.
    ///
    /// # Errors
    /// It does not compile or run, it expects nothing, or an expectation does not hold.
    pub fn passes(&self) -> Result<(), String> {
        let outcome = match &self.frequencies {
            Some(expected) => self.has(expected),
            None => self.holds(),
        };
        outcome.map_err(|told| format!("{}: {told}", self.name))
    }

    fn holds(&self) -> Result<(), String> {
        let (_, run) = Example::load(&self.file, Some(&self.experiment))?.run()?;
        let mut expected = run.measures.iter().filter(|measure| measure.expectation);
        if expected.clone().next().is_none() {
            return Err("it expects nothing".to_owned());
        }
        match expected.find(|measure| !measure.holds) {
            Some(measure) => Err(format!("`{}` does not hold", measure.name)),
            None => Ok(()),
        }
    }

    /// Whether its lowest natural frequencies are those; the free motion of the whole axis does not count.
    fn has(&self, expected: &Frequencies) -> Result<(), String> {
        let example = Example::load(&self.file, Some(&self.experiment))?;
        let program = example.compile(Backend::Native)?.program;
        let tables = BTreeMap::new();
        let p = parameters(&program, &tables, &[]).map_err(|error| format!("{error:?}"))?;
        let chosen = program.experiment.bodes.first();
        let chosen = chosen.map_or(&[][..], |bode| &bode.modes);
        let linear =
            linearize(&program, &tables, &p, &[], chosen).map_err(|error| format!("{error:?}"))?;
        let found = modes(&linear).into_iter().map(|mode| mode.frequency_hz);
        let found: Vec<f64> = found.filter(|frequency| *frequency > 1.0).collect();
        if found.len() < expected.hz.len() {
            return Err(format!("only {} frequencies", found.len()));
        }
        for (found, expected_hz) in found.iter().zip(&expected.hz) {
            if (found / expected_hz - 1.0).abs() > expected.within {
                return Err(format!("{found} Hz, not {expected_hz}"));
            }
        }
        Ok(())
    }
}

/// Of `// modes of NAME: 34.69 87.84 Hz within 0.05 %`.
fn frequencies(text: &str, experiment: &str) -> Result<Option<Frequencies>, String> {
    let start = format!("// modes of {experiment}: ");
    let Some(rest) = text.lines().find_map(|line| line.strip_prefix(&start)) else {
        return Ok(None);
    };
    let bad = || format!("`{start}{rest}` is not understood");
    let (hz, within) = rest.split_once(" Hz within ").ok_or_else(bad)?;
    let percent = within.strip_suffix(" %").ok_or_else(bad)?;
    let numbers: Result<Vec<f64>, _> = hz.split(' ').map(str::parse).collect();
    Ok(Some(Frequencies {
        hz: numbers.map_err(|_| bad())?,
        within: percent.parse::<f64>().map_err(|_| bad())? / 100.0,
    }))
}
