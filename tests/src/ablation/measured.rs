//! [`measured`]: a suite of records diagnosed with a [`Change`], answer by answer.

use super::change::Change;
use super::results::Result as Row;
use crate::figures::{cpu_s, is_right};
use crate::root;
use hyde_calibrate::{Asked as Cases, Claim, Outcome, Planting, Size, Thresholds};
use hyde_compiler::{Candidate, DiagnosisPlan, Laws};
use hyde_study::diagnosis::{prepared, search};
use hyde_study::selftest::{Ended, Kept, Options, Subject, selftest, word};
use hyde_study::{Asked, Calibration, Loaded, Progress, Refused};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Planted at this part of their ranges.
const TYPICAL: f64 = 0.05;

/// Records with known answers.
#[derive(Clone, Debug, PartialEq)]
pub enum Suite {
    /// A set of the bench, by number; the folder of all.
    Bench(usize, PathBuf),
    /// Effects planted in simulated records of the small axis, so many of all, with a seed.
    Planted(usize, u64),
    /// Simulated records of the small axis with nothing planted.
    Clean(usize, u64),
}

impl Suite {
    /// What it is called among results.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Bench(number, _) => format!("bench-{number}"),
            Self::Planted(count, seed) => format!("planted-{count}-of-seed-{seed}"),
            Self::Clean(count, seed) => format!("clean-{count}-of-seed-{seed}"),
        }
    }
}

/// Diagnoses a suite with changed thresholds.
///
/// # Errors
/// The model or its records cannot be diagnosed.
pub fn measured(change: &Change, suite: &Suite) -> Result<Row, String> {
    let spent = || cpu_s(false).unwrap_or(f64::NAN);
    let before = spent();
    let answers = match suite {
        Suite::Bench(number, folder) => {
            let data = folder.join(format!("bench-{number}"));
            vec![bench(*number, &data, &change.thresholds)?]
        }
        Suite::Planted(count, seed) => planted(*count, *seed, change.thresholds)?,
        Suite::Clean(count, seed) => clean(*count, *seed, change.thresholds)?,
    };
    let count = |of: &dyn Fn(&Answer) -> bool| answers.iter().filter(|own| of(own)).count();
    let texts: Vec<&str> = answers.iter().map(|own| own.text.as_str()).collect();
    Ok(Row {
        change: change.name.clone(),
        suite: suite.name(),
        cases: answers.len(),
        right: count(&|own| own.right),
        false_alarms: count(&|own| own.false_alarm),
        seconds: spent() - before,
        answers: texts.join("; "),
    })
}

/// An answer of a diagnosis.
struct Answer {
    right: bool,
    false_alarm: bool,
    text: String,
}

/// A diagnosis that can begin.
struct Ready {
    plan: DiagnosisPlan,
    calibration: Calibration,
    candidates: Vec<Candidate>,
    laws: Laws,
}

fn ready(file: &str, study: &str, data: Option<&Path>) -> Result<Ready, String> {
    let asked = Asked {
        data: data.map(Path::to_path_buf),
        whole_library: true,
        ..Asked::of_file(&root().join(file))
    };
    let (plan, mut calibration) =
        prepared(Loaded::of(&asked)?, &asked, Some(study)).map_err(|refused| match refused {
            Refused::Asked(reason) | Refused::Because(reason, _) => reason,
            Refused::Model { .. } => format!("{file} cannot be diagnosed"),
        })?;
    let candidates = calibration.project.candidates();
    let laws = calibration.project.laws();
    let at_fault = || format!("{file} has no effects");
    Ok(Ready {
        plan,
        calibration,
        candidates: candidates.ok_or_else(at_fault)?,
        laws: laws.ok_or_else(at_fault)?,
    })
}

fn bench(number: usize, data: &Path, thresholds: &Thresholds) -> Result<Answer, String> {
    let Ready {
        plan,
        mut calibration,
        candidates,
        laws,
    } = ready("examples/bench_axis/axis.hyde", "bench", Some(data))?;
    let missing = (candidates, laws);
    let report = search(
        &plan,
        &mut calibration,
        missing,
        thresholds,
        false,
        hyde_present::diagnosed::json,
    );
    let report = report.map_err(|diagnostic| diagnostic.message)?;
    let right = is_right(number, &report);
    Ok(Answer {
        right,
        false_alarm: number == 0 && !right,
        text: told(&report),
    })
}

/// The verdict of a report, and the effects with their sites and sizes.
fn told(report: &Value) -> String {
    let effects = report["effects"].as_array().map_or(&[][..], Vec::as_slice);
    let mut text = report["verdict"].as_str().unwrap_or_default().to_owned();
    for effect in effects {
        let word = |key: &str| effect[key].as_str().unwrap_or_default().to_owned();
        let size = effect["size"].as_f64().unwrap_or(f64::NAN);
        let size = hyde_units::significant(size, 4);
        text = format!("{text} {} at {} {size}", word("effect"), word("site"));
    }
    text
}

fn planted(count: usize, seed: u64, thresholds: Thresholds) -> Result<Vec<Answer>, String> {
    let asked = Cases {
        effects: Vec::new(),
        sizes: vec![Size::Part(TYPICAL)],
        seeds: 1,
        empties: 0,
        planted: true,
        parameters: false,
        open_set: false,
        sensors: false,
    };
    cases(asked, Some(count), seed, thresholds)
}

fn clean(count: usize, seed: u64, thresholds: Thresholds) -> Result<Vec<Answer>, String> {
    let asked = Cases {
        effects: Vec::new(),
        sizes: vec![Size::Part(TYPICAL)],
        seeds: 1,
        empties: count,
        planted: false,
        parameters: false,
        open_set: false,
        sensors: false,
    };
    cases(asked, None, seed, thresholds)
}

/// Cases of the self-test on the small axis, each with whether its answer is right.
fn cases(
    asked: Cases,
    sample: Option<usize>,
    seed: u64,
    thresholds: Thresholds,
) -> Result<Vec<Answer>, String> {
    let Ready {
        plan,
        calibration,
        candidates,
        laws,
    } = ready("tests/models/small_axis/axis.hyde", "moves", None)?;
    let subject = Subject {
        plan: &plan,
        calibration: &calibration,
        candidates,
        laws,
        thresholds,
        designs: None,
    };
    let options = Options {
        asked,
        sample,
        seed: Some(seed),
        interrupted: Arc::new(AtomicBool::new(false)),
    };
    let answered = |kind: &Planting, kept: &Kept| match kept {
        Ok(outcome) => {
            let hidden = matches!(kind, Planting::Planted(..)) && !outcome.is_visible();
            let right = hidden || outcome.is_right(kind);
            Answer {
                right,
                false_alarm: !right && *kind == Planting::Empty,
                text: words(outcome),
            }
        }
        Err(reason) => Answer {
            right: false,
            false_alarm: false,
            text: reason.clone(),
        },
    };
    let keep = |_: &_| Ok(None);
    let answers = selftest(subject, &options, keep, &Silent, |tested| {
        let outcomes = tested.outcomes.iter();
        outcomes
            .map(|(case, kept)| answered(&case.kind, kept))
            .collect()
    });
    answers.map_err(|ended| match ended {
        Ended::Asked(reason) => reason,
        Ended::Interrupted(_) => "interrupted".to_owned(),
        Ended::Cannot(diagnostic) => diagnostic.message,
    })
}

/// The verdict of an outcome, and its claims by number.
fn words(outcome: &Outcome) -> String {
    let claim = |claim: &Claim| {
        let number = claim
            .hypothesis
            .map_or("law".to_owned(), |own| own.to_string());
        let others = claim.alternatives.iter();
        let others: Vec<String> = others.map(|(own, _)| own.to_string()).collect();
        let size = hyde_units::significant(claim.size, 4);
        format!(" {number}[{}] {size}", others.join(" "))
    };
    let claims: Vec<String> = outcome.claims.iter().map(claim).collect();
    format!("{}{}", word(outcome.verdict), claims.concat())
}

/// Shows nothing.
struct Silent;

impl Progress for Silent {
    fn begin(&self, _: usize, _: usize) {}

    fn failed(&self) {}

    fn at(&self, _: usize) {}

    fn finish(&self) {}
}
