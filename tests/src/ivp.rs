//! The problems of the Test Set for IVP Solvers (Mazzia and Magherini, release 2.4, Bari 2008), written anew in
//! `tests/models/ivp`, against the end values that the test set gives.
//!
//! Every file there says in comments what it is set beside; its name is that of the problem:
//! ```text
//! // components s1..7.x s1..7.y     the outputs that are the components 1, 2, … of the reference; 1..7 counts up
//! // short: …                       why six digits are not reached; such a problem is not counted
//! ```

use crate::{Example, folder};
use hyde_compiler::Backend;
use hyde_experiment::{Options, RunError};
use hyde_program::{Constant, Program};
use hyde_sim::{Results, Statistics};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What the end values are and where they come from, for a machine without them.
pub const ABSENT: &str =
    "ivp_testset (end values of the Test Set for IVP Solvers) is not below the data folder";

/// The relative tolerance at which the files' experiments run; the absolute one is theirs.
pub const RTOL: f64 = 1e-8;

/// The digits that a problem needs to count as solved.
pub const ENOUGH_DIGITS: f64 = 6.0;

/// The end in s and the components there, by the name of the problem.
pub type Reference = BTreeMap<String, (f64, Vec<f64>)>;

/// A problem with what it is set beside.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Its name in the test set, and that of its file.
    pub name: String,
    /// Why it does not reach six digits, if that is known.
    pub short: Option<String>,
    path: PathBuf,
    components: Vec<String>,
}

/// How near a problem came to the reference, and what that cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// Correct digits: minus the decimal logarithm of the largest relative error over the components.
    pub digits: f64,
    /// The component with that error.
    pub worst: String,
    /// What the solver did.
    pub work: Statistics,
}

/// The reference end values below the data folder; `None` if the file is not there.
///
/// # Errors
/// The file is there and cannot be read.
#[allow(
    clippy::disallowed_methods,
    reason = "tests open the reference's files"
)]
pub fn reference(data: &Path) -> Result<Option<Reference>, String> {
    let path = data.join("ivp_testset/reference_end_values.csv");
    if !path.is_file() {
        return Ok(None);
    }
    let text =
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut found: Reference = BTreeMap::new();
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let [name, _, _, end, component, value, ..] = cells.as_slice() else {
            return Err(format!("not a row of end values: {line}"));
        };
        let number = |cell: &str| {
            let parsed = cell.parse::<f64>();
            parsed.map_err(|_| format!("`{cell}` is no number: {line}"))
        };
        let (_, values) = found
            .entry((*name).to_owned())
            .or_insert((number(end)?, Vec::new()));
        if component.parse() != Ok(values.len() + 1) {
            return Err(format!("a component is missing before: {line}"));
        }
        values.push(number(value)?);
    }
    Ok(Some(found))
}

/// Every problem, by name.
///
/// # Errors
/// The folder cannot be read, or a file does not say what it is set beside.
pub fn problems() -> Result<Vec<Problem>, String> {
    let paths = folder::models("tests/models/ivp")?;
    paths.into_iter().map(Problem::read).collect()
}

impl Problem {
    fn read(path: PathBuf) -> Result<Self, String> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let name = name.into_owned();
        let example = Example::load(&path, None)?;
        let note = |word: &str| {
            let mut lines = example.text().lines();
            lines.find_map(|line| line.strip_prefix("// ")?.strip_prefix(word))
        };
        let components = note("components ").ok_or_else(|| format!("{name}: no components"))?;
        Ok(Self {
            components: components.split_whitespace().flat_map(counted).collect(),
            short: note("short: ").map(str::to_owned),
            name,
            path,
        })
    }

    /// Runs the problem at a relative tolerance, with the absolute one in proportion, and compares its end.
    ///
    /// # Errors
    /// The model does not run, or its components or its stop are not those of the reference.
    pub fn solve(&self, reference: &Reference, rtol: f64) -> Result<Solved, String> {
        let (end, values) = reference
            .get(&self.name)
            .ok_or_else(|| format!("the reference has no problem `{}`", self.name))?;
        let example = Example::load(&self.path, Some("solve"))?;
        let program = example.compile(Backend::Native)?.program;
        let records = BTreeMap::new();
        let parameters = hyde_experiment::parameters(&program, &records, &[])
            .map_err(|error| format!("{error:?}"))?;
        let atol = program.kernels.constant(Constant::Atol, &parameters);
        let options = Options {
            rtol: Some(rtol),
            atol: atol.map(|atol| atol * rtol / RTOL),
            ..Options::default()
        };
        let run =
            hyde_experiment::run(&program, &records, &options).map_err(|error| cause(&error))?;
        if (run.stop_s - end).abs() > 1e-12 * end {
            return Err(format!("it stops at {} s, not at {end} s", run.stop_s));
        }
        let (mut largest, mut worst) = (0.0_f64, String::new());
        for (name, expected) in self.components.iter().zip(values) {
            let found = at_end(&program, &run.results, name)
                .ok_or_else(|| format!("no output or unknown `{name}`"))?;
            let error = ((found - expected) / expected).abs();
            // What is not a number must show.
            if error > largest || error.is_nan() {
                (largest, worst) = (error, name.clone());
            }
        }
        Ok(Solved {
            digits: -largest.log10(),
            worst,
            work: run.results.statistics,
        })
    }
}

/// Why there is no run, without its results.
fn cause(error: &RunError) -> String {
    if let RunError::Failed(failure) = error {
        return format!("{:?} at {} s", failure.kind, failure.t);
    }
    format!("{error:?}")
}

/// The last value of an output, or of an unknown: long arrays are no outputs.
fn at_end(program: &Program, results: &Results, name: &str) -> Option<f64> {
    if let Some(output) = program.output(name) {
        return results.column(output)?.last().copied();
    }
    let unknown = (0..program.n_unknowns).find(|&at| program.unknown_name(at) == name)?;
    results.last.0.get(unknown).copied()
}

/// `s1..7.x` as `s1.x`, `s2.x`, …; any other name as it is.
fn counted(name: &str) -> Vec<String> {
    let digits = |text: &str| text.chars().take_while(char::is_ascii_digit).count();
    let Some((before, after)) = name.split_once("..") else {
        return vec![name.to_owned()];
    };
    let reversed: String = before.chars().rev().collect();
    let (stem, first) = before.split_at(before.len() - digits(&reversed));
    let (last, rest) = after.split_at(digits(after));
    match (first.parse::<u32>(), last.parse::<u32>()) {
        (Ok(first), Ok(last)) => (first..=last)
            .map(|number| format!("{stem}{number}{rest}"))
            .collect(),
        _ => vec![name.to_owned()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_count_up() {
        assert_eq!(counted("U4"), ["U4"]);
        assert_eq!(counted("s1..3.x"), ["s1.x", "s2.x", "s3.x"]);
        assert_eq!(counted("th[9..10]"), ["th[9]", "th[10]"]);
    }
}
