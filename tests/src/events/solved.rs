//! A run of a case, and comparisons that say what differs.

use crate::Example;
use hyde_compiler::Compiled;
use hyde_experiment::{Options, Run};
use hyde_sim::Event;
use std::borrow::Cow;

/// A run with its program.
pub(super) struct Solved {
    compiled: Compiled,
    pub(super) run: Run,
}

/// Runs an experiment of a file of `tests/models`, given without its ending.
pub(super) fn solve(file: &str, experiment: &str) -> Result<Solved, String> {
    solve_with(file, experiment, &Options::default())
}

/// The same with other tolerances or times.
pub(super) fn solve_with(
    file: &str,
    experiment: &str,
    options: &Options,
) -> Result<Solved, String> {
    let example = Example::load(format!("tests/models/{file}.hyde"), Some(experiment))?;
    let (compiled, run) = example.run_with(options)?;
    Ok(Solved { compiled, run })
}

impl Solved {
    /// A column of the results.
    pub(super) fn column(&self, name: &str) -> Result<Cow<'_, [f64]>, String> {
        let output = self.compiled.program.output(name);
        let column = output.and_then(|output| self.run.results.column(output));
        column.ok_or_else(|| format!("no output `{name}`"))
    }

    /// The last value of a column.
    pub(super) fn last(&self, name: &str) -> Result<f64, String> {
        let last = self.column(name)?.last().copied();
        last.ok_or_else(|| format!("no row of `{name}`"))
    }

    /// The values of a column before and after the events of an instant.
    pub(super) fn around(&self, name: &str, t: f64) -> Result<(f64, f64), String> {
        let rows = self.run.results.rows_at(t);
        let (before, after) = rows.ok_or_else(|| format!("no row at {t} s"))?;
        let column = self.column(name)?;
        Ok((column[before], column[after]))
    }

    /// The event log.
    pub(super) fn events(&self) -> &[Event] {
        &self.run.results.events
    }

    /// Whether the log holds these events and no others, at their times in s.
    pub(super) fn happened(&self, expected: &[(f64, &str)], tolerance: f64) -> Result<(), String> {
        let events = self.events();
        same("number of events", &events.len(), &expected.len())?;
        for (event, (t, cause)) in events.iter().zip(expected) {
            same("condition", &event.cause.as_str(), cause)?;
            close(cause, event.t, *t, tolerance)?;
        }
        Ok(())
    }
}

/// Whether two numbers are closer than a tolerance.
pub(super) fn close(what: &str, found: f64, expected: f64, tolerance: f64) -> Result<(), String> {
    let near = (found - expected).abs() <= tolerance;
    near.then_some(())
        .ok_or_else(|| format!("{what}: {found:e} instead of {expected:e} (± {tolerance:e})"))
}

/// Whether two things are the same.
pub(super) fn same<T: PartialEq + std::fmt::Debug>(
    what: &str,
    found: &T,
    expected: &T,
) -> Result<(), String> {
    (found == expected)
        .then_some(())
        .ok_or_else(|| format!("{what}: {found:?} instead of {expected:?}"))
}

/// The failure that a run must end with, as text; an error if it does not fail.
pub(super) fn failure(file: &str, experiment: &str, options: &Options) -> Result<String, String> {
    match solve_with(file, experiment, options) {
        Ok(_) => Err("it ran to its end".to_owned()),
        Err(told) => Ok(told),
    }
}

/// Whether a text tells all of these.
pub(super) fn tells(text: &str, parts: &[&str]) -> Result<(), String> {
    let missing = parts.iter().find(|part| !text.contains(**part));
    missing.map_or(Ok(()), |part| Err(format!("no `{part}` in `{text}`")))
}

/// The time in s that a failure tells.
pub(super) fn time_told(text: &str) -> Result<f64, String> {
    let time = text
        .split_once(" at ")
        .and_then(|(_, rest)| rest.split_once(" s"));
    let number = time.and_then(|(time, _)| time.parse().ok());
    number.ok_or_else(|| format!("no time in `{text}`"))
}
