//! What is printed. Standard output can be full, and nobody must take half an answer for a whole one: what could not be
//! written is remembered until the command ends, and told there.

use crate::exit::Exit;
use crate::render;
use hyde_diag::{Diagnostics, Sources};
use std::fs::File;
use std::io::{ErrorKind, IsTerminal as _, Write as _};
use std::os::fd::AsFd as _;
use std::sync::OnceLock;

/// Why standard output of this process could not be written. There is one of it, whoever prints.
static FAILED: OnceLock<String> = OnceLock::new();

/// Where this command prints, if standard output of the process is left to what others print in it.
static OWN: OnceLock<File> = OnceLock::new();

/// From here on what libraries of FMUs print in this process goes to standard error, so that it never mixes with what this
/// command prints. Without a second descriptor all stays as it is.
pub(crate) fn keep_own() {
    if OWN.get().is_some() {
        return;
    }
    let _flushed = std::io::stdout().flush();
    let own = std::io::stdout().as_fd().try_clone_to_owned();
    if let Ok(own) = own
        && rustix::stdio::dup2_stdout(std::io::stderr().as_fd()).is_ok()
    {
        let _first = OWN.set(File::from(own));
    }
}

fn print(text: &[u8]) -> std::io::Result<()> {
    match OWN.get() {
        Some(mut own) => own.write_all(text),
        None => std::io::stdout().lock().write_all(text),
    }
}

/// A line on standard output. Whoever reads it may have gone: a closed pipe is no mistake.
pub(crate) fn print_output(text: &str) {
    let text = visible(text.trim_end());
    note(print(format!("{text}\n").as_bytes()));
}

/// A text on standard output as it is: it is the input of another program.
pub(crate) fn write_output(text: &str) {
    note(print(text.as_bytes()));
}

/// A line on standard error.
pub(crate) fn print_error(text: &str) {
    let text = visible(text.trim_end());
    drop(writeln!(std::io::stderr().lock(), "{text}"));
}

/// Diagnostics on standard error, in colour on a terminal, and a line behind them.
pub(crate) fn print_diagnostics(diagnostics: &Diagnostics, sources: &Sources, last: &str) {
    let text = render::render(diagnostics, sources, std::io::stderr().is_terminal());
    let all = format!("{text}{}", visible(last));
    drop(writeln!(std::io::stderr().lock(), "{}", all.trim_end()));
}

/// Characters that steer a terminal or turn the direction of writing, as signs that do nothing: texts come from models and
/// names of files.
fn visible(text: &str) -> String {
    let sign = |c: char| match c {
        '\n' | '\t' => c,
        '\u{0}'..='\u{1f}' => char::from_u32(0x2400 + c as u32).unwrap_or('\u{fffd}'),
        '\u{7f}' => '\u{2421}',
        '\u{80}'..='\u{9f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => '\u{fffd}',
        _ => c,
    };
    text.chars().map(sign).collect()
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
