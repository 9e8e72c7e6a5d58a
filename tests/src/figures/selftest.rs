//! `false_alarms_of_100`, `planted_top1_percent`, `withheld_not_claimed`, `claims_whose_interval_holds_zero`,
//! `interval_coverage_percent`: what the verdicts of a diagnosis are worth, on the small axis, on a rack and on a linear motor,
//! withheld effects on the small axis; and [`record`], which plants the whole library there. The command is this program
//! itself; finished cases are kept below `target/selftest`, by seed, so that an interrupted measurement goes on.

use super::promise::{Figure, Measured, Promise, Session};
use crate::root;
use serde_json::Value;
use std::path::PathBuf;
use std::process::{Command, Stdio};

pub(super) const FALSE_ALARMS: Figure = Figure {
    name: "false_alarms_of_100",
    unit: "sets",
    promise: Promise::AtMost(1.0),
    measure: |session| false_alarms(session, Axis::Small, "100"),
};

pub(super) const TOP1: Figure = Figure {
    name: "planted_top1_percent",
    unit: "%",
    promise: Promise::AtLeast(97.0),
    measure: |session| top1(session, Axis::Small),
};

pub(super) const FALSE_ALARMS_RACK: Figure = Figure {
    name: "false_alarms_of_50_rack",
    unit: "sets",
    promise: Promise::AtMost(1.0),
    measure: |session| false_alarms(session, Axis::Rack, "50"),
};

pub(super) const TOP1_RACK: Figure = Figure {
    name: "planted_top1_rack",
    unit: "%",
    promise: Promise::AtLeast(97.0),
    measure: |session| top1(session, Axis::Rack),
};

pub(super) const FALSE_ALARMS_LINEAR: Figure = Figure {
    name: "false_alarms_of_50_linear",
    unit: "sets",
    promise: Promise::AtMost(1.0),
    measure: |session| false_alarms(session, Axis::Linear, "50"),
};

pub(super) const TOP1_LINEAR: Figure = Figure {
    name: "planted_top1_linear",
    unit: "%",
    promise: Promise::AtLeast(97.0),
    measure: |session| top1(session, Axis::Linear),
};

pub(super) const WITHHELD: Figure = Figure {
    name: "withheld_not_claimed",
    unit: "of 22",
    promise: Promise::AtLeast(19.0),
    measure: withheld,
};

pub(super) const HOLDS_ZERO: Figure = Figure {
    name: "claims_whose_interval_holds_zero",
    unit: "claims",
    promise: Promise::Exactly(0.0),
    measure: holds_zero,
};

pub(super) const COVERAGE: Figure = Figure {
    name: "interval_coverage_percent",
    unit: "%",
    promise: Promise::Within(92.0, 98.0),
    measure: coverage,
};

/// An axis that cases are planted on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Axis {
    /// Motor and screw on a belt.
    Small,
    /// A rack and pinion with two encoders.
    Rack,
    /// A linear motor whose speed loop ticks four times in a tick of its position loop.
    Linear,
}

impl Axis {
    pub(super) const ALL: [Self; 3] = [Self::Small, Self::Rack, Self::Linear];

    fn file(self) -> &'static str {
        match self {
            Self::Small => "tests/models/small_axis/axis.hyde",
            Self::Rack => "tests/models/rack_axis/axis.hyde",
            Self::Linear => "tests/models/linear_axis/axis.hyde",
        }
    }

    /// Less current than it has in its own records.
    fn current(self) -> &'static str {
        match self {
            Self::Small => "10 [A]",
            Self::Rack => "15 [A]",
            Self::Linear => "3 [A]",
        }
    }

    /// The arguments that ask for designed records.
    fn designed(self) -> Vec<&'static str> {
        [&DESIGNED[..], &[self.current()]].concat()
    }

    /// Where its cases are kept below the folder of a seed.
    fn folder(self) -> &'static str {
        match self {
            Self::Small => "",
            Self::Rack => "rack",
            Self::Linear => "linear",
        }
    }
}

/// Planted at this part of their ranges: about what is found in practice.
const TYPICAL: &str = "0.05";
/// Effects at sites of the small axis that are tried in a measurement.
const SAMPLED: [&str; 6] = ["--only", "planted", "--sizes", TYPICAL, "--sample", "24"];
/// Effects that are withheld from the search, at the largest size of the whole self-test.
const WITHHELD_CASES: [&str; 4] = ["--only", "unknown", "--sizes", "0.3"];
/// How many the promise is of; a few more or less show where the library changes.
const WITHHELD_OF: f64 = 22.0;
/// A record is designed for each verdict `one of`, of a motion that all three axes make in their own records, or of a current.
const DESIGNED: [&str; 12] = [
    "--designed",
    "--travel",
    "100 [mm]",
    "--speed",
    "180 [mm/s]",
    "--acceleration",
    "4 [m/s2]",
    "--jerk",
    "1000 [m/s3]",
    "--duration",
    "15 [s]",
    "--current",
];
/// All there is: half of what shows, what is typical, and what nobody overlooks; and every control.
const WHOLE: [&str; 4] = ["--sizes", "0.5x,0.05,0.3", "--empties", "100"];

/// Sets of records with nothing in them for which the verdict is any but `none`.
fn false_alarms(session: &Session, axis: Axis, sets: &str) -> Result<Measured, String> {
    let report = report(session, axis, &["--only", "empty", "--empties", sets])?;
    let control = &report["controls"]["empty"];
    let number = |name: &str| control[name].as_f64().ok_or("the report has no controls");
    Ok(Measured::Value(number("cases")? - number("right")?))
}

/// Of the planted effects that show on this axis, those that are named first with their site.
fn top1(session: &Session, axis: Axis) -> Result<Measured, String> {
    let report = planted(session, axis)?;
    let cases = cases(&report)?;
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
    Ok(told(session, axis, 100.0 * right / visible))
}

/// Of the effects that the search does not know, each at one of its sites and large enough to show, those for which it claims
/// no other effect, or says that something is left beside it.
fn withheld(session: &Session) -> Result<Measured, String> {
    let report = report(session, Axis::Small, &WITHHELD_CASES)?;
    let control = &report["controls"]["unknown"];
    let number = |name: &str| control[name].as_f64().ok_or("the report has no controls");
    Ok(Measured::Value(
        WITHHELD_OF * number("right")? / number("cases")?,
    ))
}

/// Effects that are claimed although their interval holds 0, over all cases of all axes.
fn holds_zero(session: &Session) -> Result<Measured, String> {
    let holds =
        |claim: &&Value| interval(claim).is_none_or(|(low, high)| low <= 0.0 && high >= 0.0);
    let mut count = 0;
    for axis in Axis::ALL {
        let report = planted(session, axis)?;
        let claims = cases(&report)?
            .iter()
            .filter_map(|case| case["effects"].as_array());
        count += claims.flatten().filter(holds).count();
    }
    Ok(told(session, Axis::Small, count as f64))
}

/// Of the effects planted on all axes and named first, those whose interval holds the size that was planted.
fn coverage(session: &Session) -> Result<Measured, String> {
    let (mut all, mut covered) = (0.0, 0.0);
    for axis in Axis::ALL {
        let report = planted(session, axis)?;
        for case in cases(&report)? {
            let first = &case["effects"][0];
            let named = case["planted"].is_object() && first["claimed"] == case["planted"];
            let (Some((low, high)), Some(size), true) =
                (interval(first), case["size"].as_f64(), named)
            else {
                continue;
            };
            all += 1.0;
            covered += f64::from(u8::from((low..=high).contains(&size)));
        }
    }
    Ok(told(session, Axis::Small, 100.0 * covered / all))
}

/// The report of the planted effects.
pub(super) fn planted(session: &Session, axis: Axis) -> Result<Value, String> {
    report(session, axis, &[&SAMPLED[..], &axis.designed()].concat())
}

/// The cases of a report.
fn cases(report: &Value) -> Result<&Vec<Value>, String> {
    let cases = report["cases"].as_array();
    cases.ok_or_else(|| "the report has no cases".to_owned())
}

/// The interval of a claim.
fn interval(claim: &Value) -> Option<(f64, f64)> {
    let end = |number: usize| claim["interval"][number].as_f64();
    Some((end(0)?, end(1)?))
}

/// A number of the whole self-test, or of the part of it that is run where not all is asked for.
fn told(session: &Session, axis: Axis, value: f64) -> Measured {
    if session.whole && axis == Axis::Small {
        Measured::Value(value)
    } else {
        Measured::Partly(value, "24 effects at their sites, spread over all")
    }
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
    let whole = [&WHOLE[..], &Axis::Small.designed()].concat();
    let table = output(session, Axis::Small, &whole)?;
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

/// The report of some cases on an axis, or of all of them on the small one where all are asked for.
fn report(session: &Session, axis: Axis, some: &[&str]) -> Result<Value, String> {
    let whole = session.whole && axis == Axis::Small;
    let all = [&WHOLE[..], &axis.designed()].concat();
    let cases = if whole { &all } else { some };
    let printed = output(session, axis, &[cases, &["--json"]].concat())?;
    serde_json::from_slice(&printed).map_err(|error| error.to_string())
}

/// What the command prints.
fn output(session: &Session, axis: Axis, arguments: &[&str]) -> Result<Vec<u8>, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let seed = session.seed.to_string();
    let output = Command::new(program)
        .args(["selftest", axis.file(), "moves"])
        .args(["--seed", &seed])
        .args(arguments)
        .arg("--out")
        .arg(
            root()
                .join("target/selftest")
                .join(&seed)
                .join(axis.folder()),
        )
        .current_dir(root())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("the self-test ends with {}", output.status));
    }
    Ok(output.stdout)
}
