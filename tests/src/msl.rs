//! The models of `tests/models/msl` against the trajectories that the Modelica Standard Library's own tests keep.
//!
//! Every file there says in comments what it is set beside:
//! ```text
//! // reference Modelica/Mechanics/Rotational/Examples/First/First.csv
//! // signal inertia3.phi = load.phi            a signal that is called otherwise here; a sign may stand before it
//! // signal brake.startForward = 0             a signal that is a constant here
//! // signal brake.mode = mode of brake: free 2, forward 1, stuck 0, backward -1
//! // without gear.mode: why it is not compared; such a model is not counted as matching
//! ```
//! Every signal of `comparisonSignals.txt` is compared; without a line it has the same name here, and `x.mode` without one
//! is the mode of the automaton x by the names above.

mod compare;
mod notes;

use crate::{Example, folder};
use compare::{Curve, Fit};
use hyde_experiment::Options;
use hyde_sim::EventKind;
use notes::{Notes, Source};
use std::path::{Path, PathBuf};

/// What the trajectories are and where they come from, for a machine without them.
pub const ABSENT: &str =
    "msl_reference (github.com/modelica/MAP-LIB_ReferenceResults) is not below the data folder";

/// A model with what it is set beside.
#[derive(Clone, Debug)]
pub struct Case {
    /// The name of its file, without the ending.
    pub name: String,
    path: PathBuf,
    experiment: String,
    notes: Notes,
}

/// How a signal compares.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Its name in the reference.
    pub name: String,
    /// The largest distance over the tolerance; 1 or less matches.
    pub worst: f64,
    /// Where it is, in s.
    pub at: f64,
}

/// How a model compares.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The signals compared.
    pub signals: Vec<Signal>,
    /// The signals that were not, and why.
    pub left_out: Vec<(String, String)>,
}

impl Verdict {
    /// Whether all comparison signals of the reference were compared and match.
    #[must_use]
    pub fn matches(&self) -> bool {
        self.left_out.is_empty() && self.compared_match()
    }

    /// Whether what was compared matches.
    #[must_use]
    pub fn compared_match(&self) -> bool {
        !self.signals.is_empty() && self.signals.iter().all(Signal::matches)
    }
}

impl Signal {
    /// Whether it stays within the tolerance.
    #[must_use]
    pub fn matches(&self) -> bool {
        self.worst <= 1.0
    }
}

/// The folder of the trajectories below the data folder, if it is there.
#[must_use]
pub fn reference(data: &Path) -> Option<PathBuf> {
    Some(data.join("msl_reference")).filter(|folder| folder.join("INDEX.csv").is_file())
}

/// Every model, by name.
///
/// # Errors
/// The folder cannot be read, or a file does not say what it is set beside.
pub fn cases() -> Result<Vec<Case>, String> {
    let paths = folder::models("tests/models/msl")?;
    paths.into_iter().map(Case::read).collect()
}

impl Case {
    fn read(path: PathBuf) -> Result<Self, String> {
        let name = path.file_stem().unwrap_or_default().to_string_lossy();
        let name = name.into_owned();
        let example = Example::load(&path, None)?;
        let notes = Notes::read(example.text()).map_err(|error| format!("{name}: {error}"))?;
        let experiments: Vec<String> = example
            .text()
            .lines()
            .filter_map(|line| line.strip_prefix("experiment "))
            .filter_map(|rest| rest.split_whitespace().next())
            .map(str::to_owned)
            .collect();
        let [experiment] = experiments.as_slice() else {
            return Err(format!(
                "{name}: {} experiments, not one",
                experiments.len()
            ));
        };
        Ok(Self {
            experiment: experiment.clone(),
            name,
            path,
            notes,
        })
    }

    /// Runs the model and compares it; `folder` holds the trajectories.
    ///
    /// # Errors
    /// The model does not run, or the files do not fit each other.
    pub fn compare(&self, folder: &Path) -> Result<Verdict, String> {
        let file = folder.join(&self.notes.reference);
        let table = compare::read_table(&read(&file)?)?;
        let wanted = read(&file.with_file_name("comparisonSignals.txt"))?;
        let stop = table.time.last().copied().unwrap_or(0.0);
        let example = Example::load(&self.path, Some(&self.experiment))?;
        let options = Options {
            every_s: Some(table.usual_step()),
            ..Options::default()
        };
        let (compiled, run) = example.run_with(&options)?;
        if (run.stop_s - stop).abs() > 1e-9 * stop {
            return Err(format!("it stops at {} s, not at {stop} s", run.stop_s));
        }
        let (program, results) = (&compiled.program, &run.results);
        let curve = |source: &Source| -> Result<Curve, String> {
            match source {
                Source::Constant(value) => Ok(Curve::constant(*value, stop)),
                Source::Output(name, sign) => {
                    let output = program.output(name);
                    let column = output.and_then(|output| results.column(output));
                    let column = column.ok_or_else(|| format!("no output `{name}`"))?;
                    let values = column.iter().map(|value| sign * value).collect();
                    Ok(Curve::new(results.time.clone(), values))
                }
                Source::Mode(name, numbers) => {
                    let all = &program.automata;
                    let number = all.iter().position(|automaton| automaton.name == *name);
                    let number = number.ok_or_else(|| format!("no modes `{name}`"))?;
                    let value = |mode: usize| {
                        let mode = &all[number].modes[mode];
                        let known = numbers.iter().find(|(name, _)| name == mode);
                        known
                            .map(|(_, value)| *value)
                            .ok_or_else(|| format!("`{name}` has a mode `{mode}` without a number"))
                    };
                    let switches = results.events.iter().filter_map(|event| match event.kind {
                        EventKind::Transition {
                            automaton,
                            from,
                            to,
                        } if automaton == number => Some((event.t, from, to)),
                        EventKind::Transition { .. }
                        | EventKind::When
                        | EventKind::Relation(_)
                        | EventKind::Slide { .. } => None,
                    });
                    let switches: Vec<(f64, usize, usize)> = switches.collect();
                    let times = &results.mode_times[number];
                    let only = times.iter().position(|time| *time > 0.0).unwrap_or(0);
                    let first = switches.first().map_or(only, |(_, from, _)| *from);
                    let mut points = vec![(0.0, value(first)?)];
                    for (t, from, to) in switches {
                        points.push((t, value(from)?));
                        points.push((t, value(to)?));
                    }
                    let last = points.last().map_or(0.0, |(_, value)| *value);
                    points.push((stop, last));
                    let (time, values) = points.into_iter().unzip();
                    Ok(Curve::new(time, values))
                }
            }
        };
        let mut verdict = Verdict {
            signals: Vec::new(),
            left_out: self.notes.without.clone(),
        };
        let names = wanted.split_whitespace().map(|name| name.trim_matches('"'));
        for name in names.filter(|name| *name != "time") {
            if self.notes.without.iter().any(|(known, _)| known == name) {
                continue;
            }
            let reference = Curve::new(table.time.clone(), table.column(name)?.to_vec());
            let own = curve(&self.notes.source(name)).map_err(|e| format!("{name}: {e}"))?;
            let Fit { worst, at } = compare::fit(&reference, &own, stop);
            verdict.signals.push(Signal {
                name: name.to_owned(),
                worst,
                at,
            });
        }
        Ok(verdict)
    }
}

#[allow(
    clippy::disallowed_methods,
    reason = "tests open the reference's files"
)]
fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}
