//! `stick_velocity_max`: does a drive at rest stay at rest?

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;

pub(super) const FIGURE: Figure = Figure {
    name: "stick_velocity_max",
    unit: "m/s",
    promise: Promise::Exactly(0.0),
    measure,
};

/// The largest velocity, in any row, of a saddle that is loaded below breakaway while the drive is off.
fn measure(_: &Session) -> Result<Measured, String> {
    let (compiled, run) = Example::load("tests/models/stick.hyde", Some("off"))?.run()?;
    let column = |name: &str| {
        let number = compiled.program.output(name);
        number
            .and_then(|number| run.results.column(number))
            .ok_or_else(|| format!("the run has no column `{name}`"))
    };
    let size = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    if size(&column("push.F")?) == 0.0 {
        return Err("the load is missing".to_owned());
    }
    // An angular velocity counts by what it would move.
    let velocities = ["saddle.v", "motor.w", "pulley.w"];
    let sizes: Result<Vec<f64>, String> = velocities
        .iter()
        .map(|name| Ok(size(&column(name)?)))
        .collect();
    Ok(Measured::Value(size(&sizes?)))
}
