//! `cli_kloc` and `parses_per_command`: how thin the command line is, and how often a command parses a file.

use super::process::this_program;
use super::promise::{Figure, Measured, Promise, Session};
use crate::fmu::succeed;
use crate::root;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Code of the command line, without what studies compute and what presents them.
pub(super) const LINES: Figure = Figure {
    name: "cli_kloc",
    unit: "thousand lines of code",
    promise: Promise::AtMost(8.0),
    measure: lines,
};

/// The most often that any of the commands parses any file of its model or of the library.
pub(super) const PARSES: Figure = Figure {
    name: "parses_per_command",
    unit: "times",
    promise: Promise::Exactly(1.0),
    measure: parses,
};

/// Lines of `crates/hyde-cli/src` that are neither empty nor a comment alone.
fn lines(_: &Session) -> Result<Measured, String> {
    let count = below(&root().join("crates/hyde-cli/src")).map_err(|error| error.to_string())?;
    Ok(Measured::Value(f64::from(count) / 1000.0))
}

#[allow(clippy::disallowed_methods, reason = "sources are counted")]
fn below(folder: &Path) -> std::io::Result<u32> {
    let mut count = 0;
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            count += below(&path)?;
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let text = fs::read_to_string(&path)?;
            let lines = text.lines().map(str::trim);
            let code = lines.filter(|line| !line.is_empty() && !line.starts_with("//"));
            count += u32::try_from(code.count()).unwrap_or(u32::MAX);
        }
    }
    Ok(count)
}

/// A sweep for the first example, which has none.
const SWEEP: [&str; 6] = [
    "--of",
    "push",
    "--vary",
    "table.M in 200 .. 400 [kg]",
    "--points",
    "grid 3",
];

fn parses(_: &Session) -> Result<Measured, String> {
    let first = "examples/first/first.hyde";
    let bench = ["examples/bench_axis/axis.hyde", "--quiet", "--data"];
    let cogging = "examples/bench_axis/cogging";
    let commands: [(&str, Vec<&str>); 10] = [
        ("run", vec![first, "--quiet"]),
        ("fit", [&bench[..], &[cogging]].concat()),
        ("diagnose", [&bench[..], &[cogging]].concat()),
        (
            "bode",
            vec!["examples/frequency_response/axis.hyde", "hybrid", "--quiet"],
        ),
        (
            "modes",
            vec!["examples/frequency_response/axis.hyde", "hybrid"],
        ),
        ("sweep", [&[first, "--quiet"], &SWEEP[..]].concat()),
        ("check", vec![first, "--quiet"]),
        ("check", bench[..2].to_vec()),
        ("test", vec![first, "--quiet"]),
        ("effects", vec![first, "--check", "--quiet"]),
    ];
    let mut most = 0.0_f64;
    for (name, arguments) in commands {
        let mut command = Command::new(this_program()?);
        command.args(["--parses", name]).args(arguments);
        let printed = succeed(command.current_dir(root()))?;
        let last = printed.lines().last().unwrap_or_default();
        let count: f64 = last
            .parse()
            .map_err(|_| format!("`hyde {name}` ended with `{last}`"))?;
        most = most.max(count);
    }
    Ok(Measured::Value(most))
}
