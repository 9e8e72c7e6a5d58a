//! `fmu_random_models_failed` and `fmu_leaks`: random models as FMUs, simulated in FMPy and checked by valgrind.

use super::process::released;
use super::promise::{Figure, Measured, Promise, Session, tell};
use crate::fmu::python;
use crate::random_fmus::RandomFmus;

/// Models that are simulated, and those that valgrind checks, which takes seconds each.
const SIMULATED: u64 = 200;
const CHECKED: u64 = 10;

pub(super) const FAILED: Figure = Figure {
    name: "fmu_random_models_failed",
    unit: "",
    promise: Promise::Exactly(0.0),
    measure: |session| with_importer(session, SIMULATED, failed),
};

pub(super) const LEAKS: Figure = Figure {
    name: "fmu_leaks",
    unit: "bytes",
    promise: Promise::Exactly(0.0),
    measure: |session| with_importer(session, CHECKED, lost),
};

fn with_importer(
    session: &Session,
    count: u64,
    measure: fn(&Session, &RandomFmus) -> Result<Measured, String>,
) -> Result<Measured, String> {
    if let Err(reason) = python() {
        return Ok(Measured::Absent(reason));
    }
    let first = (session.seed - 1) * count;
    let fmus = RandomFmus::export(&released()?, first..first + count)?;
    if fmus.refused.len() as u64 * 10 > count {
        return Err(format!(
            "the compiler refuses {} models",
            fmus.refused.len()
        ));
    }
    measure(session, &fmus)
}

fn failed(session: &Session, fmus: &RandomFmus) -> Result<Measured, String> {
    let failures = fmus.failures()?;
    for failure in &failures {
        tell(session.seed, failure);
    }
    Ok(Measured::Value(failures.len() as f64))
}

fn lost(session: &Session, fmus: &RandomFmus) -> Result<Measured, String> {
    let (lost, errors, told) = fmus.memory()?;
    if errors > 0 || lost > 0 {
        tell(session.seed, &told);
    }
    match errors {
        0 => Ok(Measured::Value(lost as f64)),
        _ => Err(format!("{errors} errors of memory")),
    }
}
