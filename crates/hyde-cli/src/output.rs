//! What is printed. Standard output can be full, and nobody must take half an answer for a whole one: what could not be
//! written is remembered until the command ends, and told there.

use crate::exit::Exit;
use std::io::{ErrorKind, Write as _};
use std::sync::OnceLock;

/// Why standard output of this process could not be written. There is one of it, whoever prints.
static FAILED: OnceLock<String> = OnceLock::new();

/// A line on standard output. Whoever reads it may have gone: a closed pipe is no mistake.
pub(crate) fn print_output(text: &str) {
    let written = writeln!(std::io::stdout().lock(), "{}", text.trim_end());
    note(written);
}

/// A line on standard error.
pub(crate) fn print_error(text: &str) {
    drop(writeln!(std::io::stderr().lock(), "{}", text.trim_end()));
}

/// Remembers that standard output could not be written.
pub(crate) fn note(written: std::io::Result<()>) {
    if let Err(error) = written
        && error.kind() != ErrorKind::BrokenPipe
    {
        let _first = FAILED.set(crate::files::reason(&error));
    }
}

/// The exit status of a command that ended with `exit`: what could not be printed is told.
pub(crate) fn ended(exit: Exit) -> Exit {
    match FAILED.get() {
        Some(reason) => {
            print_error(&format!("error: cannot write to standard output: {reason}"));
            exit.max(Exit::CommandLine)
        }
        None => exit,
    }
}
