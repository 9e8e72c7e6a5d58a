//! `hyde completions`: what a shell has to know to complete a command line.

use crate::args::{Arguments, CompletionsArgs};
use crate::exit::Exit;
use crate::output::print_output;
use clap::CommandFactory as _;

/// Prints the script of a shell.
pub(crate) fn completions(args: &CompletionsArgs) -> Exit {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Arguments::command(), "hyde", &mut script);
    print_output(&String::from_utf8_lossy(&script));
    Exit::Done
}
