//! The `hyde` command as the tests of this package build it, so that they run what a user runs and never an old binary.

use std::process::ExitCode;

fn main() -> ExitCode {
    hyde_cli::main(std::env::args_os())
}
