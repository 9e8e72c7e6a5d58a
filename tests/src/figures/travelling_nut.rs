//! `travelling_nut_energy_drift` and `nut_stiffness_ripple`: does a nut that moves along its screw lose or find energy,
//! and does it feel the cells of the mesh?

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use crate::stored_energy::{Drive, drift};

const MODEL: &str = "tests/models/travelling_nut.hyde";

pub(super) const DRIFT: Figure = Figure {
    name: "travelling_nut_energy_drift",
    unit: "relative",
    promise: Promise::AtMost(1e-6),
    measure: energy,
};

pub(super) const RIPPLE: Figure = Figure {
    name: "nut_stiffness_ripple",
    unit: "relative",
    promise: Promise::AtMost(1e-4),
    measure: ripple,
};

/// Cells that the nut must pass.
const CELLS: f64 = 2.0;

/// The largest change of the stored energy in any row, over what was stored at the start.
fn energy(_: &Session) -> Result<Measured, String> {
    let (compiled, run) = Example::load(MODEL, Some("free"))?.run()?;
    let drive = Drive::of(&compiled, &run)?;
    let (place, len) = (drive.column("screw.xn")?, drive.parameter("screw.len")?);
    let passed = (place[place.len() - 1] - place[0]) / len * drive.cells as f64;
    if passed < CELLS {
        return Err(format!("the nut passed {passed} cells, not {CELLS}"));
    }
    Ok(Measured::Value(drift(&drive.energy(&[
        ("near.J", "near.w"),
        ("far.J", "far.w"),
        ("table.M", "table.v"),
        ("screw.contact.k", "screw.contact.e"),
    ])?)))
}

/// The largest difference of the compliance, at any place further than a cell from both ends, to that of a bar held at
/// both ends: x*(len - x)/(c*len^2).
fn ripple(_: &Session) -> Result<Measured, String> {
    let (compiled, run) = Example::load(MODEL, Some("walk"))?.run()?;
    let column = |name: &str| {
        let number = compiled.program.output(name);
        let found = number.and_then(|number| run.results.column(number));
        found.ok_or_else(|| format!("the run has no column `{name}`"))
    };
    let (place, twist) = (column("xn")?, column("twist")?);
    let cell = 1.0 / 24.0;
    let mut worst = 0.0_f64;
    for (x, twist) in place.iter().zip(twist) {
        if (cell..=1.0 - cell).contains(x) {
            worst = worst.max((twist / (x * (1.0 - x)) - 1.0).abs());
        }
    }
    Ok(Measured::Value(worst))
}
