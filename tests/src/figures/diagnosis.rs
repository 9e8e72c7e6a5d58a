//! `bench_sets_right`, `bench_chi_minus_truth_max`, `bench_windows_over_truth_max`, `bench_free_run_over_truth_max`,
//! `diagnose_minutes`: the command on the six sets of the bench, whose answers are those of their SOURCE.md. The command is
//! this program itself.
//!
//! A single free run is a lottery where standstills end on this count of the encoder or on that: with its origin moved by
//! thousandths of a count, which no record tells, the error of the *true* model of the play varies threefold. Free runs of
//! the model found, as it was written, and of the true one are therefore compared over the same few origins.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use crate::{Example, bench_axis, root};
use hyde_calibrate::{Joint, Model, Observer, Problem, Recording, Varied, free_run};
use hyde_compiler::Backend;
use hyde_program::Program;
use rayon::prelude::*;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

pub(super) const RIGHT: Figure = Figure {
    name: "bench_sets_right",
    unit: "of 6",
    promise: Promise::Exactly(6.0),
    measure: |session| {
        of_sets(session, |sets| {
            sets.iter().map(|set| f64::from(u8::from(set.right))).sum()
        })
    },
};

pub(super) const CHI: Figure = Figure {
    name: "bench_chi_minus_truth_max",
    unit: "on records held out",
    promise: Promise::AtMost(0.02),
    measure: |session| of_sets(session, |sets| most(sets, |set| set.above_truth)),
};

pub(super) const WINDOWS: Figure = Figure {
    name: "bench_windows_over_truth_max",
    unit: "on records held out",
    promise: Promise::AtMost(1.05),
    measure: |session| of_sets(session, |sets| most(sets, |set| set.windows_over_truth)),
};

pub(super) const FREE_RUN: Figure = Figure {
    name: "bench_free_run_over_truth_max",
    unit: "on records held out",
    promise: Promise::AtMost(1.05),
    measure: |session| of_sets(session, |sets| most(sets, |set| set.free_run_over_truth)),
};

pub(super) const MINUTES: Figure = Figure {
    name: "diagnose_minutes",
    unit: "min, the slowest set",
    promise: Promise::AtMost(0.42),
    measure: |session| of_sets(session, |sets| most(sets, |set| set.minutes)),
};

/// What a set holds: effect, site, size, shapes, all SI; and how the axis is written with it.
struct Answer {
    effect: &'static str,
    site: &'static str,
    size: f64,
    shapes: &'static [(&'static str, f64)],
    with: &'static str,
}

const ANSWERS: [Option<Answer>; 6] = [
    None,
    Some(Answer {
        effect: "Stribeck",
        site: "guide",
        size: 180.0,
        shapes: &[("vs", 8e-3)],
        with: "Effects.Stribeck(dF = 180 [N], vs = 8 [mm/s]) on guide",
    }),
    Some(Answer {
        effect: "NutBacklash",
        site: "screw",
        size: 12e-6,
        shapes: &[],
        with: "Effects.NutBacklash(gap = 12 [um]) on screw",
    }),
    Some(Answer {
        effect: "Rocking",
        site: "saddle.a",
        size: 140.0,
        shapes: &[("f", 35.0), ("zeta", 0.02)],
        with: "Effects.Rocking(m = 140 [kg], f = 35 [Hz], zeta = 0.02) on saddle.a",
    }),
    Some(Answer {
        effect: "Cogging",
        site: "motor.shaft",
        size: 0.3,
        shapes: &[("N", 12.0), ("phase", 0.4)],
        with: "Effects.Cogging(As = 0.276318 [N.m], Ac = 0.116826 [N.m], N = 12) on motor.shaft",
    }),
    Some(Answer {
        effect: "LeadError",
        site: "screw",
        size: 4e-6,
        shapes: &[("order", 1.0), ("phase", 0.9)],
        with: "Effects.LeadError(as = 2.48644 [um], ac = 3.13331 [um], order = 1) on screw",
    }),
];

/// How far a size may be off.
const SIZE: f64 = 0.15;

/// Origins of the encoder that free runs have, and how far each is from the one before, in counts. A record begins at the
/// lower end of a count, so they are moved one way, and together by less than the scale can show.
const ORIGINS: u32 = 8;
const BETWEEN: f64 = 0.005;

/// How the diagnosis of a set came out.
#[derive(Clone, Debug)]
pub(crate) struct SetResult {
    right: bool,
    above_truth: f64,
    windows_over_truth: f64,
    free_run_over_truth: f64,
    minutes: f64,
}

fn most(sets: &[SetResult], of: impl Fn(&SetResult) -> f64) -> f64 {
    sets.iter().map(of).fold(f64::NEG_INFINITY, f64::max)
}

fn of_sets(session: &Session, of: impl Fn(&[SetResult]) -> f64) -> Result<Measured, String> {
    let folder = session.data.join("bench");
    if !folder.is_dir() {
        let what = "bench, the six sets of the bench axis, is not below the data folder";
        return Ok(Measured::Absent(what.to_owned()));
    }
    let each = || {
        let sets = ANSWERS.iter().enumerate();
        sets.map(|(number, answer)| set(&folder.join(format!("bench-{number}")), answer.as_ref()))
            .collect()
    };
    let sets: Vec<SetResult> = session.diagnoses.get_or_init(each).clone()?;
    Ok(Measured::Value(of(&sets)))
}

fn set(data: &Path, answer: Option<&Answer>) -> Result<SetResult, String> {
    let axis = root().join("examples/bench_axis/axis.hyde");
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let begin = now();
    let report = command("diagnose", &axis, data, folder.path())?;
    let minutes = begin.elapsed().as_secs_f64() / 60.0;
    let truth = Truth::of(data, answer)?;
    let found = free_runs(&written(&report, folder.path())?, &[], data)?;
    Ok(SetResult {
        right: right(&report, answer),
        above_truth: chi(&report) - truth.chi,
        windows_over_truth: windows_over(&report, &truth.windows),
        free_run_over_truth: most_over(found.iter().copied().zip(&truth.free_run)),
        minutes,
    })
}

/// The errors over the records held out of the axis with the true effect, calibrated in the same way. The observer is that
/// round the declared model, as it is before and after: with one of its own, which a play loosens, the truth would be
/// measured by another yardstick.
struct Truth {
    /// Mean square of whitened innovations.
    chi: f64,
    /// Squares of the rms, summed over records, a number a channel, SI; of free runs over origins too.
    windows: Vec<f64>,
    free_run: Vec<f64>,
}

impl Truth {
    fn of(data: &Path, answer: Option<&Answer>) -> Result<Self, String> {
        let declared = bench_axis::declared()?;
        let closed = answer.map_or_else(bench_axis::declared, |own| bench_axis::with(own.with))?;
        let [declared_program, program] = [
            declared.observed().compile(Backend::Native)?,
            closed.clone().observed().compile(Backend::Native)?,
        ]
        .map(|compiled| compiled.program);
        let of = |begin: &str, program| recordings(data, begin, program);
        let unsupported = |error| format!("{error:?}");
        let observer = Observer::new(&declared_program, &of("fit-", &declared_program)?, &[]);
        let observer = observer.map_err(unsupported)?;
        let mut p = vec![0.0; program.n_parameters];
        program.kernels.parameters(&[], &mut p);
        let varied = Varied::uncertain(&program, &p);
        let fitted = of("fit-", &program)?;
        let problem = Problem {
            program: &program,
            recordings: &fitted,
            observer: &observer,
            varied: &varied,
            set: &[],
            fold: None,
            reached: None,
        };
        let found = hyde_calibrate::fit(&Joint::of(&problem), 1);
        let found = found.map_err(unsupported)?.parameters.into_iter();
        let set: Vec<(String, f64)> = found.map(|own| (own.name, own.value)).collect();
        let model = Model {
            observed: &program,
            closed: None,
            shifted: None,
            set: &set,
        };
        let measured = model.measures(&of("validate-", &program)?, &observer);
        let measured = measured.map_err(unsupported)?;
        let windows = |channel| {
            let each = measured.iter();
            each.map(|own| own.windows.total(channel).powi(2)).sum()
        };
        Ok(Self {
            chi: mean(measured.iter().map(|own| own.chi)),
            windows: (0..program.experiment.measured.len())
                .map(windows)
                .collect(),
            free_run: free_runs(&closed, &set, data)?,
        })
    }
}

/// Squares of the rms of free runs over the records held out, summed over them and over the encoder's origins, a number a
/// channel, SI.
fn free_runs(axis: &Example, set: &[(String, f64)], data: &Path) -> Result<Vec<f64>, String> {
    let files = records(data, "validate-")?;
    let first = files.first().ok_or("no record is held out")?;
    let axis = axis.clone().record("file", first);
    let read = "sample(encoder.phi)";
    if !axis.text().contains(read) {
        return Err(format!("the axis has no `{read}` to move"));
    }
    let of = |origin: u32| -> Result<Vec<f64>, String> {
        let moved = format!("({read} + {} [rev])", 1e-4 * BETWEEN * f64::from(origin));
        let moved = axis.clone().rewritten(read, &moved);
        let program = moved.compile(Backend::Native)?.program;
        let mut squares = vec![0.0; program.experiment.measured.len()];
        for recording in recordings(data, "validate-", &program)? {
            let run = free_run(&program, &recording, set).map_err(|error| format!("{error:?}"))?;
            for (sum, channel) in squares.iter_mut().zip(run) {
                *sum += channel.rms().powi(2);
            }
        }
        Ok(squares)
    };
    let each: Result<Vec<Vec<f64>>, String> = (0..ORIGINS).into_par_iter().map(of).collect();
    let sums = each?.into_iter().reduce(|mut sums, own| {
        sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
        sums
    });
    Ok(sums.unwrap_or_default())
}

/// The model that a diagnosis left in a folder.
fn written(report: &Value, folder: &Path) -> Result<Example, String> {
    let file = format!("{}.hyde", report["new_model"].as_str().unwrap_or_default());
    let experiment = report["new_experiment"].as_str().unwrap_or_default();
    Example::load(folder.join(file), Some(experiment))
}

/// The records of a set whose names begin so.
fn recordings(data: &Path, begin: &str, program: &Program) -> Result<Vec<Recording>, String> {
    let files = records(data, begin)?;
    let each = files.iter().map(|file| {
        let tables = bench_axis::declared()?.record("file", file).parse()?.tables;
        let name = file.display().to_string();
        Recording::new(&name, program, tables, &[]).map_err(|error| format!("{name}: {error:?}"))
    });
    each.collect()
}

/// The records of a set whose names begin so, in order.
pub(super) fn records(data: &Path, begin: &str) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(data).map_err(|error| error.to_string())?;
    let paths = entries.filter_map(|entry| entry.ok().map(|entry| entry.path()));
    let named = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(begin) && name.ends_with(".csv")
    };
    let mut found: Vec<PathBuf> = paths.filter(named).collect();
    found.sort();
    Ok(found)
}

/// What a command says in JSON of the bench on some records.
pub(super) fn command(name: &str, file: &Path, data: &Path, out: &Path) -> Result<Value, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new(program)
        .arg(name)
        .arg(file)
        .args(["bench", "--json", "--data"])
        .arg(data)
        .arg("--out")
        .arg(out)
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())
}

/// The records held out.
fn held_out(report: &Value) -> impl Iterator<Item = &Value> {
    let records = report["records"].as_array().map_or(&[][..], Vec::as_slice);
    records.iter().filter(|record| record["holdout"] == true)
}

/// The error of windows over all records held out over that of the truth, in the channel where that is largest.
fn windows_over(report: &Value, truth: &[f64]) -> f64 {
    let of = |channel: usize| -> f64 {
        // What has no number is as wrong as can be.
        let each = held_out(report).map(|record| &record["channels"][channel]["windows"]["after"]);
        let each = each.map(|rms| rms.as_f64().unwrap_or(f64::INFINITY).powi(2));
        each.sum()
    };
    most_over((0..truth.len()).map(of).zip(truth))
}

/// The root of the largest ratio of squares.
fn most_over<'a>(pairs: impl Iterator<Item = (f64, &'a f64)>) -> f64 {
    let ratios = pairs.map(|(found, truth)| (found / truth).sqrt());
    ratios.fold(f64::NAN, f64::max)
}

/// Mean square of whitened innovations over the records held out.
fn chi(report: &Value) -> f64 {
    mean(held_out(report).filter_map(|record| record["chi"]["after"].as_f64()))
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// Whether a report on a set, by number, has its answer.
pub(crate) fn is_right(set: usize, report: &Value) -> bool {
    ANSWERS
        .get(set)
        .is_some_and(|answer| right(report, answer.as_ref()))
}

fn right(report: &Value, answer: Option<&Answer>) -> bool {
    let Some(answer) = answer else {
        return report["verdict"] == "none";
    };
    let effects = report["effects"].as_array().map_or(&[][..], Vec::as_slice);
    let [found] = effects else { return false };
    let covers = |(name, value): &(&str, f64)| {
        let shape = &found["shape"][*name];
        let ends = (shape["interval"][0].as_f64(), shape["interval"][1].as_f64());
        matches!(ends, (Some(low), Some(high)) if low <= *value && *value <= high)
    };
    let size = found["size"].as_f64().unwrap_or(f64::NAN);
    report["verdict"] == "effect"
        && found["effect"] == answer.effect
        && found["site"] == answer.site
        && (size / answer.size - 1.0).abs() <= SIZE
        && answer.shapes.iter().all(covers)
}
