//! What is missing of a self-test, done on all cores; each outcome is kept as soon as it is there.

use super::Ended;
use super::kept::{self, Kept};
use crate::refusals::calibrations as refused;
use crate::unobservable;
use crate::{Progress, Store};
use hyde_calibrate::{Axis, Case, SelftestError, Simulated, try_case};
use hyde_diag::{Diagnostic, Span};
use hyde_experiment::RunError;
use hyde_units::significant;
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The outcomes of all cases, in their order; those that the store has are taken from there.
pub(super) fn outcomes(
    axis: &Axis<'_>,
    cases: Vec<Case>,
    store: Option<&dyn Store>,
    progress: &dyn Progress,
) -> Result<Vec<(Case, Kept)>, Ended> {
    let total = cases.len();
    let known: Result<Vec<Option<Kept>>, String> = cases
        .iter()
        .map(
            |case| match store.map(|store| store.get(&case.key)).transpose()? {
                Some(Some(bytes)) => kept::decoded(&bytes).map(Some),
                Some(None) | None => Ok(None),
            },
        )
        .collect();
    let known = known.map_err(Ended::Asked)?;
    let before = known.iter().flatten().count();
    let done = AtomicUsize::new(before);
    progress.begin(total, before);
    let pairs: Vec<(Case, Option<Kept>)> = cases.into_iter().zip(known).collect();
    let each = pairs.into_par_iter().with_max_len(1).map(|(case, known)| {
        if let Some(kept) = known {
            return Ok((case, kept));
        }
        let kept: Kept = match try_case(axis, &case) {
            Ok(outcome) => Ok(outcome),
            Err(SelftestError::Interrupted) => return Err(Ended::Interrupted(None)),
            Err(error) => {
                progress.failed();
                Err(reason(&error))
            }
        };
        if let Some(store) = store {
            let put = store.put(&case.key, &kept::encoded(&kept));
            put.and_then(|()| store.sync()).map_err(Ended::Asked)?;
        }
        progress.at(done.fetch_add(1, Ordering::Relaxed) + 1);
        Ok((case, kept))
    });
    let found: Result<Vec<_>, Ended> = each.collect();
    progress.finish();
    found.map_err(|ended| match ended {
        Ended::Interrupted(_) => Ended::Interrupted(Some((done.load(Ordering::Relaxed), total))),
        other @ (Ended::Asked(_) | Ended::Cannot(_)) => other,
    })
}

/// Why a case has no outcome, in a few words.
pub(super) fn reason(error: &SelftestError) -> String {
    match error {
        SelftestError::Interrupted => "interrupted".to_owned(),
        SelftestError::Simulation(Simulated::Run(cause)) => match cause.as_ref() {
            RunError::Failed(failure) => {
                format!("the run fails at {} s", significant(failure.t, 4))
            }
            RunError::NoParameter(name) => format!("it has no parameter `{name}`"),
            RunError::CannotSet(name, cause) | RunError::NoGradientBy(name, cause) => {
                format!("`{name}` cannot be set: {cause}")
            }
            RunError::NotAllowed(name, cause) => {
                format!("the value of `{name}` is not allowed: {cause}")
            }
            RunError::Row(fault) => fault.to_string(),
            RunError::TooManyRows { rows, .. } => format!("it has {rows:.1e} rows"),
            RunError::NotANumber { variable, .. } => format!("`{variable}` is not a number"),
            RunError::NoStop => "its experiment does not say when to stop".to_owned(),
            RunError::EndsBeforeStart {
                start_s, stop_s, ..
            } => format!("it ends at {stop_s} s, before it starts at {start_s} s"),
            RunError::Lasts(span_s) => format!("it would last {span_s} s"),
            RunError::NotPositive(what, value) => format!("{what} is {value}"),
            RunError::Compare(error) => format!("the channel `{}`: {}", error.channel, error.cause),
        },
        SelftestError::Simulation(Simulated::Column(record, column)) => {
            format!("no `measured` or `replay` defines `{record}.{column}`")
        }
        SelftestError::Model => "an observer cannot run the model with it".to_owned(),
        SelftestError::Record(_) => "an observer cannot read its records".to_owned(),
        SelftestError::Unsupported(_) => "an observer cannot run the model".to_owned(),
    }
}

/// An axis that cannot be tested at all.
pub(super) fn cannot(error: &SelftestError, span: Span) -> Diagnostic {
    if let SelftestError::Unsupported(error) = error {
        return unobservable::unsupported(error, span);
    }
    refused::cannot_simulate(&reason(error), span)
}
