//! `false_alarms_of_100`, `planted_top1_percent`: what the verdicts of a diagnosis are worth, on the small axis. The command is
//! this program itself; finished cases are kept below `target/selftest`, by seed, so that an interrupted measurement goes on.

use super::promise::{Figure, Measured, Promise, Session};
use crate::root;
use serde_json::Value;
use std::process::Stdio;

pub(super) const FALSE_ALARMS: Figure = Figure {
    name: "false_alarms_of_100",
    unit: "sets",
    promise: Promise::AtMost(5.0),
    measure: false_alarms,
};

pub(super) const TOP1: Figure = Figure {
    name: "planted_top1_percent",
    unit: "%",
    promise: Promise::AtLeast(95.0),
    measure: top1,
};

/// Planted at this part of their ranges: about what is found in practice.
const TYPICAL: &str = "0.05";
/// Effects at sites of the small axis that are tried in a measurement.
const SAMPLE: &str = "24";

/// Sets of records with nothing in them for which the verdict is any but `none`.
fn false_alarms(session: &Session) -> Result<Measured, String> {
    let report = report(session, &["--only", "empty", "--empties", "100"])?;
    let control = &report["controls"]["empty"];
    let number = |name: &str| control[name].as_f64().ok_or("the report has no controls");
    Ok(Measured::Value(number("cases")? - number("right")?))
}

/// Of the planted effects that show on this axis, those that are named first with their site.
fn top1(session: &Session) -> Result<Measured, String> {
    let arguments = ["--only", "planted", "--sizes", TYPICAL, "--sample", SAMPLE];
    let report = report(session, &arguments)?;
    let number = |name: &str| report[name].as_f64().ok_or("the report has no sums");
    let percent = 100.0 * number("right")? / number("visible")?;
    Ok(Measured::Partly(
        percent,
        "24 effects at their sites, spread over all",
    ))
}

fn report(session: &Session, arguments: &[&str]) -> Result<Value, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let seed = session.seed.to_string();
    let out = root().join("target/selftest").join(&seed);
    let output = std::process::Command::new(program)
        .args([
            "selftest",
            "tests/models/small_axis/axis.hyde",
            "moves",
            "--json",
            "--seed",
            &seed,
        ])
        .args(arguments)
        .arg("--out")
        .arg(out)
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("the self-test ends with {}", output.status));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())
}
