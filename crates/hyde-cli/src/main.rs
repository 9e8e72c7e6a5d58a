//! The `hyde` command: hands its arguments to the library and ends with its exit status.

use mimalloc::MiMalloc;
use std::process::ExitCode;

/// A diagnosis makes and drops small matrices by the million, on every thread.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

fn main() -> ExitCode {
    hyde_cli::main(std::env::args_os())
}
