//! `three_effects_minutes`: a friction at creep speed, cogging and a lead error at once on the bench axis. Its records are runs of
//! the axis with the three, along the motions of the set without an effect; the command has to find all three in them.

use super::clock::now;
use super::diagnosis::{command, records};
use super::promise::{Figure, Measured, Promise, Session};
use crate::last_bit::Random;
use crate::{bench_axis, root};
use hyde_experiment::Options;
use hyde_signal::{Column, Layout, csv};
use hyde_units::NamedUnit;
use serde_json::Value;
use std::f64::consts::TAU;
use std::path::Path;

pub(super) const FIGURE: Figure = Figure {
    name: "three_effects_minutes",
    unit: "min",
    promise: Promise::AtMost(1.0),
    measure: |session: &Session| {
        let motions = session.data.join("bench/bench-0");
        if !motions.is_dir() {
            let what = "bench/bench-0, the bench without an effect, is not below the data folder";
            return Ok(Measured::Absent(what.to_owned()));
        }
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        for (seed, motion) in (1..).zip(records(&motions, "")?) {
            record(&motion, seed, folder.path())?;
        }
        let axis = root().join("examples/bench_axis/axis.hyde");
        let begin = now();
        let report = command("diagnose", &axis, folder.path(), &folder.path().join("out"))?;
        let minutes = begin.elapsed().as_secs_f64() / 60.0;
        match all_found(&report) {
            true => Ok(Measured::Value(minutes)),
            false => Err(format!("found otherwise: {}", report["sentence"])),
        }
    },
};

/// What is planted: effect, site, size in SI, and how it is written.
const PLANTED: [(&str, &str, f64, &str); 3] = [
    (
        "Stribeck",
        "guide",
        180.0,
        "Effects.Stribeck(dF = 180 [N], vs = 8 [mm/s]) on guide",
    ),
    (
        "Cogging",
        "motor.shaft",
        0.25,
        "Effects.Cogging(As = 0.2 [N.m], Ac = 0.15 [N.m], N = 12) on motor.shaft",
    ),
    (
        "LeadError",
        "screw",
        4e-6,
        "Effects.LeadError(as = 2.4 [um], ac = 3.2 [um], order = 1) on screw",
    ),
];

/// Parameters that are not as declared, SI.
const OFF: [(&str, f64); 4] = [
    ("saddle.M", 325.0),
    ("guide.F", 245.0),
    ("motor.Jm", 7.9e-3),
    ("screw.contact.k", 1.7e8),
];

/// How far a size may be off.
const SIZE: f64 = 0.05;

/// The counts of the motor's encoder and of the scale, SI.
const COUNT: f64 = TAU / 10_000.0;
const GRID: f64 = 1e-6;

/// A column of a record: what it reads, its unit, its noise, and the step of its grid.
const CHANNELS: [(&str, &str, &str, f64, f64); 4] = [
    ("i", "motor.i", "A", 0.02, 0.0),
    ("phi_m", "encoder.phi", "rad", 0.0, COUNT),
    ("v_tacho", "tacho.V6", "V", 4e-3, 0.0),
    ("x", "scale.s", "m", 0.3e-6, GRID),
];

/// Writes the record of the axis with the three effects along the motion of another record.
#[allow(clippy::disallowed_methods, reason = "a record is made of another")]
fn record(motion: &Path, seed: u64, folder: &Path) -> Result<(), String> {
    let text = std::fs::read(motion).map_err(|error| error.to_string())?;
    let asked = csv::read(&text, &Layout::default()).map_err(|error| format!("{error:?}"))?;
    let effects = PLANTED.map(|(.., with)| with).join(", ");
    let mut axis = bench_axis::with(&effects)?.record("file", motion);
    for (parameter, value) in OFF {
        axis = axis.set(parameter, value);
    }
    let (compiled, run) = axis.run_with(&Options {
        rtol: Some(1e-8),
        ..Options::default()
    })?;
    let of = |name: &str| {
        let output = compiled.program.output(name);
        let column = output.and_then(|output| run.results.column(output));
        column.ok_or_else(|| format!("the axis has no `{name}`"))
    };
    // Events have rows of their own; a sample is the first row at its time.
    let time = asked.columns()[0].values();
    let row_of = |t: &f64| run.results.time.partition_point(|own| *own < t - 1e-9);
    let rows: Vec<usize> = time.iter().map(row_of).collect();
    let last = run.results.time.len().saturating_sub(1);
    let mut random = Random(seed);
    let mut columns: Vec<Column> = asked.columns()[..3].to_vec();
    // What the control puts out at a tick acts behind it.
    let demand = of("motor.i_ref")?;
    let demand = rows.iter().map(|&row| demand[(row + 1).min(last)]);
    columns.push(column("i_ref", "A", demand.collect())?);
    for (name, read, unit, noise, grid) in CHANNELS {
        let read = of(read)?;
        let sample = |&row: &usize| {
            let value = read[row.min(last)] + noise * random.normal();
            if grid > 0.0 {
                (value / grid).floor() * grid
            } else {
                value
            }
        };
        columns.push(column(name, unit, rows.iter().map(sample).collect())?);
    }
    let name = motion.file_name().unwrap_or_default();
    std::fs::write(folder.join(name), csv::write(&columns)).map_err(|error| error.to_string())
}

fn column(name: &str, unit: &str, values: Vec<f64>) -> Result<Column, String> {
    let unit = NamedUnit::parse(unit).map_err(|error| format!("{unit}: {error:?}"))?;
    Ok(Column::new(name, unit, values))
}

/// Whether a report has the three effects and no other.
fn all_found(report: &Value) -> bool {
    let effects = report["effects"].as_array().map_or(&[][..], Vec::as_slice);
    let is_planted = |found: &Value| {
        PLANTED.iter().any(|(effect, site, size, _)| {
            let own = found["size"].as_f64().unwrap_or(f64::NAN);
            found["effect"] == *effect && found["site"] == *site && (own / size - 1.0).abs() <= SIZE
        })
    };
    effects.len() == PLANTED.len() && effects.iter().all(is_planted)
}
