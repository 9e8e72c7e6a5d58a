//! `false_alarms_of_100`, `planted_top1_percent`: what the verdicts of a diagnosis are worth, on the small axis; and [`record`],
//! which plants the whole library there. The command is this program itself; finished cases are kept below
//! `target/selftest`, by seed, so that an interrupted measurement goes on.

use super::promise::{Figure, Measured, Promise, Session};
use crate::root;
use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Stdio};

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
/// All there is: half of what shows, what is typical, and what nobody overlooks; and every control.
const WHOLE: [&str; 4] = ["--sizes", "0.5x,0.05,0.3", "--empties", "100"];

/// Sets of records with nothing in them for which the verdict is any but `none`.
fn false_alarms(session: &Session) -> Result<Measured, String> {
    let report = report(session, &["--only", "empty", "--empties", "100"])?;
    let control = &report["controls"]["empty"];
    let number = |name: &str| control[name].as_f64().ok_or("the report has no controls");
    Ok(Measured::Value(number("cases")? - number("right")?))
}

/// Of the planted effects that show on this axis, those that are named first with their site.
fn top1(session: &Session) -> Result<Measured, String> {
    let sample = ["--only", "planted", "--sizes", TYPICAL, "--sample", SAMPLE];
    let report = report(session, &sample)?;
    let cases = report["cases"]
        .as_array()
        .ok_or("the report has no cases")?;
    let typical = |case: &&Value| {
        let name = case["name"].as_str().unwrap_or_default();
        name.starts_with("planted ") && name.split(' ').nth(2) == Some(TYPICAL)
    };
    let seen = cases
        .iter()
        .filter(typical)
        .filter(|case| case["shows"] == true);
    let (mut visible, mut right) = (0.0, 0.0);
    for case in seen {
        visible += 1.0;
        right += f64::from(u8::from(case["right"] == true));
    }
    let percent = 100.0 * right / visible;
    Ok(if session.whole {
        Measured::Value(percent)
    } else {
        Measured::Partly(percent, "24 effects at their sites, spread over all")
    })
}

/// Plants the whole library at several sizes, and all controls; leaves what became of it as `tests/selftest/seed-S.txt`.
///
/// # Errors
/// The command fails or is interrupted; a file cannot be written.
#[allow(
    clippy::disallowed_methods,
    reason = "a result is recorded in the project"
)]
pub fn record(session: &Session) -> Result<PathBuf, String> {
    // Named before hours pass in which they may change.
    let sources = sources();
    let table = output(session, &WHOLE)?;
    let folder = root().join("tests/selftest");
    let path = folder.join(format!("seed-{}.txt", session.seed));
    let text = format!(
        "# What the verdicts of a diagnosis are worth on tests/models/small_axis; `./dev long --seed {}` makes this.\n\
         # Hyde {}, crates {}.\n\n{}",
        session.seed,
        env!("CARGO_PKG_VERSION"),
        sources,
        String::from_utf8_lossy(&table)
    );
    let written = std::fs::create_dir_all(&folder).and_then(|()| std::fs::write(&path, text));
    written.map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}

/// What git calls the sources of the program: the same for the same text.
fn sources() -> String {
    let git = |arguments: &[&str]| {
        let output = Command::new("git")
            .args(arguments)
            .current_dir(root())
            .output()
            .ok()?;
        let text = String::from_utf8(output.stdout).ok()?;
        output.status.success().then(|| text.trim().to_owned())
    };
    let tree = git(&["rev-parse", "--short=12", "HEAD:crates"]);
    let changes = git(&["status", "--porcelain", "crates"]);
    match (tree, changes.as_deref()) {
        (Some(tree), Some("")) => tree,
        (Some(tree), _) => format!("{tree} with changes"),
        (None, _) => "unknown to git".to_owned(),
    }
}

/// The report of some cases, or of all of them where all are asked for.
fn report(session: &Session, some: &[&str]) -> Result<Value, String> {
    let cases = if session.whole { &WHOLE[..] } else { some };
    let printed = output(session, &[cases, &["--json"]].concat())?;
    serde_json::from_slice(&printed).map_err(|error| error.to_string())
}

/// What the command prints.
fn output(session: &Session, arguments: &[&str]) -> Result<Vec<u8>, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let seed = session.seed.to_string();
    let output = Command::new(program)
        .args(["selftest", "tests/models/small_axis/axis.hyde", "moves"])
        .args(["--seed", &seed])
        .args(arguments)
        .arg("--out")
        .arg(root().join("target/selftest").join(&seed))
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("the self-test ends with {}", output.status));
    }
    Ok(output.stdout)
}
