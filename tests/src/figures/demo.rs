//! `demo_seconds`: how long `./dev demo` takes once the command is built.

use super::clock::now;
use super::process::released;
use super::promise::{Figure, Measured, Promise, Session};
use crate::fmu::succeed;
use std::process::Command;

pub(super) const FIGURE: Figure = Figure {
    name: "demo_seconds",
    unit: "s",
    promise: Promise::AtMost(60.0),
    measure,
};

fn measure(_: &Session) -> Result<Measured, String> {
    released()?;
    let start = now();
    succeed(Command::new("./dev").arg("demo"))?;
    Ok(Measured::Value(start.elapsed().as_secs_f64()))
}
