//! One case: the solution of a program with these values, and what is kept of it.

use super::dataset::Dataset;
use super::outcome::{Outcome, Trajectory};
use crate::measures::{Missing, measures};
use crate::run::{Options, setup, within_bounds};
use crate::run_error::RunError;
use hyde_program::Program;
use hyde_signal::Table;
use std::collections::BTreeMap;

/// What a case of a program leaves in a data set, by number: the variant of a model may lack some of it.
#[derive(Clone, Debug)]
pub struct Wanted {
    /// The outputs to make, ascending.
    outputs: Vec<usize>,
    /// The program's measure for each of the data set's.
    measures: Vec<Option<usize>>,
    /// The output for each variable kept over time.
    kept: Vec<Option<usize>>,
}

impl Wanted {
    /// What a program has of a data set.
    #[must_use]
    pub fn of(program: &Program, dataset: &Dataset) -> Self {
        let known = &program.experiment.measures;
        let measures = dataset.measures.iter();
        let measures = measures
            .map(|m| known.iter().position(|k| k.name == m.name))
            .collect();
        let kept: Vec<Option<usize>> = dataset
            .kept
            .iter()
            .map(|column| program.output(&column.name))
            .collect();
        let mut outputs: Vec<usize> = kept.iter().copied().flatten().collect();
        outputs.sort_unstable();
        outputs.dedup();
        Self {
            outputs,
            measures,
            kept,
        }
    }
}

/// Solves a case. Of the results only what is wanted is made.
///
/// # Errors
/// Why there is no solution: of a batch this is an outcome like another.
pub fn solve(
    program: &Program,
    records: &BTreeMap<String, Table>,
    options: &Options,
    wanted: &Wanted,
) -> Result<Outcome, RunError> {
    let mut setup = setup(program, records, options)?;
    within_bounds(program, &setup.parameters)?;
    setup.keep = Some(wanted.outputs.clone());
    let results = hyde_sim::simulate(program, &setup).map_err(RunError::Failed)?;
    let found = measures(program, &setup.parameters, &results);
    // Half a case is none: what is not a number is told as the case's fault.
    let bad = found.iter().find_map(|measure| match &measure.missing {
        Some(Missing::NotANumber { variable, t }) => Some(RunError::NotANumber {
            measure: measure.name.clone(),
            variable: variable.clone(),
            t: *t,
        }),
        Some(
            Missing::Nothing(_) | Missing::Infinite(_) | Missing::Unsettled(_) | Missing::Undefined,
        )
        | None => None,
    });
    if let Some(bad) = bad {
        return Err(bad);
    }
    let value = |number: &Option<usize>| number.map_or(f64::NAN, |number| found[number].value);
    let column = |number: &Option<usize>| {
        let column = number.and_then(|number| results.column(number));
        column.map_or_else(
            || vec![f64::NAN; results.time.len()],
            std::borrow::Cow::into_owned,
        )
    };
    let trajectory = (!wanted.kept.is_empty()).then(|| Trajectory {
        columns: wanted.kept.iter().map(column).collect(),
        time: results.time.clone(),
    });
    Ok(Outcome {
        measures: wanted.measures.iter().map(value).collect(),
        fault: None,
        steps: results.statistics.steps,
        events: results.statistics.events,
        trajectory,
    })
}
