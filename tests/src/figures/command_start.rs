//! `command_start_ms`: how long a command takes that has next to nothing to do.

use super::clock::now;
use super::process::released;
use super::promise::{Figure, Measured, Promise, Session};
use crate::root;
use std::process::{Command, Stdio};

pub(super) const FIGURE: Figure = Figure {
    name: "command_start_ms",
    unit: "ms",
    promise: Promise::AtMost(20.0),
    measure,
};

/// What is started: nothing, a table, a page, a file of ten lines that names a package of the library.
const COMMANDS: [&[&str]; 4] = [
    &["--version"],
    &["run", "--help"],
    &["explain", "E0603"],
    &["check", "examples/first/first.hyde"],
];

/// Starts that are timed of each; the middle one counts.
const REPEATS: usize = 15;

/// The slowest of the commands, from its start to its end.
fn measure(_: &Session) -> Result<Measured, String> {
    let binary = released()?;
    let mut slowest = 0.0_f64;
    for arguments in COMMANDS {
        let mut times = Vec::new();
        for _ in 0..REPEATS {
            let mut command = Command::new(&binary);
            command.args(arguments).current_dir(root());
            command.stdin(Stdio::null()).stdout(Stdio::null());
            let start = now();
            let status = command.status().map_err(|error| error.to_string())?;
            times.push(start.elapsed().as_secs_f64() * 1e3);
            if !status.success() {
                return Err(format!("`hyde {}` failed", arguments.join(" ")));
            }
        }
        times.sort_by(f64::total_cmp);
        slowest = slowest.max(times[REPEATS / 2]);
    }
    Ok(Measured::Value(slowest))
}
