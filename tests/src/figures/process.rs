//! The processes that figures start, and what they took.

use crate::fmu::succeed;
use crate::root;
use std::path::PathBuf;
use std::process::Command;

/// This program, which is the command `hyde` as well.
pub(super) fn this_program() -> Result<PathBuf, String> {
    std::env::current_exe().map_err(|error| error.to_string())
}

/// Builds the command as it is released.
pub(super) fn released() -> Result<PathBuf, String> {
    let build = ["build", "--release", "--locked", "-q", "-p", "hyde-cli"];
    succeed(Command::new("cargo").args(build))?;
    Ok(root().join("target/release/hyde"))
}

/// CPU time in s so far, of this process or of its children that have ended.
#[allow(clippy::disallowed_methods, reason = "time is what is measured")]
pub(crate) fn cpu_s(of_children: bool) -> Option<f64> {
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    // Behind the name in brackets: state is field 3, utime and stime 14 and 15, those of children 16 and 17; 100 a second.
    let fields: Vec<&str> = text.rsplit_once(") ")?.1.split(' ').collect();
    let first = if of_children { 13 } else { 11 };
    let ticks = |at: usize| fields.get(at)?.parse::<f64>().ok();
    Some((ticks(first)? + ticks(first + 1)?) / 100.0)
}

/// The most memory that a process has had so far.
#[allow(clippy::disallowed_methods, reason = "memory is what is measured")]
pub(super) fn memory_kb(process: u32) -> Option<f64> {
    let text = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = text.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}
