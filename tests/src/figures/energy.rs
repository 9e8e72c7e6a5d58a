//! `energy_drift`: does a drive without losses keep its energy?
//!
//! Two drives, the worse counts: one with a bar, whose undamped modes hold the steps of the solver small whatever the
//! tolerance, and one of two inertias and a spring, where the tolerance alone holds them.

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use crate::stored_energy::{Drive, drift};

pub(super) const FIGURE: Figure = Figure {
    name: "energy_drift",
    unit: "relative",
    promise: Promise::AtMost(1e-6),
    measure,
};

/// Periods that the run must have.
const PERIODS: usize = 100;

/// The largest change of the stored energy in any row, over what was stored at the start.
fn measure(_: &Session) -> Result<Measured, String> {
    Ok(Measured::Value(with_bar()?.max(lumped()?)))
}

/// 100 of the 160 periods of the two inertias.
fn lumped() -> Result<f64, String> {
    let (compiled, run) = Example::load("tests/models/lumped.hyde", Some("free"))?.run()?;
    let energy = compiled
        .program
        .output("e")
        .and_then(|number| run.results.column(number));
    let energy = energy.ok_or("the run has no column `e`")?;
    Ok(drift(&energy[..energy.len() * 100 / 160]))
}

fn with_bar() -> Result<f64, String> {
    let drive = Example::load("tests/models/undamped.hyde", Some("free"))?;
    let (compiled, run) = drive.run()?;
    let drive = Drive::of(&compiled, &run)?;
    let position = drive.column("table.s")?;
    let crossings = position
        .windows(2)
        .filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0))
        .count();
    if crossings < 2 * PERIODS {
        return Err(format!(
            "{crossings} zero crossings are fewer than {PERIODS} periods"
        ));
    }
    Ok(drift(&drive.energy(&[
        ("near.J", "near.w"),
        ("far.J", "far.w"),
        ("table.M", "table.v"),
        ("spring.c", "spring.stretch"),
        ("screw.contact.k", "screw.contact.e"),
    ])?))
}
