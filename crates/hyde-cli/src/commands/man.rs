//! `hyde man`: the manual, a page for the command and one for each of its commands, made from the arguments.

use crate::args::{Arguments, ManArgs};
use crate::exit::Exit;
use crate::files;
use crate::output::{print_error, print_output};
use clap::CommandFactory as _;

/// Leaves the pages in a folder.
pub(crate) fn man(args: &ManArgs) -> Exit {
    let command = Arguments::command().disable_help_subcommand(true);
    let made = files::make_folder(&args.out).and_then(|()| {
        clap_mangen::generate_to(command, &args.out)
            .map_err(|error| files::cannot_write(&args.out, &error))
    });
    match made {
        Ok(()) => {
            print_output(&format!("the pages are in {}", args.out.display()));
            Exit::Done
        }
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}
