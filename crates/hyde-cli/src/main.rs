//! The `hyde` command: hands its arguments to the library and ends with its exit status.

use std::process::ExitCode;

fn main() -> ExitCode {
    hyde_cli::main(std::env::args_os())
}
