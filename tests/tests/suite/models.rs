//! The small models of `tests/models`, run.

use hyde_compiler::Compiled;
use hyde_experiment::{Options, Run};
use hyde_sim::EventKind;
use hyde_tests::Example;
use std::borrow::Cow;

/// A run with its program.
pub(crate) struct Solved {
    pub(crate) compiled: Compiled,
    pub(crate) run: Run,
}

/// An experiment of a model file, by its name without the ending.
pub(crate) fn model(file: &str, experiment: Option<&str>) -> Example {
    Example::load(format!("tests/models/{file}.hyde"), experiment).unwrap()
}

/// Runs it as it stands.
pub(crate) fn solve(file: &str, experiment: &str) -> Solved {
    solve_with(file, experiment, &Options::default())
}

/// Runs it with other tolerances or times.
pub(crate) fn solve_with(file: &str, experiment: &str, options: &Options) -> Solved {
    let outcome = model(file, Some(experiment)).run_with(options);
    let (compiled, run) = outcome.unwrap_or_else(|error| panic!("{file}: {error}"));
    Solved { compiled, run }
}

impl Solved {
    /// A column of the results.
    pub(crate) fn column(&self, name: &str) -> Cow<'_, [f64]> {
        let output = self.compiled.program.output(name);
        let output = output.unwrap_or_else(|| panic!("no output `{name}`"));
        self.run.results.column(output).unwrap()
    }

    /// The times of the rows in s.
    pub(crate) fn time(&self) -> &[f64] {
        &self.run.results.time
    }

    /// Times of the events in s, with the mode entered where one was.
    pub(crate) fn events(&self) -> Vec<(f64, &str)> {
        let automata = &self.compiled.program.automata;
        let events = self.run.results.events.iter();
        events
            .map(|event| match event.kind {
                EventKind::Transition { automaton, to, .. } => {
                    (event.t, automata[automaton].modes[to].as_str())
                }
                EventKind::When => (event.t, "when"),
                EventKind::Relation(_) => (event.t, "if"),
                EventKind::Slide { .. } => (event.t, "slide"),
            })
            .collect()
    }

    /// The rows before and after the last event of an instant.
    pub(crate) fn rows_at(&self, t: f64) -> (usize, usize) {
        self.run.results.rows_at(t).unwrap()
    }
}

/// Fails unless two numbers are closer than `tolerance`.
#[track_caller]
pub(crate) fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found:e} instead of {expected:e} (± {tolerance:e})"
    );
}
