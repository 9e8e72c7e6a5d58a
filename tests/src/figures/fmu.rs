//! `fmu_deviation`, `fmu_event_time_error_us` and `fmu_export_s`: FMUs in FMPy against the run of their experiment, and how long
//! an export takes.

use super::clock::now;
use super::process::released;
use super::promise::{Figure, Measured, Promise, Session};
use super::start::START;
use crate::fmu::{Agreement, Compared, FMI_RS_KINDS, KINDS, compare, fmi_rs, python, succeed};
use std::process::Command;

/// The models with what an importer that integrates is compared with: a run whose own error does not count.
const MODELS: [(&str, &str, &[&str], &str); 4] = [
    ("tests/models/fmu.hyde", "stepped", &[], "1e-10"),
    ("tests/models/fmu.hyde", "bouncing", &[], "1e-10"),
    ("tests/models/fmu.hyde", "moved", &[], "1e-10"),
    (
        "examples/first/first.hyde",
        "push",
        &["--rtol", "1e-10"],
        "1e-11",
    ),
];

/// Examples whose FMUs integrate themselves, compared as they stand.
const EXAMPLES: [(&str, &str); 9] = [
    ("examples/first/first.hyde", "push"),
    ("examples/bench_axis/axis.hyde", "bench"),
    ("examples/shaft/shaft.hyde", "step"),
    ("examples/x_axis/axis.hyde", "positioning"),
    ("examples/y_axis/axis.hyde", "positioning"),
    ("examples/friction/friction.hyde", "beside"),
    ("examples/machine/machine.hyde", "circle"),
    ("examples/frequency_response/axis.hyde", "opened"),
    ("examples/screw_waves/axis.hyde", "waves"),
];

pub(super) const DEVIATION: Figure = Figure {
    name: "fmu_deviation",
    unit: "of the range",
    promise: Promise::AtMost(1e-6),
    measure: |session| measured(session, |own| own.deviation.0),
};

pub(super) const EVENTS: Figure = Figure {
    name: "fmu_event_time_error_us",
    unit: "us",
    promise: Promise::AtMost(1.0),
    measure: |session| measured(session, |own| own.event_time_error_us),
};

pub(super) const EXPORT: Figure = Figure {
    name: "fmu_export_s",
    unit: "s",
    promise: Promise::Below(1.0),
    measure: |_| {
        let hyde = released()?;
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let start = now();
        let mut export = Command::new(hyde);
        export.args(["export", "fmu", START.0, START.1, "--quiet"]);
        export.arg("--out");
        succeed(export.arg(folder.path().join("axis.fmu")))?;
        Ok(Measured::Value(start.elapsed().as_secs_f64()))
    },
};

/// The largest of a number over all models and kinds.
fn measured(session: &Session, of: fn(&Agreement) -> f64) -> Result<Measured, String> {
    if let Err(reason) = python() {
        return Ok(Measured::Absent(reason));
    }
    let all = session.fmus.get_or_init(agreements);
    let all = all.as_ref().map_err(Clone::clone)?;
    Ok(Measured::Value(all.iter().map(of).fold(0.0, f64::max)))
}

fn agreements() -> Result<Vec<Agreement>, String> {
    let hyde = released()?;
    let mut found = Vec::new();
    for (file, experiment, run, tolerance) in MODELS {
        for fmi in ["3", "2"] {
            let compared = Compared {
                file,
                experiment,
                fmi,
                run,
                tolerance,
                kinds: &KINDS[2..],
            };
            found.extend(compare(&hyde, &compared)?);
        }
    }
    let mut kinds = KINDS[..2].to_vec();
    if fmi_rs().is_ok() {
        kinds.extend(FMI_RS_KINDS);
    }
    for (file, experiment) in EXAMPLES {
        let compared = Compared {
            file,
            experiment,
            fmi: "3",
            run: &[],
            tolerance: "1e-8",
            kinds: &kinds,
        };
        found.extend(compare(&hyde, &compared)?);
    }
    Ok(found)
}
