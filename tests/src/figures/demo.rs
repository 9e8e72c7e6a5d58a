//! `demo_seconds`: how long `./dev demo` takes once the command is built.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use crate::root;
use std::process::{Command, Stdio};

pub(super) const FIGURE: Figure = Figure {
    name: "demo_seconds",
    unit: "s",
    promise: Promise::AtMost(60.0),
    measure,
};

fn measure(_: &Session) -> Result<Measured, String> {
    let build = ["build", "--release", "--locked", "-q", "-p", "hyde-cli"];
    succeed(Command::new("cargo").args(build))?;
    let start = now();
    succeed(Command::new("./dev").arg("demo"))?;
    Ok(Measured::Value(start.elapsed().as_secs_f64()))
}

fn succeed(command: &mut Command) -> Result<(), String> {
    let output = command.current_dir(root()).stdin(Stdio::null()).output();
    let output = output.map_err(|error| format!("{command:?}: {error}"))?;
    match output.status.success() {
        true => Ok(()),
        false => Err(format!(
            "{command:?}: {}",
            String::from_utf8_lossy(&output.stderr)
        )),
    }
}
