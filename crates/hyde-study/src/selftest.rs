//! What the verdicts of a diagnosis are worth on an axis, with its sensors and its records: effects are planted in simulated
//! records, diagnosed, and counted.
//!
//! ```text
//! models        programs of the axis with effects put on, the observed ones made once   selftest/models.rs
//! work          what is missing, case by case, on all cores, kept as it finishes        selftest/work.rs
//! kept          an outcome as bytes and back                                            selftest/kept.rs
//! designs       signals within the limits, to distinguish effects                       selftest/designs.rs
//! records       the simulated records of one case as files                              selftest/records.rs
//! ```

mod designs;
mod kept;
mod models;
mod records;
mod work;

pub use designs::Designs;
pub use kept::{Kept, relation_word, word};

use crate::{Calibration, Progress, Store, diagnosis, unknown};
use hyde_calibrate::{
    Asked, Axis, Case, Designer, Hypothesis, Planting, Point, SelftestError, Tally, Thresholds,
    Written, cases, tally,
};
use hyde_compiler::{Candidate, DiagnosisPlan, Laws};
use hyde_diag::Diagnostic;
use hyde_experiment::batch::{Identity, digest};
use hyde_signal::Table;
use models::Models;
use serde_json::json;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What is asked for.
pub struct Options {
    /// Which cases, and of which sizes.
    pub asked: Asked,
    /// How many of the planted cases at most.
    pub sample: Option<usize>,
    /// The seed, instead of that of the diagnosis.
    pub seed: Option<u64>,
    /// Set by whoever wants it to end early.
    pub interrupted: Arc<AtomicBool>,
}

/// A diagnosis that is to be tested.
pub struct Subject<'a> {
    /// What it asks.
    pub plan: &'a DiagnosisPlan,
    /// The calibration that it stands on.
    pub calibration: &'a Calibration,
    /// The effects of the model.
    pub candidates: Vec<Candidate>,
    /// Where a law may act on the model, and what it may be made of.
    pub laws: Laws,
    /// What decides in each diagnosis.
    pub thresholds: Thresholds,
    /// Signals for the verdicts `one of` of planted effects, if these are to be diagnosed again with one more record.
    pub designs: Option<&'a Designs>,
}

/// What a self-test found.
pub struct Tested<'a> {
    /// The diagnosis.
    pub plan: &'a DiagnosisPlan,
    /// The seed.
    pub seed: u64,
    /// Which cases were asked for.
    pub asked: &'a Asked,
    /// What was planted, by number.
    pub hypotheses: &'a [Hypothesis],
    /// What came of each case.
    pub outcomes: &'a [(Case, Kept)],
    /// The counts.
    pub table: &'a Tally,
    /// Effects of the diagnosis that fit nowhere on the model.
    pub siteless: Vec<String>,
    /// The signals that designed records are made of, if there are any.
    pub designs: Option<&'a Designs>,
}

/// Why there is no self-test.
pub enum Ended {
    /// What was asked cannot be, or a result cannot be kept: one sentence.
    Asked(String),
    /// It was interrupted, after so many of so many cases if it had begun.
    Interrupted(Option<(usize, usize)>),
    /// The axis cannot be tested.
    Cannot(Box<Diagnostic>),
}

/// Plants, diagnoses and counts, and gives what was found to `tell`. `keep` opens the store of finished cases, by the identity
/// of all that decides their outcome; without one they are kept nowhere.
///
/// # Errors
/// See [`Ended`].
pub fn selftest<T>(
    subject: Subject<'_>,
    options: &Options,
    keep: impl FnOnce(&Identity) -> Result<Option<Box<dyn Store>>, String>,
    progress: &dyn Progress,
    tell: impl FnOnce(&Tested<'_>) -> T,
) -> Result<T, Ended> {
    on_axis(subject, options, |axis, ready, all| {
        let seed = ready.seed;
        let Ready {
            plan,
            calibration,
            candidates,
            hypotheses,
            designs,
            ..
        } = ready;
        let identity = identity(ready);
        let store = keep(&identity).map_err(Ended::Asked)?;
        let outcomes = work::outcomes(axis, all, store.as_deref(), progress)?;
        let found: Vec<_> = outcomes
            .iter()
            .filter_map(|(case, kept)| Some((case, kept.as_ref().ok()?.clone())))
            .collect();
        let confounds = |number: usize, other: usize| {
            let name = candidates[other].name();
            let mut confounds = candidates[number].confounds.iter();
            confounds.any(|known| known == name)
        };
        Ok(tell(&Tested {
            plan,
            seed,
            asked: &options.asked,
            table: &tally(&found, &confounds),
            siteless: siteless(calibration, plan, candidates),
            hypotheses,
            outcomes: &outcomes,
            designs: *designs,
        }))
    })
}

/// The simulated records of one case, by the names of their files.
///
/// # Errors
/// See [`Ended`].
pub fn records_of(
    subject: Subject<'_>,
    options: &Options,
    name: &str,
) -> Result<Vec<(String, String)>, Ended> {
    on_axis(subject, options, |axis, ready, all| {
        let case = all.iter().find(|case| case.key == name);
        let case = case.ok_or_else(|| {
            Ended::Asked(format!("no case is called `{name}`; `--json` lists them"))
        })?;
        records::files(axis, case, ready.calibration)
    })
}

/// What a case is made of, beside its axis.
struct Ready<'a> {
    plan: &'a DiagnosisPlan,
    calibration: &'a Calibration,
    candidates: &'a [Candidate],
    hypotheses: &'a [Hypothesis],
    records: &'a [BTreeMap<String, Table>],
    thresholds: Thresholds,
    designs: Option<&'a Designs>,
    seed: u64,
}

/// Makes the axis and its cases, and gives them to `with`.
fn on_axis<T>(
    subject: Subject<'_>,
    options: &Options,
    with: impl FnOnce(&Axis<'_>, &Ready<'_>, Vec<Case>) -> Result<T, Ended>,
) -> Result<T, Ended> {
    let Subject {
        plan,
        calibration,
        candidates,
        laws,
        thresholds,
        designs,
    } = subject;
    let sites: Vec<_> = laws.sites.into_iter().map(unknown::site).collect();
    let shapes: Vec<_> = laws.shapes.into_iter().map(Arc::new).collect();
    let candidates: Vec<Candidate> = candidates
        .into_iter()
        .filter(|candidate| plan.selects(candidate))
        .collect();
    let hypotheses: Vec<Hypothesis> = candidates.iter().map(diagnosis::hypothesis).collect();
    let seed = options.seed.unwrap_or(plan.seed);
    let measured = calibration.compiled.program.experiment.measured.iter();
    let channels: Vec<String> = measured.map(|m| m.name.clone()).collect();
    let all = cases(&hypotheses, &calibration.varied, &channels, &options.asked);
    let all = chosen(options, all, &hypotheses).map_err(Ended::Asked)?;
    let fitted = calibration.fitted.iter();
    let records: Vec<BTreeMap<String, Table>> =
        fitted.map(|recording| recording.tables.clone()).collect();
    let set = calibration.project.set();
    let models = Models::new(&calibration.project, &candidates);
    let simulate =
        |numbers: &[usize], sizes: &[f64], shapes: &[f64]| models.recorded(numbers, sizes, shapes);
    let author = |numbers: &[usize], written: &[Written]| models.observed(numbers, written);
    let axis = Axis::new(
        &calibration.compiled.program,
        &records,
        &calibration.varied,
        &set,
        &hypotheses,
        (&sites, &shapes, &author),
        &simulate,
        plan.max_effects,
        seed,
        Arc::clone(&options.interrupted),
    );
    let mut axis = axis.map_err(|error| match error {
        SelftestError::Interrupted => Ended::Interrupted(None),
        SelftestError::Simulation(_)
        | SelftestError::Model
        | SelftestError::Record(_)
        | SelftestError::Unsupported(_) => Ended::Cannot(Box::new(work::cannot(&error, plan.span))),
    })?;
    axis.thresholds = thresholds;
    let like = records.first();
    let best = designs.zip(like).map(|(designs, like)| {
        let effects = (candidates.as_slice(), hypotheses.as_slice());
        move |points: &[Point]| designs.best(effects, points, like)
    });
    axis.designer = best.as_ref().map(|best| best as &Designer<'_>);
    let ready = Ready {
        plan,
        calibration,
        candidates: &candidates,
        hypotheses: &hypotheses,
        records: &records,
        thresholds,
        designs,
        seed,
    };
    with(&axis, &ready, all)
}

/// The cases, of the planted ones a sample; each effect that was named is known.
fn chosen(
    options: &Options,
    mut all: Vec<Case>,
    hypotheses: &[Hypothesis],
) -> Result<Vec<Case>, String> {
    let known = |name: &String| hypotheses.iter().any(|h| h.effect == *name);
    if let Some(unknown) = options.asked.effects.iter().find(|name| !known(name)) {
        return Err(format!(
            "this diagnosis has no effect `{unknown}` with a site on the model; `hyde effects FILE` lists them"
        ));
    }
    let is_planted = |case: &Case| matches!(case.kind, Planting::Planted(..));
    let count = all.iter().filter(|case| is_planted(case)).count();
    if let Some(most) = options.sample.filter(|most| *most < count) {
        let mut number = 0;
        all.retain(|case| {
            if !is_planted(case) {
                return true;
            }
            number += 1;
            number * most / count > (number - 1) * most / count
        });
    }
    Ok(all)
}

/// Effects that the diagnosis names and the model has no site for.
fn siteless(
    calibration: &Calibration,
    plan: &DiagnosisPlan,
    candidates: &[Candidate],
) -> Vec<String> {
    let names = calibration.project.file.effects_known();
    let selected = |full: &String| {
        plan.candidates.iter().any(|pattern| {
            let package = pattern.strip_suffix(".*");
            package.map_or(pattern == full, |package| {
                full.strip_prefix(package)
                    .is_some_and(|rest| rest.starts_with('.'))
            })
        })
    };
    let short = |full: String| full.rsplit('.').next().unwrap_or_default().to_owned();
    names
        .filter(selected)
        .map(short)
        .filter(|name| !candidates.iter().any(|candidate| candidate.name() == name))
        .collect()
}

/// What decides the outcome of a case beside its name: all texts of the model and the library, the records, the seed.
fn identity(ready: &Ready<'_>) -> Identity {
    let Ready {
        plan,
        calibration,
        records,
        thresholds,
        designs,
        seed,
        ..
    } = ready;
    let sources: Vec<&[u8]> = calibration
        .project
        .sources
        .iter()
        .map(|(_, source)| source.text.as_bytes())
        .collect();
    let mut numbers = Vec::new();
    for column in records
        .iter()
        .flat_map(BTreeMap::values)
        .flat_map(Table::columns)
    {
        numbers.extend(
            column
                .values()
                .iter()
                .flat_map(|value| value.to_bits().to_le_bytes()),
        );
    }
    let set = calibration.project.set();
    let mut order = json!({ "form": 2, "diagnosis": plan.name, "seed": seed, "set": set, "thresholds": format!("{thresholds:?}"), "hyde": env!("CARGO_PKG_VERSION") });
    if let Some(designs) = designs {
        order["designs"] = json!(designs.identity());
    }
    digest(&[
        &digest(&sources).0,
        &digest(&[&numbers]).0,
        order.to_string().as_bytes(),
    ])
}
