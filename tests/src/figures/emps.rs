//! `emps_…`: the published model of the Electro-Mechanical Positioning System against its measured record.

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;

pub(super) const FORCE: Figure = Figure {
    name: "emps_force_error_percent",
    unit: "%",
    promise: Promise::Within(5.80, 5.90),
    measure: |session| channel(session, "force"),
};

pub(super) const VELOCITY: Figure = Figure {
    name: "emps_velocity_error_percent",
    unit: "%",
    promise: Promise::Within(0.226, 0.232),
    measure: |session| channel(session, "velocity"),
};

pub(super) const POSITION: Figure = Figure {
    name: "emps_position_error_percent",
    unit: "%",
    promise: Promise::AtMost(0.014),
    measure: |session| channel(session, "position"),
};

const CHANNELS: [&str; 3] = ["force", "velocity", "position"];

fn channel(session: &Session, name: &str) -> Result<Measured, String> {
    let all = session.emps.get_or_init(|| errors(session)).clone()?;
    let number = CHANNELS.iter().position(|known| *known == name);
    number
        .and_then(|number| all.get(number).cloned())
        .ok_or_else(|| format!("the experiment measures no {name}"))
}

/// Relative errors in percent, in the order of [`CHANNELS`].
fn errors(session: &Session) -> Result<Vec<Measured>, String> {
    let record = session.data.join("emps/emps_est.csv");
    if !record.is_file() {
        let what = "emps/emps_est.csv, the record of EMPS (nonlinearbenchmark.org), is not below the data folder";
        return Ok(vec![Measured::Absent(what.to_owned()); CHANNELS.len()]);
    }
    let (_, run) = Example::load("examples/emps/emps.hyde", Some("tracking"))?
        .record("file", record)
        .run()?;
    let error = |name: &&str| {
        let channel = run.channels.iter().find(|channel| channel.name == **name);
        channel
            .map(|channel| Measured::Value(channel.relative_percent))
            .ok_or_else(|| format!("the experiment measures no {name}"))
    };
    CHANNELS.iter().map(error).collect()
}
