//! CubeSpec fine steering mirror: `combined_data.npz` of its repository as it is.

use super::command::{Fitted, fit};
use super::{Benchmark, Published, Reason, Row};
use crate::root;
use std::path::Path;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "steering_mirror",
    about: "CubeSpec fine steering mirror (Floren et al. 2024): mean error of three sensors in um, over three realizations of \
            two periods",
    measure,
    published: &[
        Published {
            method: "nonlinear LFR, 28 states and a neural network, all amplitudes",
            figures: &[(LEVELS[0], 0.0866), (LEVELS[1], 0.131), (LEVELS[2], 0.169)],
            source: SOURCE,
        },
        Published {
            method: "linear, 28 states, for each amplitude its own",
            figures: &[(LEVELS[0], 0.114), (LEVELS[1], 0.216), (LEVELS[2], 0.228)],
            source: SOURCE,
        },
        Published {
            method: "linear, 28 states, all amplitudes",
            figures: &[(LEVELS[0], 0.252), (LEVELS[1], 0.179), (LEVELS[2], 0.658)],
            source: SOURCE,
        },
        Published {
            method: "linear, 28 states, of 100 mV",
            figures: &[(LEVELS[0], 0.114), (LEVELS[1], 0.555), (LEVELS[2], 1.319)],
            source: SOURCE,
        },
    ],
};

const SOURCE: &str = "Floren, Baseline models for the Fine Steering Mirror benchmark dataset, 2026, doi 10.5281/zenodo.19591136";
const FILE: &str = "examples/steering_mirror/steering_mirror.hyde";
const RECORD: &str = "combined_data.npz";
const LEVELS: [&str; 3] = ["100 mV", "200 mV", "300 mV"];
const EXPERIMENTS: [&str; 3] = ["test_100", "test_200", "test_300"];
/// Three realizations of two periods.
const RUNS: usize = 6;

fn measure(program: &Path, folder: &Path) -> Result<Vec<Row>, String> {
    let row = |level, value, fitted| Row {
        record: LEVELS[level],
        unit: "um",
        value,
        fitted,
    };
    let record = folder.join(RECORD);
    if !record.is_file() {
        let absent = || Err(Reason::Absent(RECORD));
        return Ok((0..LEVELS.len())
            .map(|level| row(level, absent(), 0))
            .collect());
    }
    let file = root().join(FILE);
    let fitted = fit(program, &file, "steering_mirror", folder)?;
    let value =
        |level: usize| mean(&fitted, &file, &record, EXPERIMENTS[level]).map_err(Reason::Failed);
    let rows = (0..LEVELS.len()).map(|level| row(level, value(level), fitted.number()));
    Ok(rows.collect())
}

/// The mean of the errors of all sensors and runs, in um.
fn mean(fitted: &Fitted<'_>, file: &Path, record: &Path, experiment: &str) -> Result<f64, String> {
    let mut errors = Vec::new();
    for run in 1..=RUNS {
        let record = format!("file={} (run = {run}) every 156.25 [us]", record.display());
        errors.extend(fitted.errors(file, experiment, Some(&record), "rms")?);
    }
    #[allow(clippy::cast_precision_loss, reason = "a few numbers")]
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    Ok(1e6 * mean)
}
