//! `travelling_nut_energy_drift`, `nut_stiffness_ripple` and `travelling_nut_over_fixed`: does a nut that moves along its screw
//! lose or find energy, does it feel the cells of the mesh, and how much longer does it take than one that stays?

use super::clock::now;
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

/// Compilation and run of a screw of 40 cells with a nut that travels, over the same with a nut that stays.
pub(super) const OVER_FIXED: Figure = Figure {
    name: "travelling_nut_over_fixed",
    unit: "times",
    promise: Promise::AtMost(3.0),
    measure: |_: &Session| {
        let library = Example::load("crates/hyde-library/models/Drives/Screws.hyde", None)?;
        let [before, behind] = ["model TravellingScrew", "end TravellingScrew;"];
        let screw = library
            .text()
            .split_once(before)
            .and_then(|(_, rest)| rest.split_once(behind));
        let (screw, _) = screw.ok_or("the library has no `TravellingScrew`")?;
        let moves = "Length xn = x0 + nut.s;";
        if !screw.contains(moves) {
            return Err(format!("the screw has no `{moves}`"));
        }
        let fixed = screw.replace(moves, "final parameter Length xn = x0;");
        let least = |screw: &str| {
            let example = Example::load(MODEL, None)?.replaced(&drive_with(screw), "free");
            let mut least = f64::INFINITY;
            for _ in 0..3 {
                let start = now();
                example.run()?;
                least = least.min(start.elapsed().as_secs_f64());
            }
            Ok::<f64, String>(least)
        };
        Ok(Measured::Value(least(screw)? / least(&fixed)?))
    },
};

/// A motor, a screw and a table that turn and travel from the start.
fn drive_with(screw: &str) -> String {
    format!(
        "package nut;
import SI.*;
import Rotational.*;
import Translational.*;
import Drives.Screws.*;
model Own {screw}end Own;
model Drive
  parameter AngularVelocity w0 = 30 [rad/s];
  Inertia near(J = 9.1e-3 [kg.m2], w(start = w0)), far(J = 1e-3 [kg.m2], w(start = w0));
  Own screw(len = 1.05 [m], d = 40 [mm], x0 = 0.4 [m], kb = 2e8 [N/m], tv = 0.02 [ms], tu = 0.02 [ms],
    n = 40, contact.k = 1.6e8 [N/m], w(start = w0));
  Mass table(M = 310 [kg], v(start = 1.5*w0*screw.lead));
equation
  connect(near.a, screw.a);
  connect(screw.b, far.a);
  connect(screw.nut, table.a);
end Drive;
experiment free of Drive
  solve auto(rtol = 1e-6) stop 0.5 [s] every 1 [ms];
end free;
"
    )
}

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
    for (x, twist) in place.iter().zip(twist.iter()) {
        if (cell..=1.0 - cell).contains(x) {
            worst = worst.max((twist / (x * (1.0 - x)) - 1.0).abs());
        }
    }
    Ok(Measured::Value(worst))
}
